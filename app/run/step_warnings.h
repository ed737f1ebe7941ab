#pragma once
/// Warnings of a run about its steps.

#include <string>
#include <vector>

#include "sim/simulation.h"

namespace neve::app::run {

/// A sentence for each way in which the steps so far may not be trusted: fixed ones are used as
/// they are, whatever they risk; adaptive ones stop the run instead.
std::vector<std::string> step_warnings(const sim::SolverSettings& settings,
                                       const sim::Warnings& warnings);

}  // namespace neve::app::run
