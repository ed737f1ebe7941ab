#pragma once
/// Warnings of a run about its steps and about frames that take long.

#include <optional>
#include <string>
#include <vector>

#include "app/record/run_json.h"
#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::run {

/// A sentence for each way in which the steps so far may not be trusted: fixed ones are used as
/// they are, whatever they risk; adaptive ones stop the run instead. Snow at the limit of its
/// compaction has one, too.
std::vector<std::string> step_warnings(const scene::Scene& scene,
                                       const sim::Simulation& simulation);

/// Compares the slowest frame with the first that took steps: how many times as long it took, and
/// why. Nothing while both are alike, or all are short.
std::optional<std::string> slowdown_warning(const std::vector<record::FrameRecord>& frames);

}  // namespace neve::app::run
