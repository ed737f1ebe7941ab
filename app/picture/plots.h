#pragma once
/// Diagnostics over time as plots: energies, largest speed, largest force on a collider, time step
/// and its limit.

#include <optional>
#include <span>
#include <vector>

#include "app/scene/scene.h"
#include "render/frame/frame.h"
#include "sim/simulation.h"

namespace neve::app::picture {

/// Data of one frame for the plots.
struct PlotSample {
  double time = 0;                                ///< s
  double kinetic_energy = 0, elastic_energy = 0;  ///< J
  double max_speed = 0;                           ///< m/s
  double max_force = 0;                       ///< N, on a collider: the mean since the frame before
  std::size_t steps = 0;                      ///< since the frame before
  sim::DtLimit limit = sim::DtLimit::max_dt;  ///< the one that ruled most of them
};

/// @param interval s, that the advance took
PlotSample plot_sample(double time, double interval, const sim::Summary& summary,
                       const sim::AdvanceReport& advance);

/// @param history one sample per frame, in order; those later than `now` are left out
/// Without colliders there is no plot of forces.
/// @param interval s, between frames
/// @param duration s, of the whole scene
std::vector<render::Plot> make_plots(const scene::PlotRanges& ranges, bool has_colliders,
                                     std::span<const PlotSample> history, double now,
                                     double interval, double duration);

}  // namespace neve::app::picture
