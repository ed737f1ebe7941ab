#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/shapes/height_field.h"
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
  /// Half a spacing below the surface of the first cell with data.
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

/// About the middle of its outline, at the height that the cover gives.
class CoverForm final : public Form {
 public:
  CoverForm(const Cover& cover, double turned)
      : field_(height_field(cover.ground)),
        to_ground_(rotation_from_degrees({0, cover.turned, 0}).transpose() *
                   rotation_from_degrees({0, turned, 0})),
        lift_(cover.ground.center.y()),
        depth_(cover.depth),
        half_(0.5 * cover.width, 0.5 * cover.length),
        radius_(cover.radius) {
    middle_ = rotation_from_degrees({0, cover.turned, 0}).transpose() *
              (Vec3d(cover.center.x(), 0, cover.center.z()) -
               Vec3d(cover.ground.center.x(), 0, cover.ground.center.z()));
    if (radius_ > 0) half_ = Eigen::Vector2d::Constant(radius_);
    const Vec3d reach = radius_ > 0 ? Vec3d(radius_, 0, radius_)
                                    : Vec3d(to_ground_.cwiseAbs() * Vec3d(half_.x(), 0, half_.y()));
    Eigen::Vector2d missing;
    const auto range =
        field_->range_over({middle_.x() - reach.x(), middle_.z() - reach.z()},
                           {middle_.x() + reach.x(), middle_.z() + reach.z()}, radius_, missing);
    if (!range) refuse(cover, missing);
    low_ = lift_ + range->low;
    high_ = lift_ + range->high + depth_;
  }

  double volume() const override {
    return depth_ * (radius_ > 0 ? std::numbers::pi * radius_ * radius_ : 4 * half_.prod());
  }
  Bounds bounds_after(const Mat3d& rotation) const override {
    return turned_bounds({{-half_.x(), low_, -half_.y()}, {half_.x(), high_, half_.y()}}, rotation);
  }
  bool contains(const Vec3d& y) const override {
    if (radius_ > 0 ? std::hypot(y.x(), y.z()) > radius_
                    : std::abs(y.x()) > half_.x() || std::abs(y.z()) > half_.y())
      return false;
    const double above = y.y() - surface(y);
    return above >= 0 && above <= depth_;
  }
  /// A place at a height above or below a surface is at least that times `flattest` away from it.
  double clearance(const Vec3d& y) const override {
    const double beside = radius_ > 0
                              ? std::hypot(y.x(), y.z()) - radius_
                              : std::max(std::abs(y.x()) - half_.x(), std::abs(y.z()) - half_.y());
    const double above = y.y() - surface(y);
    const double beyond = std::max(-above, above - depth_) * field_->flattest();
    if (std::isnan(beyond)) return beside > 0 ? beside : 0;  // beside a hole
    return std::max(beside, beyond);
  }
  Vec3d inner_point() const override { return {0, surface({0, 0, 0}) + 0.5 * depth_, 0}; }

 private:
  /// y of the surface; NaN in a hole.
  double surface(const Vec3d& y) const {
    const Vec3d x = middle_ + to_ground_ * y;
    const auto place = field_->at(x.x(), x.z());
    return place ? lift_ + place->height : NAN;
  }

  [[noreturn]] void refuse(const Cover& cover, const Eigen::Vector2d& missing) const {
    const Vec3d at =
        rotation_from_degrees({0, cover.turned, 0}) * Vec3d(missing.x(), 0, missing.y()) +
        cover.ground.center;
    const Bounds& box = field_->bounds();
    const auto text = [](double x) { return number_text(x, 6); };
    throw ShapeError(
        "the cover reaches x = " + text(at.x()) + ", z = " + text(at.z()) + ", where " +
        cover.ground.file +
        " has no ground; its posts are at x = " + text(cover.ground.center.x() + box.min.x()) +
        " to " + text(cover.ground.center.x() + box.max.x()) +
        " and z = " + text(cover.ground.center.z() + box.min.z()) + " to " +
        text(cover.ground.center.z() + box.max.z()) +
        (field_->has_holes() ? ", and some have no data" : "") + ". Move it or make it smaller");
  }

  std::shared_ptr<const HeightField> field_;
  Mat3d to_ground_;
  Vec3d middle_;  ///< of the outline, in the axes of the ground
  double lift_, depth_;
  Eigen::Vector2d half_;
  double radius_, low_ = 0, high_ = 0;
};

}  // namespace

std::unique_ptr<const Form> make_terrain_solid(const Terrain& terrain) {
  return std::make_unique<TerrainForm>(terrain);
}

std::unique_ptr<const Form> make_cover_solid(const Cover& cover, double turned) {
  return std::make_unique<CoverForm>(cover, turned);
}

}  // namespace neve::sim::shapes
