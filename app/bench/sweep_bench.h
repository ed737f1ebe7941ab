#pragma once
/// `neve bench sweep`: how well a sweep keeps the cores busy, and what a run costs besides its
/// work.

#include <vector>

#include "app/bench/bench_options.h"
#include "app/bench/bench_report.h"
#include "app/support/progress.h"

namespace neve::app::bench {

/// @throws IoError, render::ContextError, Error when a run fails
std::vector<BenchRow> bench_sweep(const BenchOptions& options, Progress& progress);

}  // namespace neve::app::bench
