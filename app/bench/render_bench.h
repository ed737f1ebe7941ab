#pragma once
/// `neve bench render`: milliseconds per picture, those of its phases, and OpenGL's spheres
/// against those of the CPU.

#include <vector>

#include "app/bench/bench_options.h"
#include "app/bench/bench_report.h"
#include "app/support/progress.h"

namespace neve::app::bench {

/// @throws render::ContextError where nothing can be drawn
std::vector<BenchRow> bench_render(const BenchOptions& options, Progress& progress);

}  // namespace neve::app::bench
