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
/// Below that widget; above it where there is no room.
void show_tip(const std::vector<TipLine>& lines);
/// Both of one line.
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
