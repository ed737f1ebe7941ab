#pragma once
/// Warnings of a run about its steps.

#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::run {

/// A sentence for each way in which the steps so far may not be trusted: fixed ones are used as
/// they are, whatever they risk; adaptive ones stop the run instead. Snow at the limit of its
/// compaction has one, too.
std::vector<std::string> step_warnings(const scene::Scene& scene,
                                       const sim::Simulation& simulation);

}  // namespace neve::app::run
