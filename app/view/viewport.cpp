/// The picture under the mouse: camera, probing, handles of bodies and obstacles; and the keys.

#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/scene/value.h"
#include "app/slice.h"
#include "app/view/front.h"
#include "app/view/imgui_input.h"
#include "app/view/labels.h"
#include "app/view/pick.h"
#include "app/view/viewer_state.h"

namespace neve::app {

namespace {

using sim::Vec3d;

constexpr ImU32 axis_colors[] = {IM_COL32(240, 90, 90, 255), IM_COL32(110, 215, 110, 255),
                                 IM_COL32(95, 150, 255, 255)};
/// Of a click; a mouse that moved further was dragged.
constexpr float click_slack = 4;

float left(const ViewerState& s) {
  return static_cast<float>(s.viewport.x);
}
float top(const ViewerState& s) {
  return static_cast<float>(s.viewport.y);
}

ImVec2 on_screen(const ViewerState& state, const Vec3d& projected) {
  const auto height = static_cast<float>(state.viewport.height);
  return {left(state) + 0.5f * static_cast<float>(state.viewport.width) +
              height * static_cast<float>(projected.x()),
          top(state) + height * (0.5f - static_cast<float>(projected.y()))};
}

/// Of the mouse: share of the picture's height from its middle, y up.
std::array<double, 2> in_picture(const ViewerState& state, ImVec2 mouse) {
  const auto height = static_cast<double>(state.viewport.height);
  return {(static_cast<double>(mouse.x - left(state)) - 0.5 * state.viewport.width) / height,
          0.5 - static_cast<double>(mouse.y - top(state)) / height};
}

/// What the arrows of a handle move: addresses of the places of a shape, with their values.
struct Movable {
  Vec3d center;
  std::vector<std::pair<std::string, Vec3d>> places;
};

std::optional<Movable> movable(const sim::Shape& shape, const std::string& address) {
  Movable out;
  const std::string base = address + ".shape.";
  const auto add = [&](const char* key, const Vec3d& value) {
    out.places.emplace_back(base + key, value);
  };
  if (const auto* s = std::get_if<sim::Sphere>(&shape.form)) add("sphere.center", s->center);
  if (const auto* s = std::get_if<sim::Box>(&shape.form)) add("box.center", s->center);
  if (const auto* s = std::get_if<sim::Cylinder>(&shape.form)) add("cylinder.center", s->center);
  if (const auto* s = std::get_if<sim::Cone>(&shape.form)) add("cone.center", s->center);
  if (const auto* s = std::get_if<sim::Torus>(&shape.form)) add("torus.center", s->center);
  if (const auto* s = std::get_if<sim::Mesh>(&shape.form)) add("mesh.center", s->center);
  if (const auto* s = std::get_if<sim::Plane>(&shape.form)) add("plane.point", s->point);
  if (const auto* s = std::get_if<sim::Capsule>(&shape.form)) {
    add("capsule.a", s->a);
    add("capsule.b", s->b);
  }
  if (out.places.empty()) return std::nullopt;
  out.center = sim::center(shape);
  return out;
}

std::optional<Movable> selected_object(const ViewerState& state) {
  const Scene& scene = *state.bench.document().scene();
  for (const sim::Body& body : scene.bodies)
    if (state.selected == "body." + body.name) return movable(body.shape, state.selected);
  for (const sim::Emitter& emitter : scene.emitters)
    if (state.selected == "emitter." + emitter.name) return movable(emitter.shape, state.selected);
  for (const sim::Sink& sink : scene.sinks)
    if (state.selected == "sink." + sink.name) return movable(sink.shape, state.selected);
  for (const Collider& collider : scene.colliders)
    // Keyframes say where it is: arrows that move nothing would only mislead.
    if (state.selected == "collider." + collider.name && collider.keyframes.empty())
      return movable(collider.shape, state.selected);
  return std::nullopt;
}

std::string literal(const Vec3d& value) {
  return "[" + number_text(value.x()) + ", " + number_text(value.y()) + ", " +
         number_text(value.z()) + "]";
}

/// Rounded to what a person would type at this zoom.
double rounded_move(double value, double distance) {
  const double step = std::pow(10, std::floor(std::log10(std::max(1e-9, distance))) - 2.0);
  return std::round(value / step) * step;
}

struct HandleDrag {
  int axis = -1;
  ImVec2 from{};
  Movable start{};
};

/// Arrows at the middle of the selected object. @return whether the mouse is busy with them
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
  list.AddText(
      ImVec2(from.x + 8, from.y + 8), IM_COL32(240, 244, 250, 255),
      (state.selected +
       (state.live->steps > 0 && state.selected.starts_with("body.") ? " (at the start)" : ""))
          .c_str());
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
      state.bench.set(address, literal(place), 0x68616e64u + static_cast<unsigned>(drag.axis));
  }
  return true;
}

