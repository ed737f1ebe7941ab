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

/// Whether the mouse rests on the widget that was drawn last, enabled or not, for long enough.
bool wants_tip();
/// Below that widget; above it where there is no room.
void show_tip(const std::vector<TipLine>& lines);
/// Both of one line.
void tip(const char* text);

/// Whether one is due soon, though nothing happens: the panels have to be drawn again.
bool is_tip_coming();

/// Where a tip stands, px from the upper left corner.
/// @param from, to the widget's corners
/// @param size of the tip
/// @param screen its size
ImVec2 tip_place(ImVec2 from, ImVec2 to, ImVec2 size, ImVec2 screen);

}  // namespace neve::app::view::panels
