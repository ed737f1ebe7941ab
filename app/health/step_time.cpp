#include "app/health/step_time.h"

#include <algorithm>
#include <vector>

#include "app/support/clock.h"
#include "app/support/interrupt.h"

namespace neve::app::health {

StepTime measure_steps(sim::Simulation& simulation, double frame, const StepTiming& timing) {
  StepTime time;
  std::vector<double> seconds;
  const auto start = Clock::now();
  for (int k = 0; k < timing.steps && seconds_since(start) < timing.seconds; ++k) {
    const auto before = Clock::now();
    simulation.step(simulation.choose_dt(frame).dt);
    time.solve.add(simulation.last_solve());
    ++time.steps;
    if (k >= 2) seconds.push_back(seconds_since(before));
    if (simulation.divergence() || is_interrupted()) break;
  }
  if (seconds.empty()) return time;
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  time.seconds = *middle;
  return time;
}

}  // namespace neve::app::health
