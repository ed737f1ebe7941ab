#pragma once
/// The clip plane of a view, and the particles that it cuts away.

#include <optional>
#include <vector>

#include "app/scene/scene.h"

namespace neve::app::picture {

/// The mean of all positions that are numbers.
sim::Vec3d middle_of(const std::vector<sim::Vec3d>& positions);

class Cut {
 public:
  /// @param positions of all particles, for a plane without a point of its own
  Cut(const std::optional<scene::ClipPlane>& clip, const std::vector<sim::Vec3d>& positions);
  bool removes(const sim::Vec3d& x) const { return normal_.dot(x - point_) > 0; }
  /// Returns m beyond the plane; below 0 before it, and 0 where nothing is cut.
  double distance(const sim::Vec3d& x) const { return normal_.normalized().dot(x - point_); }
  const sim::Vec3d& point() const { return point_; }
  /// The normal is not of length 1; it is 0 where nothing is cut.
  const sim::Vec3d& normal() const { return normal_; }

 private:
  sim::Vec3d normal_{0, 0, 0}, point_{0, 0, 0};
};

}  // namespace neve::app::picture
