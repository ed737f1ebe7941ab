#pragma once
/// How far apart the values of two runs are.

#include <cstddef>
#include <vector>

#include "app/sweep/plan/sweep_plan.h"

namespace neve::app::sweep::plan {

/// Places of the runs of a sweep along each of its parameters, from 0 to 1 by the rank of the value
/// among the values of the sweep. Runs that differ in their seed alone are
/// in one place.
class RunPlaces {
 public:
  explicit RunPlaces(const std::vector<PlannedRun>& runs);

  /// The one of `others`, which are not empty, with the least squared distance; of equal ones the
  /// first.
  std::size_t nearest(std::size_t run, const std::vector<std::size_t>& others) const;

 private:
  double distance(std::size_t a, std::size_t b) const;

  std::vector<std::vector<double>> places_;  ///< by run, then by parameter
};

}  // namespace neve::app::sweep::plan
