#include "sim/retry.h"

#include <algorithm>
#include <cstdint>

namespace neve::sim {

AdvanceReport advance_retrying(Simulation& simulation, double time, const StepObserver& after_step,
                               std::vector<Retry>& retries) {
  const std::vector<std::uint8_t> good = simulation.save();
  const std::size_t retries_before = retries.size();
  const double start = simulation.time();
  AdvanceReport report = simulation.advance_to(time, after_step);
  const auto is_interrupted = [&] { return simulation.time() < time && !simulation.divergence(); };
  for (int count = 0; count < max_retries && simulation.divergence(); ++count) {
    const Divergence broken = *simulation.divergence();
    const double scale = 0.5 * simulation.dt_scale();
    simulation.restore(good);
    simulation.set_dt_scale(scale);
    retries.push_back({broken.step, broken.time, start, scale, broken.rule, broken.sentence});
    report = simulation.advance_to(time, after_step);
  }
  if (is_interrupted()) {
    simulation.restore(good);
    retries.resize(retries_before);
    return {};
  }
  if (!simulation.divergence()) simulation.set_dt_scale(std::min(1.0, 2 * simulation.dt_scale()));
  return report;
}

}  // namespace neve::sim
