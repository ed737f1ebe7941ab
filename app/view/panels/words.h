#pragma once
/// Text in lines.

#include <imgui.h>

#include <string>

namespace neve::app::view::panels {

/// The text with line feeds where a line would be wider. ImGui itself also breaks behind the point
/// of a number, as in "0." and "000243".
/// @param width px
std::string in_lines(const std::string& text, float width);

/// Draws text in the width that is left. A word that is wider alone is broken inside.
void wrapped_text(const std::string& text);
/// The same in another colour.
void wrapped_text(const std::string& text, const ImVec4& color);
/// A remark, in the colour of what is off.
void dim_text(const std::string& text);

}  // namespace neve::app::view::panels
