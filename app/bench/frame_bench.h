#pragma once
/// `neve bench frame`: how long users wait, for frames, the first picture and coarsened scenes.

#include <vector>

#include "app/bench/bench_report.h"
#include "app/commands.h"
#include "app/progress.h"

namespace neve::app {

/// @throws render::ContextError where nothing can be drawn, Error when a scene diverges
std::vector<BenchRow> bench_frame(const BenchOptions& options, Progress& progress);

}  // namespace neve::app
