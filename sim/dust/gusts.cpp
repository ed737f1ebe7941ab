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

/// Even over the sphere.
Vec3d direction(std::uint64_t key) {
  const double z = 2 * unit_double(mix64(key, 1)) - 1,
               angle = 2 * std::numbers::pi * unit_double(mix64(key, 2));
  const double around = std::sqrt(1 - z * z);
  return {around * std::cos(angle), around * std::sin(angle), z};
}

}  // namespace

Gusts::Gusts(double spacing, double speed) {
  double power = 0;
  for (std::size_t n = 0; n < waves_.size(); ++n) {
    const double part = static_cast<double>(n) / static_cast<double>(waves_.size() - 1);
    const double length = spacing * longest * std::pow(shortest / longest, part);
    // Energy falls as k^(-5/3): of bands that are as wide as k, speeds as k^(-1/3).
    const double strength = std::cbrt(length / spacing);
    Wave& wave = waves_[n];
    const Vec3d ahead = direction(3 * n + 1);
    wave.k = 2 * std::numbers::pi / length * ahead;
    wave.a = strength * ahead.cross(direction(3 * n + 2));
    wave.b = strength * ahead.cross(direction(3 * n + 3));
    wave.rate = 0.5 * speed * 2 * std::numbers::pi / length;
    power += 0.5 * (wave.a.squaredNorm() + wave.b.squaredNorm());
  }
  const double scale = 1 / std::sqrt(power);
  for (Wave& wave : waves_) {
    wave.a *= scale;
    wave.b *= scale;
  }
}

Vec3d Gusts::at(const Vec3d& x, double time) const {
  Vec3d sum = Vec3d::Zero();
  for (const Wave& wave : waves_) {
    const double phase = wave.k.dot(x) + wave.rate * time;
    sum += std::cos(phase) * wave.a + std::sin(phase) * wave.b;
  }
  return sum;
}

}  // namespace neve::sim::dust
