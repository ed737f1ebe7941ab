#include "sim/dust/gusts.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "sim/base/hash.h"

namespace neve::sim::dust {

namespace {

/// Wave lengths in cells of the air: what the grid carries badly or not at all.
constexpr double longest = 8, shortest = 0.8;

/// Returns a random direction, even over the sphere.
Vec3d direction(std::uint64_t key) {
  const double z = 2 * unit_double(mix64(key, 1)) - 1,
               angle = 2 * std::numbers::pi * unit_double(mix64(key, 2));
  const double around = std::sqrt(1 - z * z);
  return {around * std::cos(angle), around * std::sin(angle), z};
}

/// sin(2 pi turns), to 4e-6: compilers make lanes of it, where the library's sine is a call for
/// each.
double sine_of(double turns) {
  constexpr double to_whole = 0x1.8p52;  // rounds what is added to it
  const double x = turns - ((turns + to_whole) - to_whole);
  // A turn folds from a half to a quarter: the sine is the same on both sides of it.
  const double half = std::copysign(0.5, x);
  const double folded = std::abs(x) > 0.25 ? half - x : x;
  const double z = 2 * std::numbers::pi * folded, q = z * z;
  // Its Taylor series.
  constexpr double c3 = 1.0 / 6, c5 = 1.0 / 120, c7 = 1.0 / 5040, c9 = 1.0 / 362880;
  return z * (1 - q * (c3 - q * (c5 - q * (c7 - q * c9))));
}

}  // namespace

Gusts::Gusts(double spacing, double speed) {
  double power = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double part = static_cast<double>(n) / static_cast<double>(count - 1);
    const double length = spacing * longest * std::pow(shortest / longest, part);
    // Energy falls as k^(-5/3): of bands that are as wide as k, speeds as k^(-1/3).
    const double strength = std::cbrt(length / spacing);
    const Vec3d ahead = direction(3 * n + 1);
    const Vec3d a = strength * ahead.cross(direction(3 * n + 2)),
                b = strength * ahead.cross(direction(3 * n + 3));
    for (std::size_t x = 0; x < 3; ++x) {
      const auto axis = static_cast<int>(x);
      k_[x][n] = ahead[axis] / length;
      a_[x][n] = a[axis];
      b_[x][n] = b[axis];
    }
    rate_[n] = 0.5 * speed / length;
    power += 0.5 * (a.squaredNorm() + b.squaredNorm());
  }
  const double scale = 1 / std::sqrt(power);
  for (std::size_t x = 0; x < 3; ++x)
    for (std::size_t n = 0; n < count; ++n) {
      a_[x][n] *= scale;
      b_[x][n] *= scale;
    }
}

Vec3d Gusts::at(const Vec3d& x, double time) const {
  Each sine, cosine;
  for (std::size_t n = 0; n < count; ++n) {
    const double turns = k_[0][n] * x.x() + k_[1][n] * x.y() + k_[2][n] * x.z() + rate_[n] * time;
    sine[n] = sine_of(turns);
    cosine[n] = sine_of(turns + 0.25);
  }
  Vec3d sum = Vec3d::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t n = 0; n < count; ++n)
      sum[static_cast<int>(axis)] += cosine[n] * a_[axis][n] + sine[n] * b_[axis][n];
  return sum;
}

}  // namespace neve::sim::dust
