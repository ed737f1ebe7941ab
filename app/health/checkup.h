#pragma once
/// Forecast of the cost of a scene, and findings about its numbers, before a run.

#include <string>
#include <vector>

#include "app/setup/plan.h"
#include "sim/engine/time_step.h"

namespace neve::app::health {

enum class Severity { note, warning, error };

/// Result of a check; `address` names the parameter, or is empty.
struct Finding {
  Severity severity = Severity::warning;
  std::string address, what, hint;
};

/// Spread of the snow over the grid.
struct Spread {
  double blocks = 0;  ///< per particle; 0: not known
  double alone = 0;   ///< share of the blocks that have no neighbour
};

/// Forecast of the steps of one frame.
struct FrameForecast {
  int frame = 0;
  double dt = 0;     ///< s
  double steps = 0;  ///< in this frame
  /// The same if the stiffest particle is as that of the copy, and if it is one that is rarer than
  /// in 19 runs of 20.
  double least_steps = 0, most_steps = 0;
  sim::DtLimit limit = sim::DtLimit::max_dt;
  double iterations = 0;  ///< of the solve of a semi-implicit step, the mean; 0: explicit
  Spread spread{};        ///< of the copy at the frame's end
  /// Cost of a step of the scene relative to the first, by the spread of the snow over the grid: in
  /// pieces as large as at the start, and in single particles.
  double cost = 1, max_cost = 1;
};

/// The steps of a run, foretold by a coarse copy of it, or by the finer one of two.
struct Forecast {
  std::vector<FrameForecast> frames;     ///< that the copy reached; those after are as the last
  double particles = 0;                  ///< of the copy; 0: there is none
  double seconds_per_particle_step = 0;  ///< of the copy, on one thread
  Spread spread{};                       ///< of the copy at the start
  std::string divergence;                ///< of the copy, a sentence; empty if it holds
  std::vector<Finding> findings;         ///< about the scene, from the copy

  double steps_until(int frame) const;
  /// Counts in explicit steps; an iteration of a semi-implicit step costs a quarter of one.
  double work_until(int frame) const;
};

/// Bounds the cost of the coarse copies of a forecast. Particle-steps are the same on every
/// machine.
struct ForecastBudget {
  double seconds, particle_steps;  ///< of each copy
  double particles = 1500;         ///< of the first copy, about
  /// Of a second copy, as fine as they allow: a few cells do not pack and harden as many do. 0:
  /// none.
  double fine_particle_steps = 0;
};

/// @param particles of the scene
/// @param last the last frame of the run
Forecast foresee(const scene::Scene& scene, double particles, int last,
                 const ForecastBudget& budget);

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
