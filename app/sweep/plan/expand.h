#pragma once
/// A sweep to the list of its runs.

#include <cstdint>
#include <vector>

#include "app/sweep/read/sweep.h"

namespace neve::app::sweep::plan {

/// Lists the runs in the order of the file; the last axis varies fastest, [[run]]s come last.
/// Random values depend on the sweep's seed, the axis and the sample alone, those of a Latin
/// hypercube on their number as well. Runs that do not meet sweep.where are omitted.
/// @throws LimitError when there are more than limits.runs; SceneError or UsageError when axes do
///         not fit together
std::vector<Run> expand(const read::Sweep& sweep);

/// Repeats each point for each seed, from the first one on; the runs of a point follow each other.
/// @param points  as expand() makes them @throws UsageError for seeds that no scene can have
std::vector<Run> with_seeds(const std::vector<Run>& points, std::uint64_t first, int seeds);

/// The shares of the range of an axis at which the levels of a screening lie: of its values, of
/// their logarithms where these are drawn, and of the places in a list, which are counted from the
/// smaller to the larger end of numbers. Levels are as even as that only for numbers that are not
/// rounded.
/// @return morris_levels shares from 0 to 1, in the order of the levels; zeros where the axis has
/// only one value
std::vector<double> level_shares(const read::Axis& axis);

/// The value below which a share p of a normal distribution lies, in standard deviations.
/// @param p 0 < p < 1
double normal_quantile(double p);

}  // namespace neve::app::sweep::plan
