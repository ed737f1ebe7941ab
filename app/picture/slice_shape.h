#pragma once
/// The snow on a plane: places that are inside, sharper than the nodes know.

#include <algorithm>
#include <vector>

#include "app/picture/slice.h"

namespace neve::app::picture {

/// Coordinates u along `across` and v along `up` of a plane, m.
struct Rectangle {
  double left = 0, right = 0, bottom = 0, top = 0;
  double width() const { return right - left; }
  double height() const { return top - bottom; }
};

/// The point of the plane with the coordinates u and v.
sim::Vec3d point_on(const SlicePlane& plane, double u, double v);

/// Samples of the share of space that particles fill, on a rectangle around those near the plane:
/// sum of V W(|x - x_p|), with the kernel W of reach two spacings. Half is the surface, also of
/// sheets thinner than a cell. A particle without neighbours is a disc of half a spacing.
class SliceShape {
 public:
  SliceShape(const scene::Scene& scene, const sim::ParticleArrays& particles, double spacing,
             const SlicePlane& plane);

  bool is_empty() const { return columns_ == 0; }
  /// Returns the rectangle around the snow and a cell of the grid on each side.
  const Rectangle& rectangle() const { return rectangle_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// 0 to 1; snow is where it is at least a half.
  float cover(int column, int row) const { return std::min(share_[index(column, row)], 1.0f); }
  /// The middle of a sample.
  double u(int column) const { return rectangle_.left + (column + 0.5) * step_u_; }
  double v(int row) const { return rectangle_.bottom + (row + 0.5) * step_v_; }

 private:
  struct Near {
    double u, v, away, volume;
  };
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void surround(const std::vector<Near>& near, double cell, double spacing);
  void add(const Near& particle, double spacing);

  Rectangle rectangle_;
  int columns_ = 0, rows_ = 0;
  double step_u_ = 1, step_v_ = 1;
  std::vector<float> share_;
};

}  // namespace neve::app::picture
