#pragma once
/// Notes on what makes a run slow, and on the values that would not.

#include <vector>

#include "app/health/check.h"

namespace neve::app::health {

/// A note on the parameter that multiplies the steps, or the cost of each, beside what its default
/// takes; where none stands out and the run is very long, on its cells. Nothing is said of short
/// runs. The notes depend on the scene alone, never on the machine.
/// @param check  with its forecast
void check_slowness(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings);

}  // namespace neve::app::health
