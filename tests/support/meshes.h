#pragma once
/// OBJ texts of closed meshes.

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "sim/types/math.h"

namespace neve::test {

/// A box of quads about the origin.
inline std::string box_obj(const sim::Vec3d& size) {
  std::ostringstream text;
  text.precision(17);
  for (int k = 0; k < 8; ++k)
    text << "v " << (k & 1 ? 0.5 : -0.5) * size[0] << ' ' << (k & 2 ? 0.5 : -0.5) * size[1] << ' '
         << (k & 4 ? 0.5 : -0.5) * size[2] << '\n';
  text << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  return text.str();
}

/// A ball about the origin; its faces are inside of the sphere by at most radius (pi / rings)^2 / 2
/// or so.
inline std::string ball_obj(double radius, int rings) {
  const int around = 2 * rings;
  std::ostringstream text;
  text.precision(17);
  text << "v 0 " << radius << " 0\n";
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double polar = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * j / around;
      text << "v " << radius * std::sin(polar) * std::cos(turn) << ' ' << radius * std::cos(polar)
           << ' ' << radius * std::sin(polar) * std::sin(turn) << '\n';
    }
  text << "v 0 " << -radius << " 0\n";
  const auto at = [&](int i, int j) { return 2 + (i - 1) * around + j % around; };
  const int last = 2 + (rings - 1) * around;
  for (int j = 0; j < around; ++j) {
    text << "f 1 " << at(1, j + 1) << ' ' << at(1, j) << '\n';
    for (int i = 1; i + 1 < rings; ++i)
      text << "f " << at(i, j) << ' ' << at(i, j + 1) << ' ' << at(i + 1, j + 1) << ' '
           << at(i + 1, j) << '\n';
    text << "f " << last << ' ' << at(rings - 1, j) << ' ' << at(rings - 1, j + 1) << '\n';
  }
  return text.str();
}

}  // namespace neve::test
