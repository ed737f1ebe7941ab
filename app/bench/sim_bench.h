#pragma once
/// `neve bench sim`: speed of the simulation, and comparison with naive code.

#include <vector>

#include "app/bench/bench_options.h"
#include "app/bench/bench_report.h"
#include "app/support/progress.h"

namespace neve::app::bench {

/// The common case in all variants against the naive code, spray, scaling.
/// @throws Error when the case diverges, the codes disagree or memory does not suffice
std::vector<BenchRow> bench_sim(const BenchOptions& options, Progress& progress);

/// Throughput from a thousand particles to the most that fit.
std::vector<BenchRow> bench_curve(const BenchOptions& options, Progress& progress);

}  // namespace neve::app::bench
