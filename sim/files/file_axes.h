#pragma once
/// Axes and units of a file that neve wrote with --up or --scale.

#include "sim/types/math.h"

namespace neve::sim::files {

/// Back to metres, y up: the inverse of what an export does. Masses and volumes are SI in any file.
struct FileAxes {
  bool is_z_up = false;
  double scale = 1;  ///< units per metre

  bool are_ours() const { return !is_z_up && scale == 1; }
  Vec3d direction(const Vec3d& v) const { return is_z_up ? Vec3d(v.x(), v.z(), -v.y()) : v; }
  /// Of places and velocities.
  Vec3d metres(const Vec3d& v) const { return direction(v) / scale; }
  /// Turns both sides of a tensor.
  Mat3d tensor(const Mat3d& a) const {
    Mat3d rows, both;
    for (int c = 0; c < 3; ++c) rows.col(c) = direction(a.col(c));
    for (int r = 0; r < 3; ++r) both.row(r) = direction(rows.row(r).transpose()).transpose();
    return both;
  }
};

}  // namespace neve::sim::files
