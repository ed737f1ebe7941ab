/// Arrows that move bodies and colliders.

#include <algorithm>
#include <cmath>

#include "app/scene/toml/value.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/viewport.h"
#include "app/view/panels/widgets.h"

namespace neve::app::view::panels {

namespace {

using sim::Vec3d;

constexpr ImU32 axis_colors[] = {IM_COL32(240, 90, 90, 255), IM_COL32(110, 215, 110, 255),
                                 IM_COL32(95, 150, 255, 255)};

/// Parameters that the arrows of a handle move: addresses of the places of an object, with their
/// values.
struct Movable {
  Vec3d center;
  std::vector<std::pair<std::string, Vec3d>> places;
  bool moves_by_itself = false;
};

std::optional<Movable> movable(const sim::shapes::Shape& shape, const std::string& address) {
  Movable out;
  for (const auto& [place, value] : session::places_of(shape))
    out.places.emplace_back(address + ".shape." + place, value);
  if (out.places.empty()) return std::nullopt;
  out.center = sim::shapes::center(shape);
  return out;
}

std::optional<Movable> selected_object(const ViewerState& state) {
  const scene::Scene& scene = *state.bench.document().scene();
  for (const sim::seeding::Body& body : scene.bodies)
    if (state.selected == "body." + body.name) return movable(body.shape, state.selected);
  for (const sim::seeding::Emitter& emitter : scene.emitters)
    if (state.selected == "emitter." + emitter.name) return movable(emitter.shape, state.selected);
  for (const sim::seeding::Sink& sink : scene.sinks)
    if (state.selected == "sink." + sink.name) return movable(sink.shape, state.selected);
  for (const scene::Collider& collider : scene.colliders)
    // Keyframes say where it is: arrows that move nothing would only mislead.
    if (state.selected == "collider." + collider.name && collider.keyframes.empty()) {
      std::optional<Movable> object = movable(collider.shape, state.selected);
      if (!object) return object;
      object->places.clear();
      for (const auto& [place, value] : session::places_of(collider))
        object->places.emplace_back(state.selected + "." + place, value);
      object->moves_by_itself = collider.body.moves();
      return object;
    }
  return std::nullopt;
}

std::string literal(const Vec3d& value) {
  return "[" + scene::toml::number_text(value.x()) + ", " + scene::toml::number_text(value.y()) +
         ", " + scene::toml::number_text(value.z()) + "]";
}

/// Rounds to a precision suited to this zoom.
double rounded_move(double value, double distance) {
  const double step = std::pow(10, std::floor(std::log10(std::max(1e-9, distance))) - 2.0);
  return std::round(value / step) * step;
}

struct HandleDrag {
  int axis = -1;
  ImVec2 from{};
  Movable start{};
};

}  // namespace

bool use_handles(ViewerState& state, bool is_over_picture) {
  static HandleDrag drag;
  const std::optional<Movable> object = selected_object(state);
  if (!object) {
    drag.axis = -1;
    return false;
  }
  const double length = 0.16 * state.orbit.distance();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const Vec3d middle = state.orbit.project(object->center);
  if (!(middle.z() > 0)) return drag.axis >= 0;
  const ImVec2 from = on_screen(state, middle);
  int hovered = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d end = state.orbit.project(object->center + length * Vec3d::Unit(axis));
    if (!(end.z() > 0)) continue;
    const ImVec2 to = on_screen(state, end);
    const float dx = to.x - from.x, dy = to.y - from.y;
    const float size = std::max(1.0f, std::hypot(dx, dy));
    const float along = ((mouse.x - from.x) * dx + (mouse.y - from.y) * dy) / (size * size);
    const float off = std::abs((mouse.x - from.x) * dy - (mouse.y - from.y) * dx) / size;
    const bool is_near = is_over_picture && along > 0.15f && along < 1.15f && off < 7;
    if (is_near && hovered < 0) hovered = axis;
    const bool is_bright = drag.axis == axis || (drag.axis < 0 && hovered == axis);
    const ImU32 color = axis_colors[axis];
    list.AddLine(from, to, color, is_bright ? 4.0f : 2.0f);
    list.AddCircleFilled(to, is_bright ? 7.0f : 5.0f, color);
    note_label(("handle " + std::string(1, "xyz"[axis])).c_str(), {to.x - 5, to.y - 5, 10, 10});
  }
  const bool is_past =
      state.live->steps > 0 && (state.selected.starts_with("body.") || object->moves_by_itself);
  draw_note(state, ImVec2(from.x + 10, from.y + 1.2f * em()),
            state.selected + (is_past ? " (at the start)" : ""), IM_COL32(240, 244, 250, 255));
  if (drag.axis < 0 && hovered >= 0 && ImGui::IsMouseClicked(0)) drag = {hovered, mouse, *object};
  if (drag.axis >= 0 && !ImGui::IsMouseDown(0)) drag.axis = -1;
  if (drag.axis < 0) return hovered >= 0;
  // Metres along the axis per pixel of the mouse along the arrow, where the drag began.
  const Vec3d unit = Vec3d::Unit(drag.axis);
  const Vec3d a = state.orbit.project(drag.start.center);
  const Vec3d b = state.orbit.project(drag.start.center + length * unit);
  const ImVec2 pa = on_screen(state, a), pb = on_screen(state, b);
  const auto dx = static_cast<double>(pb.x - pa.x), dy = static_cast<double>(pb.y - pa.y);
  const double size = std::max(16.0, dx * dx + dy * dy);
  const double share = (static_cast<double>(mouse.x - drag.from.x) * dx +
                        static_cast<double>(mouse.y - drag.from.y) * dy) /
                       size;
  const double moved = rounded_move(share * length, state.orbit.distance());
  for (std::size_t k = 0; k < drag.start.places.size(); ++k) {
    const auto& [address, start] = drag.start.places[k];
    const Vec3d place = start + moved * unit;
    if (k < object->places.size() && (object->places[k].second - place).norm() > 1e-12)
      state.bench.set(address, literal(place),
                      gesture_of(0x68616e64u + static_cast<unsigned>(drag.axis)));
  }
  return true;
}

}  // namespace neve::app::view::panels
