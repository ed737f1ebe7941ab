#include "sim/types/reports.h"

#include <algorithm>
#include <cmath>

namespace neve::sim {

const char* name(DtLimit limit) {
  static constexpr const char* names[dt_limit_count] = {"max_dt", "cfl",       "acoustic", "strain",
                                                        "fixed",  "frame_end", "collider"};
  return names[static_cast<int>(limit)];
}

DtLimit AdvanceReport::limit() const {
  return static_cast<DtLimit>(std::max_element(ruled.begin(), ruled.end()) - ruled.begin());
}

void SolveReport::add(const SolveReport& other) {
  if (other.solves == 0) return;
  if (solves == 0 || std::isnan(residual))
    residual = other.residual;
  else if (!std::isnan(other.residual))
    residual = std::max(residual, other.residual);
  solves += other.solves;
  iterations = std::max(iterations, other.iterations);
  all_iterations += other.all_iterations;
  cut_short += other.cut_short;
  given_up += other.given_up;
}

double AdvanceReport::max_force() const {
  double max = 0;
  if (seconds > 0)
    for (const ColliderLoad& load : loads) max = std::max(max, load.impulse.norm() / seconds);
  return max;
}

void AdvanceReport::append(const AdvanceReport& later) {
  if (later.steps == 0) return;
  dt_min = steps == 0 ? later.dt_min : std::min(dt_min, later.dt_min);
  dt_max = std::max(dt_max, later.dt_max);
  steps += later.steps;
  for (std::size_t k = 0; k < ruled.size(); ++k) ruled[k] += later.ruled[k];
  seconds += later.seconds;
  loads.resize(std::max(loads.size(), later.loads.size()));
  for (std::size_t k = 0; k < later.loads.size(); ++k) {
    loads[k].impulse += later.loads[k].impulse;
    loads[k].angular_impulse += later.loads[k].angular_impulse;
  }
  if (!later.solve) return;
  if (!solve) solve.emplace();
  solve->add(*later.solve);
}

}  // namespace neve::sim
