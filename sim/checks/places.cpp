#include "sim/checks/places.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "sim/laws/law.h"

namespace neve::sim::checks {

namespace {

/// Length of the kernel, in spacings of particles at rest. Its radius is twice that, and holds a
/// hundred neighbours: few enough for coarse bodies to have an inside, and enough that a particle's
/// own weight adds 3 % in jittered snow and 9 % in snow that lies as chance has it.
constexpr double smoothing = 1.5;
/// Looser snow is pieces, and most of its volume is air.
constexpr double loosest = 1.5;
/// Neighbours around a particle have their centre near it: within this share of the smoothing.
constexpr double off_centre = 0.1;
constexpr std::size_t max_looks = 4096, fewest = 48;

/// The cubic spline of smoothed particles times its length cubed, of distances in its lengths.
double weight(double q) {
  if (q >= 2) return 0;
  const double far = 2 - q;
  const double w = q < 1 ? 1 - 1.5 * q * q + 0.75 * q * q * q : 0.25 * far * far * far;
  return w / std::numbers::pi;
}

/// Particles by cells as wide as the widest kernel.
class Neighbours {
 public:
  Neighbours(const std::vector<Vec3d>& x, double width) : width_(width) {
    for (std::size_t q = 0; q < x.size(); ++q) sorted_.emplace_back(key(cell(x[q])), q);
    std::sort(sorted_.begin(), sorted_.end());
  }

  /// Visits all particles within the width of a cell, and some that are further away.
  template <class Visit>
  void each_near(const Vec3d& place, const Visit& visit) const {
    const Vec3i middle = cell(place);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const std::uint64_t wanted = key(middle + Vec3i(dx, dy, dz));
          auto at =
              std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(wanted, std::size_t{0}));
          for (; at != sorted_.end() && at->first == wanted; ++at) visit(at->second);
        }
  }

 private:
  Vec3i cell(const Vec3d& place) const {
    return (place / width_).array().floor().matrix().cast<int>();
  }
  /// Cells that are 2^21 apart share one.
  static std::uint64_t key(const Vec3i& cell) {
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k)
      key = key << 21 | (static_cast<std::uint64_t>(cell[k]) & ((1u << 21) - 1));
    return key;
  }

  double width_;
  std::vector<std::pair<std::uint64_t, std::size_t>> sorted_;
};

}  // namespace

double believed_volume(const ParticleArrays& p, const std::vector<Material>& materials,
                       std::uint64_t first_born) {
  std::vector<double> V(p.x.size());  // at rest
  double widest = 0;
  for (std::size_t q = 0; q < V.size(); ++q) {
    V[q] = p.m[q] / p.material_of(q, materials).density;
    widest = std::max(widest, smoothing * std::cbrt(V[q]));
  }
  if (!(widest > 0)) return 1;
  const Neighbours neighbours(p.x, 2 * widest);
  std::vector<double> found;
  const std::size_t stride = 1 + V.size() / max_looks;
  for (std::size_t q = 0; q < V.size(); q += stride) {
    if (p.id_of(q) >= first_born) break;
    if (!laws::counts_volume(p.material_of(q, materials))) continue;
    const double length = smoothing * std::cbrt(V[q]);
    double packing = 0;
    Vec3d centre = Vec3d::Zero();
    neighbours.each_near(p.x[q], [&](std::size_t other) {
      const Vec3d away = p.x[other] - p.x[q];
      const double share = V[other] * weight(away.norm() / length);
      packing += share;
      centre += share * away;
    });
    if (centre.norm() > off_centre * length * packing) continue;
    packing /= length * length * length;
    if (packing * loosest < 1) continue;
    found.push_back(p.F_E[q].determinant() * p.J_P[q] * packing);
  }
  if (found.size() < fewest) return 1;
  const auto median = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
  std::nth_element(found.begin(), median, found.end());
  return *median;
}

}  // namespace neve::sim::checks
