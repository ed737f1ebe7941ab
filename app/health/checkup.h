#pragma once
/// Forecast of the cost of a scene, and findings about its numbers, before a run.

#include <string>
#include <vector>

#include "app/health/forecast.h"
#include "app/setup/plan.h"

namespace neve::app::health {

struct Checkup {
  setup::Plan plan;
  double cells = 0;         ///< that the bodies fill
  double impact_speed = 0;  ///< m/s, see auto_ranges
  sim::StepLimits start;    ///< of the initial state
  double dt_start = 0;      ///< s, of the first step
  sim::DtLimit limit_start = sim::DtLimit::max_dt;
  std::vector<FrameForecast> forecast;  ///< frames that a coarse run reached; may be empty
  double coarse_particles = 0;          ///< of the run behind the forecast
  Spread spread{};                      ///< at the start
  double seconds_per_step = 0;          ///< measured on this machine; 0: not measured
  /// Steps of the run if its impact crushes a single particle that flies on to the end; 0: none is
  /// to be expected.
  double crushed_steps = 0;
  sim::SolveReport solve;  ///< of these steps; zero where they are explicit
  double coarsening = 1;   ///< of --coarsen, for advice
  std::vector<Finding> findings;

  double steps() const;    ///< forecast for the whole run
  double seconds() const;  ///< forecast of the simulation
  double seconds_of(const FrameForecast& frame) const;
  /// The truth lies between on every shipped scene.
  scene::Range steps_range() const;
  scene::Range seconds_range() const;
};

/// Seeds the scene, takes some steps, and runs coarse copies: about four seconds.
/// @param scene resolved is not needed
/// @param coarsening  factor of --coarsen
Checkup examine(const scene::Scene& scene, const setup::Plan& plan, int threads,
                double coarsening = 1);

}  // namespace neve::app::health
