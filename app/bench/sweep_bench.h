#pragma once
/// `neve bench sweep`: the share of the cores that a sweep uses, and the overhead of a run.

#include <vector>

#include "app/bench/bench_options.h"
#include "app/bench/bench_report.h"
#include "app/support/progress.h"

namespace neve::app::bench {

/// @throws IoError, render::ContextError, Error when a run fails
std::vector<BenchRow> bench_sweep(const BenchOptions& options, Progress& progress);

}  // namespace neve::app::bench
