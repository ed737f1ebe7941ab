#include "sim/shapes/variation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/base/hash.h"

namespace neve::sim::shapes {

namespace {

/// Cut in standard deviations: beyond it, a single stiff particle could set every step.
constexpr double max_deviations = 3;

enum Quantity : std::uint64_t { of_density = 1, of_stiffness, of_threshold };

/// A standard normal number from a hash. Source: Box and Muller (1958).
double normal(std::uint64_t hash) {
  const double radius = std::sqrt(-2 * std::log(1 - unit_double(hash)));
  return radius * std::cos(2 * std::numbers::pi * unit_double(mix64(hash)));
}

/// Weight of the further of two neighbours, with two continuous derivatives. Source: Perlin,
/// Improving Noise (2002).
double fade(double t) {
  return t * t * t * (t * (6 * t - 15) + 10);
}

/// Normal numbers on a lattice of unit spacing, blended so that the variance is 1 everywhere.
double smooth_normal(std::uint64_t key, const Vec3d& place) {
  // A double beyond has no fraction, and a cell no number.
  constexpr double most = 0x1p52;
  const Vec3d at = place.cwiseMax(-most).cwiseMin(most);
  const Vec3d cell = at.array().floor();
  Vec3d near;
  for (int a = 0; a < 3; ++a) near[a] = fade(at[a] - cell[a]);
  double sum = 0, variance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    std::uint64_t hash = key;
    double weight = 1;
    for (int a = 0; a < 3; ++a) {
      const int up = corner >> a & 1;
      hash = mix64(hash, static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[a]) + up));
      weight *= up ? near[a] : 1 - near[a];
    }
    sum += weight * normal(hash);
    variance += weight * weight;
  }
  return sum / std::sqrt(variance);
}

/// Log-normal with mean 1 and the given standard deviation.
double factor(double deviation, double z) {
  const double sigma = std::sqrt(std::log1p(deviation * deviation));
  return std::exp(sigma * std::clamp(z, -max_deviations, max_deviations) - 0.5 * sigma * sigma);
}

}  // namespace

double max_factor(double deviation) {
  return factor(deviation, max_deviations);
}

double deviation_of(double largest) {
  // ln f = k sigma - sigma^2 / 2, the smaller root.
  constexpr double k = max_deviations, highest = 2;
  const double sigma = k - std::sqrt(std::max(0.0, k * k - 2 * std::log(largest)));
  return std::min(highest, std::sqrt(std::expm1(sigma * sigma)));
}

Factors vary(const Variation& variation, std::uint64_t key, std::uint64_t number, const Vec3d& y) {
  const auto one = [&](Quantity quantity, double deviation) {
    if (deviation == 0) return 1.0;
    const std::uint64_t own = mix64(key, quantity);
    return factor(deviation, variation.size > 0 ? smooth_normal(own, y / variation.size)
                                                : normal(mix64(own, number)));
  };
  return {one(of_density, variation.density), one(of_stiffness, variation.youngs_modulus),
          one(of_threshold, variation.thresholds)};
}

}  // namespace neve::sim::shapes
