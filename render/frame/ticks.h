#pragma once
/// Round numbers along an axis or a colour bar.

#include <string>
#include <vector>

namespace neve::render {

struct Tick {
  double value = 0;
  std::string label;  ///< short, and different from its neighbours
};

/// Returns about `count` multiples of 1, 2, 2.5 or 5 times a power of ten within [min, max]. One
/// tick where the range has no width, none if it is not finite.
std::vector<Tick> nice_ticks(double min, double max, int count);

}  // namespace neve::render
