#pragma once
/// Breaking text into lines of a given width.

#include <imgui.h>

#include <string>
#include <vector>

namespace neve::render::overlay {

float text_width(const ImFont& font, const std::string& text);

/// The text, or as much of its beginning as fits with an ellipsis.
std::string elide(const ImFont& font, const std::string& text, float width);

/// Breaks at spaces, where it can behind a comma or between groups of words, so that a name stays
/// with its number; inside a word only when it alone is too long. Lines beyond max_lines are
/// dropped and the last one says so with an ellipsis.
std::vector<std::string> wrap(const ImFont& font, const std::string& text, float width,
                              std::size_t max_lines);

}  // namespace neve::render::overlay
