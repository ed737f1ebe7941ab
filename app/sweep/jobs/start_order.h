#pragma once
/// The runs of a sweep in the order in which they start.

#include <vector>

#include "app/sweep/store/manifest.h"

namespace neve::app::sweep::jobs {

/// Ends of axes before middles, then variants; of equal runs, which share a folder, the first.
/// @param indices  of the runs that are wanted
/// @param is_side_by_side  long runs start first, by the forecast, so that no core waits for the
///        last one
std::vector<const Run*> start_order(const store::Manifest& manifest,
                                    const std::vector<int>& indices, bool is_side_by_side);

}  // namespace neve::app::sweep::jobs
