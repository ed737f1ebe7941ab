/// The picture under the mouse: camera and probing.

#include "app/view/panels/viewport.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/picture/frame_builder.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/pick.h"

namespace neve::app::view::panels {

namespace {

using sim::Vec3d;

/// Largest movement of a click, px; a mouse that moved further was dragged.
constexpr float click_slack = 4;

float left(const ViewerState& s) {
  return static_cast<float>(s.viewport.x);
}
float top(const ViewerState& s) {
  return static_cast<float>(s.viewport.y);
}

/// Nodes have something to tell as far from a particle as its weights reach.
bool is_in_snow(const session::LiveFrame& live, const Vec3d& place) {
  const double reach = 2 * live.scene->solver.cell_size;
  const std::vector<Vec3d>& x = live.snapshot.particles.x;
  return std::any_of(x.begin(), x.end(),
                     [&](const Vec3d& x_p) { return (x_p - place).squaredNorm() < reach * reach; });
}

/// The particle under the mouse; of a slice, or where a node is wanted, a place that has one.
std::optional<dump::Probe> pick(const ViewerState& state, ImVec2 mouse, bool wants_node) {
  const auto [x, y] = in_picture(state, mouse);
  const session::LiveFrame& live = *state.live;
  const scene::View& view = current_view(state);
  const bool takes_node = wants_node || !scene::shows_particles(view);
  if (takes_node && scene::shows_slice(view)) {
    const auto place = pick_plane(
        state.orbit, x, y, picture::plane_of(*live.scene, view, *live.seeded, live.snapshot));
    if (place && is_in_snow(live, *place)) return dump::Probe(*place);
  }
  const auto hit = pick_particle(state.orbit, x, y, live, view.clip);
  if (!hit) return std::nullopt;
  const sim::ParticleArrays& particles = live.snapshot.particles;
  return takes_node ? dump::Probe(particles.x[*hit])
                    : dump::Probe(static_cast<std::size_t>(particles.id_of(*hit)));
}

void click(ViewerState& state, ImVec2 mouse, bool wants_node) {
  if (state.throwing.is_on) return throw_ball(state, mouse);
  if (auto target = pick(state, mouse, wants_node))
    set_probe(state, std::move(target));
  else
    state.hint = {"no snow here", mouse.x, mouse.y, hint_seconds};
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

ImVec2 on_screen(const ViewerState& state, const Vec3d& projected) {
  const auto height = static_cast<float>(state.viewport.height);
  return {left(state) + 0.5f * static_cast<float>(state.viewport.width) +
              height * static_cast<float>(projected.x()),
          top(state) + height * (0.5f - static_cast<float>(projected.y()))};
}

std::array<double, 2> in_picture(const ViewerState& state, ImVec2 mouse) {
  const auto height = static_cast<double>(state.viewport.height);
  return {(static_cast<double>(mouse.x - left(state)) - 0.5 * state.viewport.width) / height,
          0.5 - static_cast<double>(mouse.y - top(state)) / height};
}

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
  if (state.sweep.shows_sheet) {
    if (is_over && ImGui::IsMouseClicked(0)) state.sweep.shows_sheet = false;
    dragging = -1;
    return;
  }
  draw_marks(state);
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

}  // namespace neve::app::view::panels
