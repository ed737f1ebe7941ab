#pragma once
/// The box of cells that holds the air around moving snow and its dust.

#include <cstddef>

#include "sim/types/math.h"

namespace neve::sim::dust {

/// Cell (i, j, k) reaches from spacing (low + (i, j, k)) over one spacing. Fields have a place for
/// each cell and one more at the end of each axis, for the faces there.
struct AirBox {
  double spacing = 1;   ///< m
  Vec3i low{0, 0, 0};   ///< in cells
  Vec3i size{0, 0, 0};  ///< cells; 0: there is no air

  bool is_empty() const { return size.x() == 0; }
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y() + 1) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size.x() + 1) +
           static_cast<std::size_t>(i);
  }
  /// Places of a field.
  std::size_t count() const {
    return is_empty()
               ? 0
               : static_cast<std::size_t>(size.x() + 1) * static_cast<std::size_t>(size.y() + 1) *
                     static_cast<std::size_t>(size.z() + 1);
  }
  std::size_t step(int axis) const {
    const std::size_t row = static_cast<std::size_t>(size.x() + 1);
    return axis == 0 ? 1 : axis == 1 ? row : row * static_cast<std::size_t>(size.y() + 1);
  }
  /// Returns a place in cells from the lower corner.
  Vec3d place(const Vec3d& x) const { return x / spacing - low.cast<double>(); }
  Vec3d middle(int i, int j, int k) const {
    return spacing * (low.cast<double>() + Vec3d(i + 0.5, j + 0.5, k + 0.5));
  }
  bool contains(const Vec3d& place) const {
    return (place.array() >= 0).all() && (place.array() < size.cast<double>().array()).all();
  }
  bool contains(const AirBox& other) const {
    return (other.low.array() >= low.array()).all() &&
           ((other.low + other.size).array() <= (low + size).array()).all();
  }
  bool operator==(const AirBox& o) const {
    return spacing == o.spacing && low == o.low && size == o.size;
  }
};

/// Cells of a box, at most: more air costs more than the snow.
inline constexpr double max_air_cells = 1 << 20;

/// A box around places, grown in steps of several cells, and never larger than max_air_cells.
/// @param low, high  of the places, m
/// @param before  kept as it is while it fits
AirBox air_box_around(const Vec3d& low, const Vec3d& high, double spacing, const AirBox& before);

}  // namespace neve::sim::dust
