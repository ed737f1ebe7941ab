#pragma once
/// Forecast of the cost of a scene, and findings about its numbers, before a run.

#include <string>
#include <vector>

#include "app/forecast/forecast.h"
#include "app/health/finding.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/plan.h"

namespace neve::app::health {

struct Check {
  setup::Plan plan;
  double cells = 0;         ///< that the bodies fill
  double impact_speed = 0;  ///< m/s, of the snow, or of a collider that hits it
  setup::Impact hardest;
  sim::StepLimits start;  ///< of the initial state
  double dt_start = 0;    ///< s, of the first step
  sim::DtLimit limit_start = sim::DtLimit::max_dt;
  forecast::Forecast foreseen;  ///< by a coarse run
  double seconds_per_step = 0;  ///< measured on this machine; 0: not measured
  double dust_steps = 0;        ///< of dust and its air, at most
  sim::SolveReport solve;       ///< of these steps; zero where they are explicit
  double coarsening = 1;        ///< of --coarsen, for advice
  std::vector<Finding> findings;

  forecast::Cost seconds() const;  ///< of the simulation
  /// m/s, in the snow of the hardest impact; 0: not known.
  double sound_at_hardest() const { return start.max_sound_speed * hardest.share_of_sound; }
};

/// Seeds the scene, takes some steps, and runs coarse copies: four to twelve seconds, at most
/// twenty where steps are short and snow is spread out.
/// @param scene resolved is not needed
/// @param coarsening  factor of --coarsen
/// @param set  addresses that the command line gives values to
Check examine(const scene::Scene& scene, const setup::Plan& plan, int threads,
              double coarsening = 1, const std::vector<std::string>& set = {});

}  // namespace neve::app::health
