#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sim/shapes/height_field.h"
#include "sim/shapes/mesh.h"
#include "sim/shapes/mesh_columns.h"
#include "sim/shapes/mesh_surface.h"
#include "sim/types/number_text.h"

namespace neve::sim::shapes {
namespace {

Bounds turned_bounds(const Bounds& box, const Mat3d& rotation) {
  const Vec3d middle = rotation * (0.5 * (box.min + box.max));
  const Vec3d half = rotation.cwiseAbs() * (0.5 * (box.max - box.min));
  return {middle - half, middle + half};
}

class TerrainForm final : public Form {
 public:
  explicit TerrainForm(const Terrain& terrain) : field_(height_field(terrain)) {
    const files::HeightGrid& grid = field_->grid();
    const double floor = field_->bounds().min.y(), cell = grid.spacing * grid.spacing;
    // The mean of a bilinear cell is that of its corners.
    for (std::size_t r = 0; r + 1 < grid.rows; ++r)
      for (std::size_t c = 0; c + 1 < grid.columns; ++c) {
        const double mean = 0.25 * (field_->height_of(c, r) + field_->height_of(c + 1, r) +
                                    field_->height_of(c, r + 1) + field_->height_of(c + 1, r + 1));
        if (!std::isnan(mean)) volume_ += cell * (mean - floor);
      }
    if (!(volume_ > 0))
      throw ShapeError(terrain.file + ": no cell of the height field has data in its four posts");
  }

  double volume() const override { return volume_; }
  Bounds bounds_after(const Mat3d& rotation) const override {
    return turned_bounds(field_->bounds(), rotation);
  }
  bool contains(const Vec3d& y) const override {
    const Bounds& box = field_->bounds();
    return (y.array() >= box.min.array()).all() && (y.array() <= box.max.array()).all() &&
           field_->distance(y) <= 0;
  }
  double clearance(const Vec3d&) const override { return 0; }
  /// Returns a place half a spacing below the surface of the first cell with data.
  Vec3d inner_point() const override {
    const files::HeightGrid& grid = field_->grid();
    for (std::size_t r = 0; r + 1 < grid.rows; ++r)
      for (std::size_t c = 0; c + 1 < grid.columns; ++c) {
        const double x = field_->x_of(c) + 0.5 * grid.spacing,
                     z = field_->z_of(r) + 0.5 * grid.spacing;
        if (const auto place = field_->at(x, z)) return {x, place->height - 0.5 * grid.spacing, z};
      }
    return field_->bounds().min;
  }

 private:
  std::shared_ptr<const HeightField> field_;
  double volume_ = 0;
};

/// Outline of a cover, in the axes of its ground.
struct Outline {
  Vec3d middle{0, 0, 0};
  Mat3d axes = Mat3d::Identity();  ///< about y
  Eigen::Vector2d half{0, 0};      ///< m, along its axes
  double radius = 0;               ///< m; 0: a rectangle

  /// Returns the distance from the border, m: > 0 beside the outline, negative within it.
  double beside(const Vec3d& local) const {
    return radius > 0 ? std::hypot(local.x(), local.z()) - radius
                      : std::max(std::abs(local.x()) - half.x(), std::abs(local.z()) - half.y());
  }
};

/// Ground that a cover lies on, in axes without tilt of its own.
class Ground {
 public:
  virtual ~Ground() = default;
  /// Returns y of the surface, m; nothing where there is none.
  virtual std::optional<double> height(double x, double z) const = 0;
  /// Lowest and highest place over an outline; nothing where it reaches over places without a
  /// surface, and `missing` gets one.
  virtual std::optional<HeightField::Range> range_over(const Outline& outline,
                                                       Vec3d& missing) const = 0;
  /// A place at a height above or below the surface is at least that times this away from it.
  virtual double flattest() const = 0;
  virtual Vec3d to_world(const Vec3d& x) const = 0;
  virtual Vec3d from_world(const Vec3d& x) const = 0;
  virtual double turned() const = 0;  ///< degrees about y
  /// "alp.asc has no ground; its posts are at x = 0 to 10 and z = 0 to 10"
  virtual std::string extent() const = 0;
};

std::string metres(double x) {
  return number_text(x, 6);
}

class TerrainGround final : public Ground {
 public:
  TerrainGround(const Terrain& terrain, double turned)
      : terrain_(terrain), field_(height_field(terrain)), turned_(turned) {}

