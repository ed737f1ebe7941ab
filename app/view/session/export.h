#pragma once
/// Exports of edits, from tuning to production: files and commands for the other tools.

#include <filesystem>
#include <string>
#include <vector>

#include "app/view/session/document.h"

namespace neve::app::view::session {

/// "material_snow_hardening" for an address.
std::string plain_file_name(const std::string& address);

/// The command that renders the document as it is now.
/// @param scene_file  with the text of the document, see Workbench::file_of_scene()
std::string render_command(const Document& document, const std::string& scene_file);

/// The text of a sweep file with values around the present one of a parameter; the rest of the
/// document is as it is now.
/// @param file  where the text will be @param scene_file  as for render_command()
/// @param set_later  see sweep_around()
/// @throws UsageError
std::string sweep_text_around(const std::filesystem::path& file, const Document& document,
                              const std::string& scene_file, const std::string& address,
                              const std::vector<std::string>& set_later);

}  // namespace neve::app::view::session
