/// The tool that throws balls into the picture.

#include <algorithm>
#include <cmath>

#include "app/support/round_number.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/pick.h"
#include "app/view/panels/tip.h"
#include "app/view/panels/viewport.h"

namespace neve::app::view::panels {

namespace {

using sim::Vec3d;

/// Numbers that suit what is looked at: a ball that snow of these cells feels, and less than half a
/// second of flight.
void choose_numbers(ViewerState& state) {
  Throwing& throwing = state.throwing;
  if (throwing.radius > 0 || !state.live) return;
  constexpr double size = 0.018, flight = 0.8, fewest_cells = 3;
  const double distance = state.orbit.distance();
  const double radius =
      std::max(size * distance, fewest_cells * state.live->scene->solver.cell_size);
  throwing.radius = round_to(radius, radius, 2);
  throwing.speed = round_to(distance / flight, distance / flight, 2);
}

void slider(const char* name, const char* format, double low, double high, double& value) {
  ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &low, &high, format,
                      ImGuiSliderFlags_Logarithmic);
  if (std::isfinite(value))
    value = std::clamp(value, low, high);
  else
    value = low;
  note_label(name);
}

/// Returns the start of a ball: a part of the way to its target, in front of all colliders.
Vec3d start_of(const ViewerState& state, const Vec3d& ray, double reach) {
  constexpr double part = 0.5;
  const session::LiveFrame& live = *state.live;
  const double radius = state.throwing.radius;
  double along = std::max(0.0, std::min(part * reach, reach - 2 * radius));
  const auto is_free = [&](const Vec3d& place) {
    return std::all_of(live.scene->colliders.begin(), live.scene->colliders.end(),
                       [&](const sim::shapes::Collider& collider) {
                         return sim::shapes::signed_distance(collider, live.snapshot.time, place) >=
                                radius;
                       });
  };
  constexpr int looks = 8;
  const double step = along / looks;
  for (int look = 0; look < looks && !is_free(state.orbit.eye() + along * ray); ++look)
    along -= step;
  return state.orbit.eye() + std::max(0.0, along) * ray;
}

/// m/s, to be at a place after the time that the way takes at this speed: a little faster where
/// gravity has to be made up for.
Vec3d velocity_to(const Vec3d& way, double speed, const Vec3d& gravity) {
  const double seconds = way.norm() / speed;
  return way / seconds - 0.5 * seconds * gravity;
}

}  // namespace

void switch_throwing(ViewerState& state) {
  state.throwing.is_on = !state.throwing.is_on;
}

void throw_ball(ViewerState& state, ImVec2 mouse) {
  if (!state.live) return;
  choose_numbers(state);
  const auto hint = [&](const char* text) { state.hint = {text, mouse.x, mouse.y, hint_seconds}; };
  if (state.live->is_older)
    return hint("an older frame: go to the end, or continue from here, to throw");
  const auto [x, y] = in_picture(state, mouse);
  const Vec3d ray = state.orbit.ray(x, y);
  const std::optional<Vec3d> target = pick_surface(state.orbit, x, y, *state.live);
  const Throwing& throwing = state.throwing;
  const Vec3d eye = state.orbit.eye();
  const Vec3d from = start_of(state, ray, target ? (*target - eye).norm() : state.orbit.distance());
  const Vec3d way = target ? Vec3d(*target - from) : Vec3d(Vec3d::Zero());
  const Vec3d velocity = way.norm() > throwing.radius
                             ? velocity_to(way, throwing.speed, state.live->scene->solver.gravity)
                             : Vec3d(throwing.speed * ray);
  const std::string thrown =
      state.bench.throw_ball({from, velocity, throwing.radius, throwing.density});
  if (!thrown.empty()) hint(state.live->is_running ? "thrown" : "thrown: it flies with Run");
}

void draw_throwing(ViewerState& state) {
  Throwing& throwing = state.throwing;
  ImGui::Checkbox("Throw balls", &throwing.is_on);
  note_label("Throw balls");
  tip("a click in the picture throws a ball at that place; key B");
  if (!throwing.is_on) return;
  choose_numbers(state);
  ImGui::Indent(em());
  ImGui::PushItemWidth(-7 * em());
  slider("radius", "%.3g m", 1e-3, 100, throwing.radius);
  slider("density", "%.4g kg/m3", 1, 2e4, throwing.density);
  slider("speed", "%.3g m/s", 0.01, 200, throwing.speed);
  ImGui::PopItemWidth();
  ImGui::Unindent(em());
}

}  // namespace neve::app::view::panels