void draw_probe_mark(const ViewerState& state) {
  if (!state.live->probe) return;
  const ProbeReading& probe = *state.live->probe;
  const Vec3d at = state.orbit.project(probe.place);
  if (!(at.z() > 0)) return;
  const ImVec2 place = on_screen(state, at);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddCircle(place, 9, IM_COL32(255, 122, 40, 255), 24, 2);
  for (const ProbeRow& row : probe.rows) {
    if (row.name != state.trace.quantity && !(state.trace.quantity.empty() && row.name == "v"))
      continue;
    char text[96];
    std::snprintf(text, sizeof text, "|%s| = %.3g %s", row.name.c_str(), row.magnitude,
                  row.unit.c_str());
    list.AddText(ImVec2(place.x + 13, place.y - 0.5f * em() + 1), IM_COL32(8, 10, 16, 200), text);
    list.AddText(ImVec2(place.x + 12, place.y - 0.5f * em()), IM_COL32(255, 190, 140, 255), text);
    return;
  }
}

void click(ViewerState& state, ImVec2 mouse, bool wants_node) {
  const auto [x, y] = in_picture(state, mouse);
  const LiveFrame& live = *state.live;
  const View& view = current_view(state);
  if (wants_node || !has_layer(view, Layer::particles)) {
    const bool is_slice = has_layer(view, Layer::arrows) || has_layer(view, Layer::heatmap);
    std::optional<Vec3d> place;
    if (is_slice && view.slice.point)
      place = pick_plane(state.orbit, x, y, slice_plane(view.slice, live.snapshot.time, {}));
    if (!place)
      if (const auto hit = pick_particle(state.orbit, x, y, live, view.clip))
        place = live.snapshot.particles.x[*hit];
    if (place) set_probe(state, ProbeTarget(*place));
    return;
  }
  if (const auto hit = pick_particle(state.orbit, x, y, live, view.clip))
    set_probe(state, ProbeTarget(std::size_t(live.snapshot.particles.id_of(*hit))));
}

void move_camera(ViewerState& state, ImVec2 delta, int button) {
  const auto height = static_cast<double>(std::max(1, state.viewport.height));
  const double dx = static_cast<double>(delta.x) / height,
               dy = static_cast<double>(delta.y) / height;
  const bool is_pan = button == 2 || (button == 0 && ImGui::GetIO().KeyShift);
  if (is_pan)
    state.orbit.pan(dx, dy);
  else if (button == 0)
    state.orbit.turn(dx, dy);
  else
    state.orbit.zoom(12 * (dx - dy), 0, 0);
  state.is_camera_of_scene = false;
}

}  // namespace

