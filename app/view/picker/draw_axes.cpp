/// The parameters that are searched, one a row: where the tiles are, and what is liked.

#include <imgui.h>

#include <algorithm>
#include <string>

#include "app/view/panels/labels.h"
#include "app/view/picker/colours.h"
#include "app/view/picker/picker_state.h"

namespace neve::app::view::picker {

namespace {

struct Track {
  float left = 0, right = 0, middle = 0;
  ImVec2 at(double u) const { return {left + static_cast<float>(u) * (right - left), middle}; }
};

std::string value_text(const pick::PickAxis& axis, double u) {
  return pick::short_value(axis, u) + (axis.unit.empty() ? "" : " " + axis.unit);
}

/// Draws a text, cut on the right where it has no room.
void draw_cut(ImVec2 at, float width, const std::string& text, ImU32 color) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(at, ImVec2(at.x + width, at.y + 1.5f * em()), true);
  list.AddText(at, color, text.c_str());
  list.PopClipRect();
}

/// The part of the axis that is liked, where the answers say something about it.
void draw_liked(const pick::Lesson& lesson, std::size_t axis, const Track& track) {
  constexpr double noticed = 1;
  for (const pick::AxisTaste& taste : lesson.tastes) {
    if (taste.axis != axis || taste.effect < noticed) continue;
    const ImVec2 from = track.at(taste.low), to = track.at(taste.high);
    const float half = 0.3f * em();
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(from.x, from.y - half),
                                              ImVec2(to.x, to.y + half),
                                              IM_COL32(250, 214, 120, 90), 0.2f * em());
  }
}

void draw_places(const PickerState& state, std::size_t axis, const Track& track) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto k = static_cast<Eigen::Index>(axis);
  const pick::Lesson& lesson = state.game.lesson();
  const float radius = 0.22f * em();
  for (const ShownTile& tile : state.tiles)
    if (tile.place.size() > 0) list.AddCircleFilled(track.at(tile.place[k]), radius, colour::dim);
  if (lesson.has_favourite())
    list.AddCircle(track.at(lesson.favourite[k]), 2 * radius, colour::liked, 0, 0.12f * em());
  if (state.pointed < 0) return;
  const ShownTile& pointed = state.tiles[static_cast<std::size_t>(state.pointed)];
  if (pointed.place.size() > 0)
    list.AddCircleFilled(track.at(pointed.place[k]), 1.6f * radius, colour::accent);
}

/// The value of the pointed tile; else the ends.
std::string right_text(const PickerState& state, std::size_t axis) {
  const pick::PickAxis& shown = state.game.axes()[axis];
  if (state.pointed >= 0) {
    const ShownTile& tile = state.tiles[static_cast<std::size_t>(state.pointed)];
    if (tile.place.size() > 0)
      return value_text(shown, tile.place[static_cast<Eigen::Index>(axis)]);
  }
  return pick::short_value(shown, 0) + " to " + value_text(shown, 1);
}

/// Name, axis and value side by side; on a phone the axis is below the two.
void draw_axis(const PickerState& state, std::size_t axis, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool is_stacked = state.layout.is_stacked;
  const float name = is_stacked ? 0.55f * width : std::min(11 * em(), 0.3f * width);
  const float value = is_stacked ? 0.45f * width : std::min(11 * em(), 0.34f * width);
  const float gap = is_stacked ? 0.5f * em() : 0.8f * em();
  draw_cut(at, name - 0.3f * em(), state.game.axes()[axis].name, colour::text);
  const std::string text = right_text(state, axis);
  const float indent =
      is_stacked ? std::max(0.0f, value - ImGui::CalcTextSize(text.c_str()).x - gap) : 0;
  draw_cut(ImVec2(at.x + width - value + indent, at.y), value - indent, text,
           state.pointed >= 0 ? colour::accent : colour::dim);
  const Track track =
      is_stacked ? Track{at.x + gap, at.x + width - gap, at.y + 1.75f * em()}
                 : Track{at.x + name + gap, at.x + width - value - gap, at.y + 0.5f * em()};
  ImGui::GetWindowDrawList()->AddLine(track.at(0), track.at(1), colour::line,
                                      std::max(1.0f, 0.14f * em()));
  draw_liked(state.game.lesson(), axis, track);
  draw_places(state, axis, track);
  ImGui::Dummy(ImVec2(width, (is_stacked ? 2.4f : 1.25f) * em()));
}

}  // namespace

void draw_axes(PickerState& state) {
  const std::string title = state.pointed >= 0 ? "Tile " + std::to_string(state.pointed + 1)
                                               : std::string("The tiles on their axes");
  ImGui::PushStyleColor(ImGuiCol_Text, state.pointed >= 0 ? colour::accent : colour::dim);
  ImGui::TextUnformatted(title.c_str());
  ImGui::PopStyleColor();
  panels::note_label("values");
  if (state.game.lesson().has_favourite() && !state.layout.is_stacked) {
    ImGui::SameLine(0, 1.5f * em());
    ImGui::TextDisabled("ring: favourite, bar: liked");
  }
  const float width = ImGui::GetContentRegionAvail().x;
  for (std::size_t axis = 0; axis < state.game.axes().size(); ++axis) draw_axis(state, axis, width);
}

}  // namespace neve::app::view::picker
