/// Words over the picture: the probed point, and the reason of an empty picture.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/picture/cut.h"
#include "app/picture/slice.h"
#include "app/scene/names.h"
#include "app/support/text.h"
#include "app/view/panels/viewport.h"

namespace neve::app::view::panels {

namespace {

using sim::Vec3d;

constexpr ImU32 hint_color = IM_COL32(235, 240, 248, 255);
/// Arrows shorter than this share of the range cannot be seen.
constexpr double visible_share = 0.01;

void draw_probe_mark(const ViewerState& state) {
  if (!state.live->probe) return;
  const session::ProbeReading& probe = *state.live->probe;
  const Vec3d at = state.orbit.project(probe.place);
  if (!(at.z() > 0)) return;
  const ImVec2 place = on_screen(state, at);
  // The plane removes particles; nodes stay in the picture.
  const picture::Cut cut(current_view(state).clip, state.live->snapshot.particles.x);
  const bool is_cut = !probe.is_node && cut.removes(probe.place);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  // Dark around bright, to contrast with snow and with shadow. It is faint where the probed point
  // is cut away.
  list.AddCircle(place, 9, IM_COL32(20, 12, 6, is_cut ? 60 : 190), 24, 4);
  list.AddCircle(place, 9, IM_COL32(255, 122, 40, is_cut ? 90 : 255), 24, 2);
  const std::string text = probe_text(probe, state.trace.quantity, is_cut);
  if (!text.empty())
    draw_note(state, ImVec2(place.x + 15, place.y), text,
              is_cut ? IM_COL32(200, 185, 175, 255) : IM_COL32(255, 190, 140, 255));
}

void draw_hint(ViewerState& state) {
  Hint& hint = state.hint;
  if (hint.seconds <= 0) return;
  hint.seconds -= static_cast<double>(ImGui::GetIO().DeltaTime);
  draw_note(state, ImVec2(hint.x + 12, hint.y), hint.text, hint_color);
}

double longest(const std::vector<Vec3f>& arrows) {
  double longest = 0;
  for (const Vec3f& arrow : arrows)
    longest = std::max(longest, std::sqrt(static_cast<double>(arrow.x) * arrow.x +
                                          static_cast<double>(arrow.y) * arrow.y +
                                          static_cast<double>(arrow.z) * arrow.z));
  return longest;
}

}  // namespace

std::string probe_text(const session::ProbeReading& probe, const std::string& quantity,
                       bool is_cut) {
  // The index of a point says nothing of its size.
  const bool is_index = quantity.empty() || quantity == "node" || quantity == "id";
  const std::string shown = !is_index ? quantity : probe.is_node ? "v_old" : "v";
  std::string text;
  for (const session::ProbeRow& row : probe.rows)
    if (row.name == shown && text.empty())
      text = "|" + row.name + "| = " + rough_text(row.magnitude) + " " + row.unit;
  if (is_cut) text += text.empty() ? "cut away" : ", cut away";
  return text;
}

void draw_note(const ViewerState& state, ImVec2 at, const std::string& text, ImU32 color) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float margin = 0.3f * em();
  const auto left = static_cast<float>(state.viewport.x) + 2 * margin;
  const auto right = static_cast<float>(state.viewport.x + state.viewport.width) - 2 * margin;
  const float x = std::max(left, std::min(at.x, right - size.x)), y = at.y - 0.5f * size.y;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(ImVec2(x - margin, y - 0.5f * margin),
                     ImVec2(x + size.x + margin, y + size.y + 0.5f * margin),
                     IM_COL32(12, 15, 22, 215), margin);
  list.AddText(ImVec2(x, y), color, text.c_str());
}

std::string reason_for_no_arrows(const scene::View& view, const picture::FieldSamples& fields) {
  if (!scene::has_layer(view, scene::Layer::arrows) ||
      scene::has_layer(view, scene::Layer::heatmap))
    return "";
  const auto arrows = fields.vectors.find(view.slice.field);
  if (arrows == fields.vectors.end()) return "";
  const double most = longest(arrows->second);
  const double range = view.slice.range ? view.slice.range->max : 0;
  const std::string name = scene::name(view.slice.field);
  if (most == 0) return "no arrows: " + name + " is 0 everywhere";
  if (range > 0 && most < visible_share * range)
    return "no visible arrows: the largest " + name + " is " + rough_text(most) +
           ", the range ends at " + rough_text(range);
  return "";
}

void draw_marks(ViewerState& state) {
  const std::string reason = reason_for_no_arrows(current_view(state), state.live->snapshot.fields);
  if (!reason.empty()) {
    const float width = ImGui::CalcTextSize(reason.c_str()).x;
    const render::PicturePlace& p = state.viewport;
    draw_note(state,
              ImVec2(static_cast<float>(p.x) + 0.5f * (static_cast<float>(p.width) - width),
                     static_cast<float>(p.y) + 0.85f * static_cast<float>(p.height)),
              reason, hint_color);
  }
  draw_probe_mark(state);
  draw_hint(state);
}

}  // namespace neve::app::view::panels
