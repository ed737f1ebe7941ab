/// Expected liking over the two axes that tell most.

#include <imgui.h>

#include <algorithm>
#include <string>

#include "app/view/panels/labels.h"
#include "app/view/picker/colours.h"
#include "app/view/picker/picker_state.h"

namespace neve::app::view::picker {

namespace {

/// The square on the screen.
struct Sheet {
  ImVec2 at;
  float side = 0;
  ImVec2 place(double x, double y) const {
    return {at.x + static_cast<float>(x) * side, at.y + static_cast<float>(1 - y) * side};
  }
};

/// Over white, as pale where little is known as on the page.
ImU32 colour_of(const pick::TasteMap::Cell& cell) {
  const auto over_white = [&](int value) {
    return static_cast<int>(value * cell.opacity + 255 * (1 - cell.opacity));
  };
  return IM_COL32(over_white(cell.red), over_white(cell.green), over_white(cell.blue), 255);
}

void draw_squares(const pick::TasteMap& map, const Sheet& sheet) {
  constexpr int n = pick::TasteMap::cells;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (int k = 0; k < n * n; ++k) {
    const ImVec2 low = sheet.place((k % n) / double(n), 1 - (k / n) / double(n)),
                 high = sheet.place((k % n + 1) / double(n), 1 - (k / n + 1) / double(n));
    list.AddRectFilled(low, high, colour_of(map.squares[static_cast<std::size_t>(k)]));
  }
}

void draw_dots(const pick::TasteMap& map, const Sheet& sheet) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  constexpr ImU32 red = IM_COL32(214, 40, 40, 255), dark = IM_COL32(20, 24, 34, 255);
  for (const pick::TasteMap::Dot& dot : map.dots) {
    const ImVec2 at = sheet.place(dot.x, dot.y);
    if (dot.is_chosen) list.AddCircleFilled(at, 0.33f * em(), red);
    list.AddCircle(at, (dot.is_chosen ? 0.33f : 0.2f) * em(), dot.is_chosen ? IM_COL32_WHITE : dark,
                   0, 0.08f * em());
  }
  list.AddCircle(sheet.place(map.favourite_x, map.favourite_y), 0.65f * em(), red, 0, 0.16f * em());
}

/// "2 ... hardening ... 20" below the square.
void draw_x_words(const pick::PickAxis& axis, const Sheet& sheet) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = sheet.at.y + sheet.side + 0.6f * em();
  const auto text = [&](float share, const std::string& words) {
    const float width = ImGui::CalcTextSize(words.c_str()).x;
    list.AddText(ImVec2(sheet.at.x + share * (sheet.side - width), y), colour::dim, words.c_str());
  };
  text(0, pick::short_value(axis, 0));
  text(0.5f, pick::axis_title(axis));
  text(1, pick::short_value(axis, 1));
}

void draw_y_words(const pick::PickAxis& axis, const Sheet& sheet) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto text = [&](float y, const std::string& words) {
    const float width = ImGui::CalcTextSize(words.c_str()).x;
    list.AddText(ImVec2(sheet.at.x - width - 0.9f * em(), y), colour::dim, words.c_str());
  };
  text(sheet.at.y, pick::short_value(axis, 1));
  text(sheet.at.y + sheet.side - em(), pick::short_value(axis, 0));
}

}  // namespace

void draw_map(const PickerState& state) {
  const pick::TasteMap& map = *state.map;
  const std::vector<pick::PickAxis>& axes = state.game.axes();
  const float width = ImGui::GetContentRegionAvail().x, left = 4.6f * em();
  ImGui::TextDisabled("%s, upwards", pick::axis_title(axes[map.y_axis]).c_str());
  ImGui::Dummy(ImVec2(0, 0.3f * em()));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const Sheet sheet{ImVec2(at.x + left, at.y),
                    std::max(4 * em(), std::min(width - left, 22 * em()))};
  draw_squares(map, sheet);
  draw_dots(map, sheet);
  draw_x_words(axes[map.x_axis], sheet);
  draw_y_words(axes[map.y_axis], sheet);
  ImGui::Dummy(ImVec2(width, sheet.side + 1.8f * em()));
  panels::note_label("map");
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("Light: liked. Pale: little known. Red: chosen. Ring: favourite so far.");
  ImGui::PopTextWrapPos();
}

}  // namespace neve::app::view::picker
