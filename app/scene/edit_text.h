#pragma once
/// Saves changed values into the user's own scene file.

#include <string>
#include <vector>

#include "app/scene/override.h"
#include "app/scene/scene.h"

namespace neve::app::scene {

/// The text of a scene with other values put in. Comments, order, blank lines, line ends and the
/// way other values are written stay byte for byte: existing keys only get a new value, other keys
/// are added below the last key of their table, inside an inline table, or in a
/// section of their own at the end. A value set to "none" is removed with its line.
///
/// Reading the result gives exactly the scene that reading the text with these overrides gives; it
/// is compared before it is returned.
/// @param name, base_dir  see read_scene_text
/// @throws SceneError for the text, UsageError for the changes; UsageError as well, that says what
/// to
///         do by hand, where the text is written in a way that this cannot change
std::string edit_scene_text(const std::string& text, const std::vector<Override>& changes,
                            const std::string& name = "the scene",
                            const std::string& base_dir = {});

/// The same for another file: with whole paths where the scene's own do not find its files from
/// there, and with every number written out where its words cannot take the changes.
/// @param file  that the text is of @param out  file that the result is for
/// @throws SceneError for the text, UsageError for the changes
std::string changed_scene_text(const std::string& text, const std::vector<Override>& changes,
                               const std::string& file, const std::string& out);

/// A scene in full, with the views and mosaics that a run of it leaves undrawn.
std::string text_with_all_views(Scene scene);

/// Comments put above a scene, below the line that names the schema, which editors want first.
std::string with_header(const std::string& text, const std::string& header);

}  // namespace neve::app::scene
