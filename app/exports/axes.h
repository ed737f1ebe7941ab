#pragma once
/// Conversion of the simulation's metres, y up, to the units and the axes of a file.

#include "app/scene/read.h"
#include "app/scene/scene.h"

namespace neve::app::exports {

/// Axes only change places and signs: every number keeps its bits at scale 1.
class Axes {
 public:
  explicit Axes(const scene::Export& e) : is_z_up_(e.up == scene::UpAxis::z), scale_(e.scale) {}
  /// Puts the offset back that was taken out of files with coordinates of a map, in formats whose
  /// places are double.
  Axes(const scene::Scene& scene, const scene::Export& e) : Axes(e) {
    using enum scene::ExportFormat;
    const bool is_double =
        e.format == ply || e.format == csv || e.format == npz || e.format == vtp || e.format == vti;
    if (is_double) offset_ = scene::world_offset(scene).value_or(offset_);
  }

  bool is_z_up() const { return is_z_up_; }
  double scale() const { return scale_; }

  sim::Vec3d direction(const sim::Vec3d& v) const {
    return is_z_up_ ? sim::Vec3d(v.x(), -v.z(), v.y()) : v;
  }
  /// Turns and scales places and velocities.
  sim::Vec3d scaled(const sim::Vec3d& v) const { return scale_ * direction(v); }
  /// The same of a place, in the world of the scene's files.
  sim::Vec3d placed(const sim::Vec3d& x) const { return scaled(x + offset_); }
  /// Turns a tensor: R A R^T.
  sim::Mat3d tensor(const sim::Mat3d& a) const {
    if (!is_z_up_) return a;
    sim::Mat3d rows, both;
    for (int c = 0; c < 3; ++c) rows.col(c) = direction(a.col(c));
    for (int r = 0; r < 3; ++r) both.row(r) = direction(rows.row(r).transpose()).transpose();
    return both;
  }
  /// Turns the columns of a rotation: R A.
  sim::Mat3d turned(const sim::Mat3d& a) const {
    sim::Mat3d out;
    for (int c = 0; c < 3; ++c) out.col(c) = direction(a.col(c));
    return out;
  }

 private:
  bool is_z_up_;
  double scale_;
  sim::Vec3d offset_{0, 0, 0};  ///< m, in the axes of the simulation
};

}  // namespace neve::app::exports
