#include "sim/shapes/height_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/shapes/held_files.h"
#include "sim/types/number_text.h"

namespace neve::sim::shapes {
namespace {

/// The cell of a place along one side, and where in it; beyond the posts, the nearest place.
struct Along {
  std::size_t cell;
  double part;
  bool is_beyond;

  Along(double place, std::size_t count) {
    const double last = static_cast<double>(count - 1);
    const double held = std::clamp(place, 0.0, last);
    is_beyond = held != place;
    cell = std::min(static_cast<std::size_t>(held), count - 2);
    part = held - static_cast<double>(cell);
  }
};

/// Heights of the corners of a cell: west and east in the north, then in the south.
std::array<double, 4> corners_of(const files::HeightGrid& grid, std::size_t column,
                                 std::size_t row) {
  const float* at = grid.height.data() + row * grid.columns + column;
  return {static_cast<double>(at[0]), static_cast<double>(at[1]),
          static_cast<double>(at[grid.columns]), static_cast<double>(at[grid.columns + 1])};
}

std::shared_ptr<const files::HeightGrid> height_grid(const Terrain& terrain) {
  static Recent<files::HeightGrid> recent;
  const std::string key = file_stamp(terrain.file) + "|" + number_text(terrain.spacing, 17) + "|" +
                          number_text(terrain.low, 17) + "|" + number_text(terrain.high, 17);
  return recent.get(key, [&] {
    auto grid = std::make_shared<const files::HeightGrid>(
        files::read_heights(terrain.file, {terrain.spacing, terrain.low, terrain.high}));
    require_unchanged(terrain.file);
    return grid;
  });
}

}  // namespace

HeightField::HeightField(std::shared_ptr<const files::HeightGrid> grid, const Vec3d& origin)
    : grid_(std::move(grid)),
      first_{grid_->west - origin.x(), origin.y() - grid_->north},
      datum_(grid_->datum - origin.z()) {
  bounds_.min = {first_[0], datum_ + grid_->lowest - grid_->spacing, first_[1]};
  bounds_.max = {x_of(grid_->columns - 1), datum_ + grid_->highest, z_of(grid_->rows - 1)};
  measure();
}

/// The slope of a bilinear cell is steepest in a corner.
void HeightField::measure() {
  double steepest = 0;
  for (std::size_t r = 0; r + 1 < grid_->rows; ++r)
    for (std::size_t c = 0; c + 1 < grid_->columns; ++c) {
      const auto [nw, ne, sw, se] = corners_of(*grid_, c, r);
      const double east = std::max(std::abs(ne - nw), std::abs(se - sw));
      const double south = std::max(std::abs(sw - nw), std::abs(se - ne));
      const double both = east * east + south * south;
      if (std::isnan(nw + ne + sw + se)) has_holes_ = true;
      if (both > steepest) steepest = both;
    }
  flattest_ = 1 / std::sqrt(1 + steepest / (grid_->spacing * grid_->spacing));
}

std::optional<HeightField::Place> HeightField::at(double x, double z) const {
  const Along east((x - first_[0]) / grid_->spacing, grid_->columns),
      south((z - first_[1]) / grid_->spacing, grid_->rows);
  const auto [nw, ne, sw, se] = corners_of(*grid_, east.cell, south.cell);
  const double north_edge = nw + east.part * (ne - nw), south_edge = sw + east.part * (se - sw);
  const double height = north_edge + south.part * (south_edge - north_edge);
  if (std::isnan(height)) return std::nullopt;
  const double along_x = ne - nw + south.part * (se - sw - (ne - nw));
  const double along_z = south_edge - north_edge;
  const Vec3d normal(east.is_beyond ? 0 : -along_x / grid_->spacing, 1,
                     south.is_beyond ? 0 : -along_z / grid_->spacing);
  return Place{datum_ + height, normal.normalized()};
}

double HeightField::distance(const Vec3d& y) const {
  const std::optional<Place> place = at(y.x(), y.z());
  return place ? (y.y() - place->height) * place->normal.y() : no_ground;
}

HeightSamples HeightField::samples() const {
  HeightSamples out;
  out.height = grid_->height.data();
  out.columns = static_cast<int>(grid_->columns);
  out.rows = static_cast<int>(grid_->rows);
  out.spacing = grid_->spacing;
  out.first[0] = first_[0];
  out.first[1] = first_[1];
  out.datum = datum_;
  out.highest = grid_->highest;
  out.flattest = has_holes_ ? 0 : flattest_;
  return out;
}

std::optional<HeightField::Range> HeightField::range_over(const Eigen::Vector2d& low,
                                                          const Eigen::Vector2d& high,
                                                          double radius,
                                                          Eigen::Vector2d& missing) const {
  const double spacing = grid_->spacing;
  const Eigen::Vector2d middle = 0.5 * (low + high);
  // A hair for the rounding of an outline that is given along the border.
  const double hair = 1e-9 * spacing;
  if (low.x() < bounds_.min.x() - hair || low.y() < bounds_.min.z() - hair ||
      high.x() > bounds_.max.x() + hair || high.y() > bounds_.max.z() + hair) {
    missing = {low.x() < bounds_.min.x() - hair ? low.x() : high.x(),
               low.y() < bounds_.min.z() - hair ? low.y() : high.y()};
    return std::nullopt;
  }
  const auto cell = [&](double place, double first, std::size_t count) {
    return Along((place - first) / spacing, count).cell;
  };
  Range range{INFINITY, -INFINITY};
  for (std::size_t r = cell(low.y(), first_[1], grid_->rows);
       r <= cell(high.y() - hair, first_[1], grid_->rows); ++r)
    for (std::size_t c = cell(low.x(), first_[0], grid_->columns);
         c <= cell(high.x() - hair, first_[0], grid_->columns); ++c) {
      const Eigen::Vector2d corner(x_of(c), z_of(r));
      const Eigen::Vector2d nearest =
          middle.cwiseMax(corner).cwiseMin(corner + Eigen::Vector2d::Constant(spacing));
      if (radius > 0 && (nearest - middle).norm() > radius) continue;
      for (const double h : corners_of(*grid_, c, r)) {
        if (std::isnan(h)) {
          missing = nearest;
          return std::nullopt;
        }
        range.low = std::min(range.low, datum_ + h);
        range.high = std::max(range.high, datum_ + h);
      }
    }
  return range;
}

std::shared_ptr<const HeightField> height_field(const Terrain& terrain) {
  static Recent<HeightField> recent;
  std::string key = file_stamp(terrain.file);
  for (const double x : {terrain.spacing, terrain.low, terrain.high, terrain.origin.x(),
                         terrain.origin.y(), terrain.origin.z()})
    key += "|" + number_text(x, 17);
  return recent.get(key, [&] {
    return std::make_shared<const HeightField>(height_grid(terrain), terrain.origin);
  });
}

bool takes_scale(const Terrain& terrain) {
  return files::takes_scale(terrain.file);
}

double memory_to_read(const Terrain& terrain) {
  // A file that the run has read has its room.
  static Recent<double> recent;
  return *recent.get(file_stamp(terrain.file), [&] {
    return std::make_shared<const double>(files::memory_of_heights(terrain.file));
  });
}

Vec3d middle_of(const Terrain& terrain) {
  const std::shared_ptr<const files::HeightGrid> grid = height_grid(terrain);
  const double east = 0.5 * grid->spacing * static_cast<double>(grid->columns - 1),
               south = 0.5 * grid->spacing * static_cast<double>(grid->rows - 1);
  return {std::round(grid->west + east), std::round(grid->north - south), grid->datum};
}

}  // namespace neve::sim::shapes
