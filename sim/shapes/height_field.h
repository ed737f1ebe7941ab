#pragma once
/// The surface of a terrain: bilinear between its posts.
///
/// Bilinear rather than triangles: no diagonal is a choice that nobody made, the height along an
/// edge between two posts is the same from both sides, and in a cell the normal turns evenly
/// instead of jumping. The ground is below the surface, to any depth. Beyond the outermost posts it
/// continues level, each place as high as the nearest one of the border, so that snow that leaves
/// the map does not fall. The ground has a hole where one of the four posts around a place has no
/// data.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sim/files/height_reader.h"
#include "sim/shapes/height_samples.h"
#include "sim/shapes/solid.h"

namespace neve::sim::shapes {

/// A field of heights about the origin of its file, in metres: x east, y up, z south.
class HeightField {
 public:
  /// @param origin  east, north and up that count as its origin
  HeightField(std::shared_ptr<const files::HeightGrid> grid, const Vec3d& origin);

  /// The surface above or below a place.
  struct Place {
    double height;  ///< m, y
    Vec3d normal;   ///< outward unit vector of the bilinear surface, exact
  };
  /// Returns the surface above or below a place; nothing in a hole.
  std::optional<Place> at(double x, double z) const;
  /// Returns the distance across the tangent plane of the surface; < 0 below; no_ground in a hole.
  double distance(const Vec3d& y) const;

  const files::HeightGrid& grid() const { return *grid_; }
  /// Returns bounds of the posts and a spacing below: the ground is drawn and counted so deep.
  const Bounds& bounds() const { return bounds_; }
  /// See HeightSamples; of the whole ground without its holes.
  double flattest() const { return flattest_; }
  bool has_holes() const { return has_holes_; }
  HeightSamples samples() const;
  double x_of(std::size_t column) const {
    return first_[0] + grid_->spacing * static_cast<double>(column);
  }
  double z_of(std::size_t row) const {
    return first_[1] + grid_->spacing * static_cast<double>(row);
  }
  double height_of(std::size_t column, std::size_t row) const {
    return datum_ + static_cast<double>(grid_->at(column, row));
  }

  /// Lowest and highest place of the surface over a rectangle.
  struct Range {
    double low, high;
  };
  /// Returns the range over a rectangle; nothing over a hole or beyond the posts: `missing` gets
  /// such a place.
  std::optional<Range> range_over(const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                                  double radius, Eigen::Vector2d& missing) const;

 private:
  void measure();

  std::shared_ptr<const files::HeightGrid> grid_;
  double first_[2], datum_;
  Bounds bounds_;
  double flattest_ = 1;
  bool has_holes_ = false;
};

/// The surface as triangles: four for each cell between chosen columns and rows of posts, which
/// meet in its middle on the bilinear surface, with the normals of that surface in every corner;
/// and the sides and the bottom of the block below.
struct HeightTriangles {
  std::vector<Vec3d> position, normal;
  std::vector<std::uint32_t> index;
};
/// @param columns, rows  increasing, at least two each
HeightTriangles triangles_of(const HeightField& field, const std::vector<std::size_t>& columns,
                             const std::vector<std::size_t>& rows);

/// The posts along one side that are drawn: all up to `most`; of more, those around a stretch that
/// matters as densely as can be, and fewer and fewer away from it.
/// @param low, high  of the stretch, in posts
std::vector<std::size_t> drawn_posts(std::size_t count, double low, double high, std::size_t most);

/// The surface of a terrain. Read once: later calls return the same one while it is in use or was
/// used lately, unless the file was written since. Threads may call at the same time.
/// @throws ShapeError as read_heights
std::shared_ptr<const HeightField> height_field(const Terrain& terrain);

/// Bytes to ask for before a height field is read: from the beginning of its file. 0: nothing is
/// known.
double memory_to_read(const Terrain& terrain);

/// True if spacing, low and high are for the file of a terrain; a grid has its own.
bool takes_scale(const Terrain& terrain);

/// Returns east, north and up of the middle of a file, in whole metres. @throws ShapeError
Vec3d middle_of(const Terrain& terrain);

/// The block of ground, from the surface to a spacing below the lowest post.
std::unique_ptr<const Form> make_terrain_solid(const Terrain& terrain);

/// Snow on a terrain or a mesh. Its volume is exact: the area of the outline times the depth.
/// @param turned  degrees about y, of the cover
/// @throws ShapeError where it reaches over holes or beyond the ground
std::unique_ptr<const Form> make_cover_solid(const Cover& cover, double turned);

}  // namespace neve::sim::shapes
