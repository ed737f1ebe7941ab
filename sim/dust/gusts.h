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

  /// Divergence-free, of mean square 1 (dimensionless).
  Vec3d at(const Vec3d& x, double time) const;

 private:
  struct Wave {
    Vec3d k;      ///< 1/m
    Vec3d a, b;   ///< across k
    double rate;  ///< 1/s
  };
  std::array<Wave, 8> waves_;
};

}  // namespace neve::sim::dust
