#pragma once
/// The order in which runs start.

#include <cstddef>
#include <vector>

namespace neve::app::sweep::plan {

/// Ends of all axes first, then middles, then middles of what is left: a sheet tells something
/// when a tenth of the runs is done. Runs on no axis count as one row.
/// @param coordinates of each run on the axes; empty where it is on none
/// @param sizes of the axes
/// @param draws the place of each run among the seeds of its point: all first ones come before all
///              second ones, so that a whole sheet shows early; empty: there is one seed
std::vector<std::size_t> coarse_first(const std::vector<std::vector<int>>& coordinates,
                                      const std::vector<int>& sizes,
                                      const std::vector<int>& draws = {});

/// Puts long runs first, so that the last ones are short and no core waits for one: runs that take
/// about as long as the longest of those that are left, within a quarter, keep their order.
/// @param order  runs, by their places in `work`
std::vector<std::size_t> longest_first(std::vector<std::size_t> order,
                                       const std::vector<double>& work);

}  // namespace neve::app::sweep::plan
