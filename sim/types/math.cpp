#include "sim/types/math.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace neve::sim {

Mat3d rotation_from_degrees(const Vec3d& degrees) {
  const Vec3d r = degrees * (std::numbers::pi / 180.0);
  using Turn = Eigen::AngleAxisd;
  return (Turn(r.z(), Vec3d::UnitZ()) * Turn(r.y(), Vec3d::UnitY()) * Turn(r.x(), Vec3d::UnitX()))
      .toRotationMatrix();
}

Vec3d degrees_from_rotation(const Mat3d& R) {
  const double level = std::hypot(R(0, 0), R(1, 0));
  const double y = std::atan2(-R(2, 0), level);
  // Looking straight up or down, x and z turn about one axis.
  constexpr double upright = 1e-8;
  const Vec3d angles = level < upright
                           ? Vec3d(0, y, std::atan2(-R(0, 1), R(1, 1)))
                           : Vec3d(std::atan2(R(2, 1), R(2, 2)), y, std::atan2(R(1, 0), R(0, 0)));
  return angles * (180.0 / std::numbers::pi);
}

Mat3d rotation_from_vector(const Vec3d& w) {
  const double angle = w.norm();
  if (angle == 0) return Mat3d::Identity();
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

}  // namespace neve::sim
