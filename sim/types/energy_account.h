#pragma once
/// Energy of a run, and the energy that is explained.

#include <algorithm>

namespace neve::sim {

struct EnergyAccount {
  double found = 0;      ///< J, kinetic and elastic, now
  double explained = 0;  ///< J, at the start plus the work of gravity and of moving colliders
  double scale = 0;      ///< J, the most that was explained so far; at least what rounding may do
  /// J, that may come when the affine velocities of particles and their own ones trade momentum;
  /// see health::traded_share.
  double traded = 0;
  /// Snow can only lose energy: beyond the law of energy (sim/health/limits.h) the steps make it.
  double ratio() const {
    const double more = found - explained;
    return scale > 0 ? 1 + (more > 0 ? std::max(0.0, more - traded) : more) / scale : 1;
  }
};

}  // namespace neve::sim
