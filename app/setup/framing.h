#pragma once
/// Places of a camera from which points fill its picture.

#include <vector>

#include "sim/shapes/shape.h"

namespace neve::app::setup {

using Box = sim::shapes::Bounds;

Box box_of(const std::vector<sim::Vec3d>& points);

sim::Vec3d median(const std::vector<sim::Vec3d>& points);

/// The points without the share that is farthest from the median: splinters do not set the frame.
std::vector<sim::Vec3d> without_outliers(std::vector<sim::Vec3d> points, double share);

/// The points farther from their middle, sideways.
std::vector<sim::Vec3d> scattered(std::vector<sim::Vec3d> points, double factor);

double radians(double degrees);

struct Framing {
  sim::Vec3d target;
  double distance;
};

/// Projection of directions by the angle of view and the shape of the picture.
struct Lens {
  sim::Vec3d up;
  double slope;               ///< tan(fov / 2)
  double aspect;              ///< width / height
  double filled;              ///< share of the picture that the subject takes
  std::vector<double> turns;  ///< degrees about up that the camera passes; only 0 when it is still
  bool is_turning() const { return turns.size() > 1; }
};

/// A framing and the unit vector from its target to the eye.
struct Shot {
  Framing framing;
  sim::Vec3d towards_eye;
};

/// Returns points as the turning camera sees them: they turn backwards about a middle instead.
std::vector<sim::Vec3d> turned_backwards(const std::vector<sim::Vec3d>& points,
                                         const sim::Vec3d& middle, const Lens& lens);

/// Borders of points in the picture, 1 at its own.
struct Extent {
  double left = 1e300, right = -1e300, bottom = 1e300, top = -1e300;
};
Extent extent_of(const std::vector<sim::Vec3d>& points, const Shot& shot, const Lens& lens);

/// Moves the target to the middle of the visible subject and the eye back until it fits. While the
/// camera turns, the target stays above or below the middle of the points.
Framing fit(const std::vector<sim::Vec3d>& points, const sim::Vec3d& middle,
            const sim::Vec3d& towards_eye, const Lens& lens);

/// A share of the way from one framing to another.
Framing between(const Framing& from, const Framing& to, double part);

}  // namespace neve::app::setup