  std::optional<double> height(double x, double z) const override {
    const auto place = field_->at(x, z);
    return place ? std::optional(place->height) : std::nullopt;
  }
  std::optional<HeightField::Range> range_over(const Outline& outline,
                                               Vec3d& missing) const override {
    const Vec3d reach =
        outline.radius > 0
            ? Vec3d(outline.radius, 0, outline.radius)
            : Vec3d(outline.axes.cwiseAbs() * Vec3d(outline.half.x(), 0, outline.half.y()));
    const Vec3d low = outline.middle - reach, high = outline.middle + reach;
    Eigen::Vector2d hole;
    const auto range =
        field_->range_over({low.x(), low.z()}, {high.x(), high.z()}, outline.radius, hole);
    if (!range) missing = Vec3d(hole.x(), 0, hole.y());
    return range;
  }
  double flattest() const override { return field_->flattest(); }
  Vec3d to_world(const Vec3d& x) const override {
    return rotation_from_degrees({0, turned_, 0}) * x + terrain_.center;
  }
  Vec3d from_world(const Vec3d& x) const override {
    return rotation_from_degrees({0, turned_, 0}).transpose() * (x - terrain_.center);
  }
  double turned() const override { return turned_; }
  std::string extent() const override {
    const Bounds& box = field_->bounds();
    const Vec3d& c = terrain_.center;
    return terrain_.file + " has no ground; its posts are at x = " + metres(c.x() + box.min.x()) +
           " to " + metres(c.x() + box.max.x()) + " and z = " + metres(c.z() + box.min.z()) +
           " to " + metres(c.z() + box.max.z()) +
           (field_->has_holes() ? ", and some have no data" : "");
  }

 private:
  Terrain terrain_;
  std::shared_ptr<const HeightField> field_;
  double turned_;
};

/// The highest place of a mesh above each place. A line upwards is one along x, as mesh_columns.h
/// has them, after x and y have changed places. Axes and origin are the world's.
class MeshGround final : public Ground {
 public:
  MeshGround(const Mesh& mesh, const Vec3d& turned) : file_(mesh.file) {
    const std::shared_ptr<const SolidMesh> solid = read_solid_mesh(mesh);
    const Mat3d rotation = rotation_from_degrees(turned);
    triangles_ = solid->triangles;
    for (const Vec3d& local : solid->vertices) {
      const Vec3d x = rotation * local + mesh.center;
      corners_.emplace_back(x.y(), x.x(), x.z());
      bounds_.add(corners_.back());
    }
    columns_.emplace(corners_, triangles_, bounds_);
  }

  std::optional<double> height(double x, double z) const override {
    const Vec3d p(0, x, z);
    if (x < bounds_.min.y() || x > bounds_.max.y() || z < bounds_.min.z() || z > bounds_.max.z())
      return {};
    std::optional<double> highest;
    const auto [begin, end] = columns_->at(p);
    for (const std::uint32_t* t = begin; t != end; ++t) {
      const auto& [i, j, k] = triangles_[*t];
      if (winding(corners_[i], corners_[j], corners_[k], p) == 0) continue;
      const double y = meeting_x(corners_[i], corners_[j], corners_[k], p);
      if (!highest || y > *highest) highest = y;
    }
    return highest;
  }
  /// Looked for at places close to each other: a hole between them is not noticed, and left empty.
  std::optional<HeightField::Range> range_over(const Outline& outline,
                                               Vec3d& missing) const override {
    constexpr int places = 128;
    // Some seconds; the particles of a cover then ask as often again, or more.
    constexpr std::ptrdiff_t max_looked = 200'000'000;
    std::ptrdiff_t looked = 0;
    std::optional<HeightField::Range> range;
    for (int i = -places; i <= places; ++i)
      for (int k = -places; k <= places; ++k) {
        // The border itself may lie on the last edge of the mesh.
        constexpr double share = (1 - 1e-9) / places;
        const Vec3d local(share * i * outline.half.x(), 0, share * k * outline.half.y());
        if (outline.beside(local) > 0) continue;
        missing = outline.middle + outline.axes * local;
        const std::optional<double> y = height(missing.x(), missing.z());
        if (!y) return {};
        const auto [begin, end] = columns_->at(Vec3d(0, missing.x(), missing.z()));
        if ((looked += end - begin) > max_looked)
          throw ShapeError(file_ +
                           ": thousands of faces of the mesh are above each place: it takes "
                           "too long to say which is the highest. Lay the snow on a mesh of "
                           "fewer faces");
        if (!range) range = {*y, *y};
        range = {std::min(range->low, *y), std::max(range->high, *y)};
      }
    // A ridge between two places is higher than both, but no higher than its ends.
    range->high = std::max(range->high, highest_corner(outline));
    return range;
  }
  double flattest() const override { return 0; }  // it may have walls
  Vec3d to_world(const Vec3d& x) const override { return x; }
  Vec3d from_world(const Vec3d& x) const override { return x; }
  double turned() const override { return 0; }
  std::string extent() const override {
    return file_ + " is not below it; it reaches from x = " + metres(bounds_.min.y()) + " to " +
           metres(bounds_.max.y()) + " and from z = " + metres(bounds_.min.z()) + " to " +
           metres(bounds_.max.z());
  }

