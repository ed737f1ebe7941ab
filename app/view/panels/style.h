#pragma once
/// Colours and distances of everything drawn with Dear ImGui on a screen.

namespace neve::app::view::panels {

/// Sets the style of the current ImGui context. @param scale px per point, of every distance
void style_panels(float scale);

/// px
int font_size(float scale);

}  // namespace neve::app::view::panels
