#pragma once
/// The points of a body as it uses them: thinned, each with its volume.

#include <memory>

#include "sim/files/point_reader.h"
#include "sim/shapes/solid.h"

namespace neve::sim::shapes {

/// Volumes are those before deformation; where there are none, equal shares of the volume.
struct PlacedPoints : files::PointCloud {
  /// @throws ShapeError as read_points, and for a file that leaves volumes open
  explicit PlacedPoints(const Points& points);
  /// The same of a cloud that was read already. @param name of its file, in messages
  PlacedPoints(files::PointCloud cloud, const Points& points, const std::string& name);

  /// Returns bounds, tight but for half the edge of a cube that an average point fills.
  Bounds bounds_after(const Mat3d& rotation) const;

  double volume = 0;          ///< m3, of all
  double V0 = 0;              ///< m3, of all before deformation; 0: no column says it
  bool has_volumes = false;   ///< in its file; otherwise spacing gives them
  double expected_count = 0;  ///< points over thinning, which may be less than the one there is
};

/// Numbers, in the file, of the points that are left after thinning, in its order: as even in space
/// as the points are, in whatever order the file has them.
/// @param x  m, as the file has them
std::vector<std::size_t> kept_points(const std::vector<Vec3d>& x, double thinning);

/// Columns of a body's file that mean nothing to neve, of the points that are left.
/// @param names  those that the file does not have are left out
/// @throws ShapeError
std::vector<files::PointColumn> placed_columns(const Points& points,
                                               const std::vector<std::string>& names);
/// The names of all of them.
std::vector<std::string> column_names(const Points& points);

/// Summary of a body's points, without the points.
struct PointsSummary {
  std::size_t count = 0;
  double expected_count = 0;                    ///< see PlacedPoints
  double volume = 0;                            ///< m3, of all
  double V0 = 0;                                ///< see PlacedPoints
  bool has_volumes = false;                     ///< see PlacedPoints
  double mass = 0;                              ///< kg, of all; 0: the file has none
  double max_speed = 0;                         ///< m/s
  Vec3d first{0, 0, 0};                         ///< m, the first point, not turned
  Bounds bounds{Vec3d::Zero(), Vec3d::Zero()};  ///< m, turned about the file's origin
};

/// Cached until the file changes, because scenes ask often while parameters change. Any thread.
/// @throws ShapeError as PlacedPoints
PointsSummary summary_of(const Points& points, const Mat3d& rotation);

/// Makes the form of points, whose file is read when something is asked.
std::unique_ptr<const Form> make_points_solid(const Points& points);

}  // namespace neve::sim::shapes
