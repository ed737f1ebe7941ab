#pragma once
/// The change of the snow by one stage of a step: a number or a vector per particle.

#include <string>
#include <vector>

#include "sim/types/math.h"

namespace neve::app::picture {

/// Values in id order.
struct StageChange {
  std::string title, unit;  ///< "change of velocity", "m/s"
  std::vector<double> magnitude;
  std::vector<sim::Vec3d> vector;  ///< the same with direction; empty where it has none
  bool is_of_nodes = false;        ///< the stage works on the grid, which slices show

  /// The end of the scale: 0 where nothing changed.
  double largest() const;
};

}  // namespace neve::app::picture