void use_viewport(ViewerState& state) {
  static int dragging = -1;
  static ImVec2 last{}, pressed{};
  static bool was_moved = false;
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 mouse = io.MousePos;
  note_label("picture", {left(state), top(state), static_cast<float>(state.viewport.width),
                         static_cast<float>(state.viewport.height)});
  const bool is_inside = mouse.x >= left(state) && mouse.y >= top(state) &&
                         mouse.x < left(state) + static_cast<float>(state.viewport.width) &&
                         mouse.y < top(state) + static_cast<float>(state.viewport.height);
  const bool is_over = is_inside && !io.WantCaptureMouse;
  draw_probe_mark(state);
  if (dragging < 0 && use_handles(state, is_over)) return;
  for (int button = 0; button < 3; ++button)
    if (dragging < 0 && is_over && ImGui::IsMouseClicked(button)) {
      dragging = button;
      last = pressed = mouse;
      was_moved = false;
    }
  if (dragging >= 0) {
    was_moved = was_moved || std::hypot(mouse.x - pressed.x, mouse.y - pressed.y) > click_slack;
    if (was_moved) move_camera(state, ImVec2(mouse.x - last.x, mouse.y - last.y), dragging);
    last = mouse;
    if (!ImGui::IsMouseDown(dragging)) {
      if (!was_moved && dragging == 0) click(state, mouse, io.KeyCtrl);
      dragging = -1;
    }
  }
  if (is_over && io.MouseWheel != 0) {
    const auto [x, y] = in_picture(state, mouse);
    state.orbit.zoom(static_cast<double>(io.MouseWheel), x, y);
    state.is_camera_of_scene = false;
  }
}

void use_keys(ViewerState& state) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput) return;
  const LiveFrame& live = *state.live;
  Session& session = state.bench.session();
  const auto pressed = [](int key) { return is_key_pressed(key); };
  if (io.KeyCtrl) {
    if (pressed('Z')) io.KeyShift ? state.bench.redo() : state.bench.undo();
    if (pressed('Y')) state.bench.redo();
    if (pressed('S')) state.bench.save_scene(state.bench.folder() / "scene.toml");
    return;
  }
  if (pressed(' ')) toggle_run(state);
  if (pressed('.')) session.next_frame();
  if (pressed(',')) session.next_step();
  if (pressed(';')) {
    session.next_stage();
    state.go_to_tab = tab::inspect;
  }
  if (pressed('R')) state.bench.reset();
  if (pressed('P')) state.wants_picture = true;
  if (pressed('F')) io.KeyShift ? frame_all(state) : frame_selection(state);
  for (int axis = 0; axis < 3; ++axis)
    if (pressed('X' + axis)) {
      state.orbit.look_along(axis);
      state.is_camera_of_scene = false;
    }
  const std::vector<View>& views = state.bench.document().scene()->views;
  for (std::size_t k = 0; k < std::min<std::size_t>(9, views.size()); ++k)
    if (pressed('1' + static_cast<int>(k))) choose_view(state, views[k].name);
  if (pressed('/') && io.KeyShift) state.is_help_open = !state.is_help_open;
  if (pressed('?') || pressed(key::f1)) state.is_help_open = !state.is_help_open;
  if (pressed(key::escape)) {
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup))
      ImGui::ClosePopupToLevel(0, true);
    else if (state.is_help_open)
      state.is_help_open = false;
    else if (state.probe)
      set_probe(state, std::nullopt);
    else
      state.selected.clear();
  }
  if (pressed(key::tab)) {
    const bool is_on = state.panels.left || state.panels.right;
    state.panels = {!is_on, !is_on};
  }
  if (is_key_pressed(key::left, true)) session.show_frame(std::max(0, live.frame - 1));
  if (is_key_pressed(key::right, true)) {
    const auto next = std::upper_bound(live.kept.begin(), live.kept.end(), live.frame);
    if (next == live.kept.end() || *next >= live.head)
      session.show_head();
    else
      session.show_frame(*next);
  }
  if (pressed(key::home)) session.show_frame(0);
  if (pressed(key::end)) session.show_head();
}

}  // namespace neve::app
