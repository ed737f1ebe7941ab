#pragma once
/// Shape statistics of the snow of a state.

#include <cstddef>
#include <optional>
#include <vector>

#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::record {

/// The metrics of a frame. If a scene has snow, sand and elastic bodies do not count: they neither
/// break nor pack.
struct Metrics {
  double spread = 0;    ///< m, horizontal radius about the centre that holds 90 % of the particles
  double height = 0;    ///< m, between the lowest and the highest 2 % of the particles
  double mean_J_P = 1;  ///< weighted by mass
  std::size_t fragments = 0;    ///< groups of occupied cells that touch, corners included
  double largest_fragment = 0;  ///< share of the particles that are in the largest of them
  std::size_t particles = 0;    ///< that count; 0: there are none
  double powder = 0;            ///< share of the particles that are alone in theirs
  double crumbs = 0;            ///< share of them in groups of 2 to 100
  double max_depth_cells = 0;   ///< of the particle that is deepest in a collider, cells
};

/// Snow has broken once its largest piece holds less than this share of what it held at first.
/// Measured on snowballs of cam clay that fall: one that keeps its shape loses up to 1 % as dust;
/// of one that bursts into a core, pieces and crumbs 1 to 8 % lie apart, since heaped pieces touch.
inline constexpr double whole_share = 0.99;

/// Returns the particles of the largest piece at last over those at first; for runs that did not
/// keep their numbers, the ratio of its shares. Returns nothing if one of them has no snow.
std::optional<double> held_whole(const Metrics& first, const Metrics& last);

/// True if snow has broken between two frames of a run: what emitters add does not count. Nothing
/// if one of them has no snow, and where sinks have taken what the largest piece lacks.
std::optional<bool> has_broken(const Metrics& first, const Metrics& last);

/// Particles whose position is no number are left out.
/// @param cell_size   m, of the solver: snow closer than a cell is one piece
/// @param is_counted  one for each material; empty: all count
Metrics measure(const sim::ParticleArrays& particles, double cell_size,
                const std::vector<bool>& is_counted = {});
Metrics measure(const sim::ParticleArrays& particles, const scene::Scene& scene);

}  // namespace neve::app::record
