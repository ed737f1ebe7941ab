#pragma once
/// Turbulence smaller than the cells of the air, as a sum of waves that turn and pass.
/// Source: Fung, Hunt, Malik, Perkins, Kinematic simulation of homogeneous turbulence (1992).

#include <array>

#include "sim/types/math.h"

namespace neve::sim::dust {

class Gusts {
 public:
  /// @param spacing  of the air's cells, m
  /// @param speed    at which waves pass, m/s
  Gusts(double spacing, double speed);

  /// Returns a velocity that is divergence-free, of mean square 1 (dimensionless).
  Vec3d at(const Vec3d& x, double time) const;

 private:
  static constexpr std::size_t count = 8;
  /// One number of each wave.
  using Each = std::array<double, count>;
  std::array<Each, 3> k_;      ///< in turns per m
  std::array<Each, 3> a_, b_;  ///< across k, of the cosine and of the sine
  Each rate_;                  ///< in turns per s
};

}  // namespace neve::sim::dust
