#pragma once
/// Energy of a run, and the energy that is explained.

namespace neve::sim {

struct EnergyAccount {
  double found = 0;      ///< J, kinetic and elastic, now
  double explained = 0;  ///< J, at the start plus the work of gravity and of moving colliders
  double scale = 0;      ///< J, the most that was explained so far, and at least a cell's fall
  /// Snow can only lose energy: beyond the law of energy (sim/health/limits.h) the steps make it.
  double ratio() const { return scale > 0 ? 1 + (found - explained) / scale : 1; }
};

}  // namespace neve::sim
