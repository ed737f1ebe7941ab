#pragma once
/// `neve bench frame`: how long users wait, for frames, the first picture and coarsened scenes.

#include <vector>

#include "app/bench/bench_options.h"
#include "app/bench/bench_report.h"
#include "app/support/progress.h"

namespace neve::app::bench {

/// @throws render::ContextError where nothing can be drawn, Error when a scene diverges
std::vector<BenchRow> bench_frame(const BenchOptions& options, Progress& progress);

}  // namespace neve::app::bench
