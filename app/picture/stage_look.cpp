#include "app/picture/stage_look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "app/picture/to_float.h"
#include "app/support/round_number.h"

namespace neve::app::picture {

namespace {

/// The longest arrow, in cells.
constexpr double longest_arrow = 1.6;
/// Arrows below this share of the longest are dots that say nothing.
constexpr double shortest_arrow = 0.02;

}  // namespace

double StageChange::largest() const {
  // The few that are pressed, and spray, must not hide the others.
  constexpr double share = 0.9;
  std::vector<double> changed;
  for (const double value : magnitude)
    if (std::isfinite(value) && value > 0) changed.push_back(value);
  if (changed.empty()) return 0;
  const auto at = changed.begin() +
                  static_cast<std::ptrdiff_t>(share * static_cast<double>(changed.size() - 1));
  std::nth_element(changed.begin(), at, changed.end());
  return round_up(*at);
}

bool shows_particles_of(const scene::View& view, const StageChange& change) {
  return scene::shows_particles(view) || !scene::shows_slice(view) || !change.is_of_nodes;
}

scene::View without_snow(scene::View view) {
  using enum scene::Layer;
  std::erase_if(view.layers, [](scene::Layer layer) {
    return layer == particles || layer == snow || layer == smoke;
  });
  return view;
}

StageCut::StageCut(const scene::View& view, const SlicePlane& at, const sim::Vec3d& eye,
                   double cell)
    : plane(at),
      side((eye - at.point).dot(at.normal) >= 0 ? 1 : -1),
      cell_size(cell),
      is_layer(scene::shows_slice(view) && !scene::shows_particles(view)) {}

void add_stage_change(const Snapshot& snapshot, const StageLook& look, render::Frame& frame) {
  const StageChange& change = *snapshot.stage_change;
  const StageCut& cut = look.cut;
  const double largest = look.largest;
  const render::Legend legend{change.title, change.unit, render::ColorMap::viridis, 0,
                              static_cast<float>(largest > 0 ? largest : 1)};
  frame.legends.insert(frame.legends.begin(), legend);
  if (change.vector.empty() || !(largest > 0)) return;
  render::Arrows arrows;
  arrows.colormap = legend.colormap;
  arrows.range_max = legend.max;
  arrows.is_white = true;
  arrows.max_length = static_cast<float>(longest_arrow * cut.cell_size);
  arrows.length_per_value = arrows.max_length / legend.max;
  std::set<std::array<int, 2>> taken;  // cells of the plane
  for (std::size_t p = 0; p < snapshot.particles.x.size(); ++p) {
    const sim::Vec3d& x = snapshot.particles.x[p];
    if (!x.allFinite() || cut.removes(x) || cut.above(x) < -0.5 * cut.cell_size) continue;
    if (!(change.magnitude[p] > shortest_arrow * largest)) continue;
    const auto cell = [&](const sim::Vec3d& axis) {
      return static_cast<int>(std::clamp(std::floor(x.dot(axis) / cut.cell_size), -2e9, 2e9));
    };
    if (!taken.insert({cell(cut.plane.across), cell(cut.plane.up)}).second) continue;
    // An arrow begins in front of the particles of the cut, which would hide its tail.
    const double lift = 0.5 * cut.cell_size - cut.above(x);
    arrows.position.edit().push_back(to_float(sim::Vec3d(x + lift * cut.side * cut.plane.normal)));
    arrows.vector.edit().push_back(to_float(change.vector[p]));
  }
  frame.arrows.push_back(std::move(arrows));
}

}  // namespace neve::app::picture
