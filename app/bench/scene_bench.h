#pragma once
/// `neve bench scenes`: how long users wait for the films of the shipped scenes.

#include <vector>

#include "app/bench/bench_options.h"
#include "app/bench/bench_report.h"
#include "app/support/progress.h"

namespace neve::app::bench {

/// Renders each scene by the program itself: at its own resolution, with --coarsen 2, with --fast,
/// and with both, in turns.
/// @throws UsageError for a scene that does not exist, Error when one fails
std::vector<BenchRow> bench_scenes(const BenchOptions& options, Progress& progress);

}  // namespace neve::app::bench
