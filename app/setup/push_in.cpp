#include "app/setup/push_in.h"

#include <algorithm>
#include <cmath>

#include "app/setup/subject.h"

namespace neve::app::setup {

namespace {

using sim::Vec3d;

constexpr double min_known = 0.6;  // share of the scene that the coarse run has to reach
constexpr double latest_begin = 0.5, end_of_move = 0.92;  // of the scene
constexpr double halvings_a_second = 1;
constexpr double max_part = 0.88;  // of the distance: less of a move is none
constexpr double min_part =
    0.4;  // of the distance: colliders should still be seen as what they are

/// Snow of the last moments; a sweep brings those of several runs.
std::vector<Vec3d> settled_snow(const std::vector<CoarseMoment>& moments) {
  constexpr double last = 0.98;
  std::vector<Vec3d> points;
  for (const CoarseMoment& moment : moments)
    if (moment.time >= last * moments.back().time) {
      const std::vector<Vec3d> core = heap_of(moment.x);
      points.insert(points.end(), core.begin(), core.end());
    }
  return points;
}

bool is_inside(const std::vector<Vec3d>& points, const Shot& shot, const Lens& lens) {
  const Extent seen = extent_of(turned_backwards(points, shot.framing.target, lens), shot, lens);
  return seen.left > -1 && seen.right < 1 && seen.bottom > -1 && seen.top < 1;
}

/// Returns the time from which the snow stays where a shot sees it, to the end.
double time_inside(const std::vector<CoarseMoment>& moments, const Shot& shot, const Lens& lens) {
  double time = moments.back().time;
  for (auto moment = moments.rbegin(); moment != moments.rend(); ++moment) {
    if (!is_inside(heap_of(moment->x), shot, lens)) break;
    time = moment->time;
  }
  return time;
}

double in_milliseconds(double time) {
  return std::round(1000 * time) / 1000;
}

}  // namespace

std::optional<PushIn> push_in(const std::vector<CoarseMoment>& moments, const Shot& whole,
                              const Lens& lens, double duration) {
  if (moments.empty() || !(duration > 0) || moments.back().time < min_known * duration) return {};
  const std::vector<Vec3d> points = settled_snow(moments);
  if (points.empty()) return {};
  const Vec3d middle = box_of(points).center();
  const Framing settled =
      fit(turned_backwards(points, middle, lens), middle, whole.towards_eye, lens);
  const double end = in_milliseconds(end_of_move * duration);
  const double inside = time_inside(moments, {settled, whole.towards_eye}, lens);
  const double begin = in_milliseconds(std::min(inside, latest_begin * duration));
  const double slow = std::exp2(-halvings_a_second * (end - begin));
  const double part = std::max({settled.distance / whole.framing.distance, slow, min_part});
  if (part > max_part) return {};
  // The move ends at a place on the way if all of it would be too far for the time.
  const double way =
      (1 - part) * whole.framing.distance / (whole.framing.distance - settled.distance);
  return PushIn{begin, end, between(whole.framing, settled, way)};
}

}  // namespace neve::app::setup
