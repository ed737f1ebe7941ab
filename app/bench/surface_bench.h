#pragma once
/// `neve bench surface`: how long the surface of snow takes.

#include <vector>

#include "app/bench/bench_options.h"
#include "app/bench/bench_report.h"
#include "app/support/progress.h"

namespace neve::app::bench {

/// Makes the mesh of a ball on a slab from 4000 to a million particles, and the attributes of its
/// vertices; also at one thread.
std::vector<BenchRow> bench_surface(const BenchOptions& options, Progress& progress);

}  // namespace neve::app::bench
