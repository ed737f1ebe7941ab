#include "sim/dust/air_box.h"

#include <cmath>

namespace neve::sim::dust {

namespace {

/// Cells of air beyond the outermost places, and the steps in which a box grows.
constexpr int margin = 4, stride = 4;

int floor_to(double cells, int step) {
  return step * static_cast<int>(std::floor(cells / step));
}
int ceil_to(double cells, int step) {
  return step * static_cast<int>(std::ceil(cells / step));
}

double cells(const Vec3i& size) {
  return size.cast<double>().prod();
}

}  // namespace

AirBox air_box_around(const Vec3d& low, const Vec3d& high, double spacing, const AirBox& before) {
  constexpr double farthest = 1e8;  // cells; beyond it counts overflow
  const Vec3d first = (low / spacing).cwiseMax(-farthest).cwiseMin(farthest),
              last = (high / spacing).cwiseMax(-farthest).cwiseMin(farthest);
  AirBox box{spacing, {0, 0, 0}, {0, 0, 0}};
  for (int a = 0; a < 3; ++a) {
    box.low[a] = floor_to(first[a] - margin, stride);
    box.size[a] = ceil_to(last[a] + margin, stride) - box.low[a];
  }
  // Stray places are left outside: the longest side gives way, around its middle.
  while (cells(box.size) > max_air_cells) {
    int longest = 0;
    box.size.maxCoeff(&longest);
    const int cut = floor_to(box.size[longest] / 8.0, stride) + stride;
    box.low[longest] += floor_to(cut / 2.0, stride);
    box.size[longest] -= cut;
  }
  const bool fits = before.spacing == spacing && !before.is_empty() && before.contains(box);
  return fits && cells(before.size) < 3 * cells(box.size) ? before : box;
}

}  // namespace neve::sim::dust
