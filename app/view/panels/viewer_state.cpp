#include "app/view/panels/viewer_state.h"

#include <imgui.h>

#include <algorithm>

#include "app/health/incident.h"

namespace neve::app::view::panels {

namespace {

sim::shapes::Bounds bounds_of(const std::vector<sim::Vec3d>& places, std::size_t first,
                              std::size_t end) {
  sim::shapes::Bounds box{sim::Vec3d::Constant(1e300), sim::Vec3d::Constant(-1e300)};
  for (std::size_t p = first; p < end; ++p) {
    if (!places[p].allFinite()) continue;
    box.min = box.min.cwiseMin(places[p]);
    box.max = box.max.cwiseMax(places[p]);
  }
  return box;
}

/// Colliders, emitters and sinks this many times as large as the snow are places, not things.
constexpr double things_up_to = 8;

void frame_box(ViewerState& state, const sim::shapes::Bounds& box) {
  if (!(box.min.x() <= box.max.x())) return;
  const double aspect =
      static_cast<double>(state.viewport.width) / std::max(1, state.viewport.height);
  state.orbit.frame(box, aspect);
  state.is_camera_of_scene = false;
}

}  // namespace

sim::shapes::Bounds bounds_of_all(const session::LiveFrame& live) {
  const std::vector<sim::Vec3d>& x = live.snapshot.particles.x;
  sim::shapes::Bounds box = bounds_of(x, 0, x.size());
  const bool has_snow = box.min.x() <= box.max.x();
  const double largest =
      has_snow ? things_up_to * std::max(1e-3, (box.max - box.min).norm()) : 1e300;
  const auto add = [&](const sim::shapes::Bounds& bounds) {
    if (!((bounds.max - bounds.min).norm() <= largest)) return;
    box.min = box.min.cwiseMin(bounds.min);
    box.max = box.max.cwiseMax(bounds.max);
  };
  for (const scene::Collider& collider : live.scene->colliders)
    if (!std::holds_alternative<sim::shapes::Plane>(collider.shape.form))
      add(sim::shapes::bounds_at(collider, live.snapshot.time));
  for (const auto& emitter : live.scene->emitters) add(sim::shapes::bounds(emitter.shape));
  for (const auto& sink : live.scene->sinks) add(sim::shapes::bounds(sink.shape));
  return box;
}

float em() {
  return ImGui::GetFontSize();
}

const scene::View& current_view(const ViewerState& state) {
  const std::vector<scene::View>& views = state.bench.document().scene()->views;
  const auto found = std::find_if(views.begin(), views.end(),
                                  [&](const scene::View& view) { return view.name == state.view; });
  return found == views.end() ? views.front() : *found;
}

scene::View view_to_keep(const ViewerState& state) {
  scene::View view = current_view(state);
  // The orbit of a moving camera is widened where the window is narrower than the picture.
  if (!state.is_camera_of_scene)
    view.camera = state.orbit.settings();
  else if (!view.camera)
    view.camera = state.bench.document().scene()->camera;
  return view;
}

void copy_command(ViewerState& state) {
  if (const std::string command = state.bench.command(); !command.empty()) state.copy(command);
}

void set_probe(ViewerState& state, std::optional<dump::Probe> probe) {
  state.probe = probe;
  state.trace.points.clear();
  state.trace.target = probe;
  state.last_followed.reset();
  state.bench.session().set_probe(std::move(probe));
}

void toggle_run(ViewerState& state) {
  state.is_playing = false;
  if (!state.live) return;
  if (state.live->is_running)
    state.bench.session().pause();
  else
    state.bench.session().run();
}

void ProbeTrace::take(const session::LiveFrame& live) {
  run.follow(live, points, [](const auto& point) { return point.first; });
  if (!live.probe || live.probed != target) return;
  if (quantity.empty() && !live.probe->rows.empty()) quantity = live.probe->is_node ? "v_old" : "v";
  for (const session::ProbeRow& row : live.probe->rows)
    if (row.name == quantity) points[live.probe->time] = row.magnitude;
}

bool is_newest(const session::LiveFrame& live, int frame) {
  return frame > live.head || (frame == live.head && live.is_head_frame_end);
}

void show_frame(ViewerState& state, int frame) {
  if (is_newest(*state.live, frame))
    state.bench.session().show_head();
  else
    state.bench.session().show_frame(frame);
}

void frame_all(ViewerState& state) {
  if (state.live) frame_box(state, bounds_of_all(*state.live));
}

void frame_selection(ViewerState& state) {
  if (!state.live) return;
  if (state.live->probe) {
    const sim::Vec3d half = sim::Vec3d::Constant(4 * state.live->scene->solver.cell_size);
    frame_box(state, {state.live->probe->place - half, state.live->probe->place + half});
    return;
  }
  const std::vector<sim::seeding::Body>& bodies = state.live->scene->bodies;
  const setup::SeededScene& seeded = *state.live->seeded;
  for (std::size_t b = 0; b < std::min(bodies.size(), seeded.body_end.size()); ++b) {
    if (state.selected != "body." + bodies[b].name) continue;
    const sim::ParticleArrays& p = state.live->snapshot.particles;
    const std::size_t first = p.first_from(seeded.body_begin(b));
    frame_box(state, bounds_of(p.x, first, p.first_from(seeded.body_end[b])));
    return;
  }
  const auto frame_shape = [&](const char* list, const auto& items) {
    for (const auto& item : items)
      if (state.selected == list + item.name) {
        frame_box(state, sim::shapes::bounds(item.shape));
        return true;
      }
    return false;
  };
  if (frame_shape("emitter.", state.live->scene->emitters) ||
      frame_shape("sink.", state.live->scene->sinks))
    return;
  for (const scene::Collider& collider : state.live->scene->colliders) {
    if (state.selected != "collider." + collider.name) continue;
    if (std::holds_alternative<sim::shapes::Plane>(collider.shape.form)) {
      state.orbit.move_target(sim::shapes::pose_at(collider, state.live->snapshot.time).point);
    } else {
      frame_box(state, sim::shapes::bounds_at(collider, state.live->snapshot.time));
    }
    return;
  }
  frame_all(state);
}

void show_incident(ViewerState& state) {
  if (!state.live || !state.live->divergence) return;
  const sim::Divergence& divergence = *state.live->divergence;
  state.shows_incident = true;
  if (!divergence.x.allFinite()) return;
  const sim::Vec3d half = sim::Vec3d::Constant(6 * state.live->scene->solver.cell_size);
  frame_box(state, {divergence.x - half, divergence.x + half});
  if (divergence.particle >= 0)
    set_probe(state, dump::Probe(static_cast<std::size_t>(divergence.particle)));
}

}  // namespace neve::app::view::panels