 private:
  double highest_corner(const Outline& outline) const {
    double highest = bounds_.min.x();
    for (const Vec3d& corner : corners_) {
      const Vec3d x(corner.y(), 0, corner.z());
      const Vec3d middle(outline.middle.x(), 0, outline.middle.z());
      if (outline.beside(outline.axes.transpose() * (x - middle)) <= 0)
        highest = std::max(highest, corner.x());
    }
    return highest;
  }

  std::string file_;
  std::vector<Vec3d> corners_;  ///< y, x, z
  std::vector<Triangle> triangles_;
  Bounds bounds_{Vec3d::Constant(HUGE_VAL), Vec3d::Constant(-HUGE_VAL)};
  std::optional<Columns> columns_;
};

/// A mesh is put in order once: a scene asks for its covers many times.
std::shared_ptr<const Ground> ground_of(const Cover& cover) {
  const auto* mesh = std::get_if<Mesh>(&cover.ground);
  if (!mesh)
    return std::make_shared<TerrainGround>(std::get<Terrain>(cover.ground), cover.turned.y());
  static Recent<Ground> recent;
  std::string key = reading_key(*mesh);
  for (const Vec3d& place : {mesh->center, cover.turned})
    for (const double x : place) key += "|" + number_text(x, 17);
  return recent.get(key, [&] { return std::make_shared<const MeshGround>(*mesh, cover.turned); });
}

/// A cover about the middle of its outline, at the height that the cover gives.
class CoverForm final : public Form {
 public:
  CoverForm(const Cover& cover, double turned)
      : ground_(ground_of(cover)), lift_(ground_->to_world({0, 0, 0}).y()), depth_(cover.depth) {
    outline_.middle = ground_->from_world({cover.center.x(), lift_, cover.center.z()});
    outline_.axes = rotation_from_degrees({0, ground_->turned(), 0}).transpose() *
                    rotation_from_degrees({0, turned, 0});
    outline_.radius = cover.radius;
    outline_.half = cover.radius > 0 ? Eigen::Vector2d(cover.radius, cover.radius)
                                     : Eigen::Vector2d(0.5 * cover.width, 0.5 * cover.length);
    Vec3d missing;
    const auto range = ground_->range_over(outline_, missing);
    if (!range) refuse(missing);
    low_ = lift_ + range->low;
    high_ = lift_ + range->high + depth_;
  }

  double volume() const override {
    const double radius = outline_.radius;
    return depth_ * (radius > 0 ? std::numbers::pi * radius * radius : 4 * outline_.half.prod());
  }
  Bounds bounds_after(const Mat3d& rotation) const override {
    const Eigen::Vector2d& half = outline_.half;
    return turned_bounds({{-half.x(), low_, -half.y()}, {half.x(), high_, half.y()}}, rotation);
  }
  bool contains(const Vec3d& y) const override {
    if (outline_.beside(y) > 0) return false;
    const double above = y.y() - surface(y);
    return above >= 0 && above <= depth_;
  }
  double clearance(const Vec3d& y) const override {
    const double beside = outline_.beside(y);
    const double above = y.y() - surface(y);
    const double beyond = std::max(-above, above - depth_) * ground_->flattest();
    if (std::isnan(beyond)) return beside > 0 ? beside : 0;  // beside a hole
    return std::max(beside, beyond);
  }
  Vec3d inner_point() const override { return {0, surface({0, 0, 0}) + 0.5 * depth_, 0}; }

 private:
  /// y of the surface; NaN in a hole.
  double surface(const Vec3d& y) const {
    const Vec3d x = outline_.middle + outline_.axes * y;
    const std::optional<double> height = ground_->height(x.x(), x.z());
    return height ? lift_ + *height : NAN;
  }

  [[noreturn]] void refuse(const Vec3d& missing) const {
    const Vec3d at = ground_->to_world(missing);
    throw ShapeError("the cover reaches x = " + metres(at.x()) + ", z = " + metres(at.z()) +
                     ", where " + ground_->extent() + ". Move it or make it smaller");
  }

  std::shared_ptr<const Ground> ground_;
  Outline outline_;
  double lift_, depth_, low_ = 0, high_ = 0;
};

}  // namespace

std::unique_ptr<const Form> make_terrain_solid(const Terrain& terrain) {
  return std::make_unique<TerrainForm>(terrain);
}

std::unique_ptr<const Form> make_cover_solid(const Cover& cover, double turned) {
  return std::make_unique<CoverForm>(cover, turned);
}

}  // namespace neve::sim::shapes
