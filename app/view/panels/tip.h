#pragma once
/// Explanations of widgets: after a moment, and beside the widget instead of over its neighbours.

#include <imgui.h>

#include <string>
#include <vector>

namespace neve::app::view::panels {

struct TipLine {
  std::string text;
  bool is_dim = false;
};

/// True if the mouse rests long enough on the widget drawn last, enabled or not.
bool wants_tip();
/// Shows a tip below the widget drawn last, or above it if the screen ends there.
void show_tip(const std::vector<TipLine>& lines);
/// Shows a tip of one line if the mouse rests on the widget.
void tip(const char* text);

/// True if a tip is due soon without further input, or has just been drawn for the first time and
/// is not yet visible: the panels must be drawn again.
bool is_tip_coming();

/// Place of a tip, px from the upper left corner.
/// @param from, to the widget's corners
/// @param size of the tip
/// @param screen its size
ImVec2 tip_place(ImVec2 from, ImVec2 to, ImVec2 size, ImVec2 screen);

}  // namespace neve::app::view::panels
