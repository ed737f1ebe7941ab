#pragma once
/// Solids that air and dust stay out of, at one time.

#include <cstdint>

#include "sim/types/math.h"

namespace neve::sim::dust {

/// The nearest solid as seen from a place.
struct Surface {
  double distance = 1e30;   ///< m; < 0 inside; outside a bound from below
  Vec3d normal{0, 1, 0};    ///< outward, of unit length
  Vec3d velocity{0, 0, 0};  ///< m/s, of the solid there
};

class Solids {
 public:
  virtual ~Solids() = default;
  /// Returns the surface nearest to a place. All threads call it.
  virtual Surface at(const Vec3d& x) const = 0;
  virtual bool are_none() const = 0;
  /// Returns another number where solids are or move otherwise; 0: they deform, ask again.
  virtual std::uint64_t pose_key() const = 0;
};

/// Open air.
class NoSolids final : public Solids {
 public:
  Surface at(const Vec3d&) const override { return {}; }
  bool are_none() const override { return true; }
  std::uint64_t pose_key() const override { return 1; }
};

}  // namespace neve::sim::dust
