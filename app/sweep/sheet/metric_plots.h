#pragma once
/// Every metric against every parameter, as one SVG.

#include <string>
#include <vector>

#include "app/sweep/store/results.h"

namespace neve::app::sweep::sheet {

/// A file of its own: a row per metric, a column per parameter that differs; without parameters
/// that are numbers or choices, against the runs. Runs that did not get to their end are rings,
/// held at the edges of the range of the others. With seeds each point is a whisker with its mean,
/// grey where the metric is noise. Empty where no run has a metric.
std::string metric_plots_svg(const store::Manifest& manifest,
                             const std::vector<store::RunResult>& results);

}  // namespace neve::app::sweep::sheet
