#include "sim/types/math.h"

#include <Eigen/Geometry>
#include <numbers>

namespace neve::sim {

Mat3d rotation_from_degrees(const Vec3d& degrees) {
  const Vec3d r = degrees * (std::numbers::pi / 180.0);
  using Turn = Eigen::AngleAxisd;
  return (Turn(r.z(), Vec3d::UnitZ()) * Turn(r.y(), Vec3d::UnitY()) * Turn(r.x(), Vec3d::UnitX()))
      .toRotationMatrix();
}

Mat3d rotation_from_vector(const Vec3d& w) {
  const double angle = w.norm();
  if (angle == 0) return Mat3d::Identity();
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

}  // namespace neve::sim
