#pragma once
/// The plots of a frame as panels in the lower left corner, drawn with ImGui.

#include <imgui.h>

#include "render/frame/frame.h"

namespace neve::render::overlay {

/// One below the other over a common time axis. A picture too small for all of them shows the
/// first ones. To be called between ImGuiDraw::begin and end.
/// @param right_limit pixels; where something else begins
/// @return right edge of the drawing, pixels; 0: nothing drawn
float draw_plots(const Frame& frame, const ImFont& font, float right_limit);

}  // namespace neve::render::overlay
