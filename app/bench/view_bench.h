#pragma once
/// `neve bench view`: how quickly the interactive view answers, pictures compressed as the web page
/// gets them; without a network.

#include <vector>

#include "app/bench/bench_options.h"
#include "app/bench/bench_report.h"
#include "app/support/progress.h"

namespace neve::app::bench {

/// @throws render::ContextError, Error
std::vector<BenchRow> bench_view(const BenchOptions& options, Progress& progress);

}  // namespace neve::app::bench
