#pragma once
/// The list of clicks: one answer for each round, as text.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace neve::app::pick {

/// Positions 0 to 8 of the chosen tiles: none, one or two.
using Click = std::vector<int>;

/// Reads "3", "2 7" or "0": tiles count from 1, and 0 is none. Returns nothing for any other text.
std::optional<Click> click_of(const std::string& text);
std::string click_text(const Click& click);

/// The text of a file. @throws IoError
std::string text_of_file(const std::filesystem::path& file);

/// One answer a line; lines that begin with # and empty ones are left out.
/// @param file  named in errors @throws UsageError
std::vector<Click> parse_clicks(const std::string& text, const std::string& file);

/// @param comment  lines for people, without #
std::string clicks_text(const std::vector<Click>& clicks, const std::vector<std::string>& comment);

}  // namespace neve::app::pick
