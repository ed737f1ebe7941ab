#include <algorithm>
#include <cmath>

#include "render/light/light_fields.h"

namespace neve::render::light {
namespace {

/// The grid seen along the axis that the light mostly follows: slices of rows of cells, slice 0
/// nearest to the light.
struct Slicing {
  int slices, rows, columns;
  std::ptrdiff_t slice_stride, row_stride, column_stride, first;
  float row_shift, column_shift;  ///< cells towards the light per slice
  float path;                     ///< cells that the light travels per slice
};

Slicing slice_along(const LightGrid& grid, Vec3f toward_light) {
  const Vec3f size = {std::abs(toward_light.x), std::abs(toward_light.y), std::abs(toward_light.z)};
  const int axis = size.y >= size.x && size.y >= size.z ? 1 : size.x >= size.z ? 0 : 2;
  // Rows run along x where they can, so that the inner loop is contiguous.
  const int column = axis == 0 ? 1 : 0, row = 3 - axis - column;
  const std::ptrdiff_t strides[3] = {1, grid.size.x,
                                     static_cast<std::ptrdiff_t>(grid.size.x) * grid.size.y};
  Slicing s;
  s.slices = grid.size[axis];
  s.rows = grid.size[row];
  s.columns = grid.size[column];
  const bool is_from_above = toward_light[axis] > 0;
  s.slice_stride = is_from_above ? -strides[axis] : strides[axis];
  s.first = is_from_above ? strides[axis] * (s.slices - 1) : 0;
  s.row_stride = strides[row];
  s.column_stride = strides[column];
  s.row_shift = toward_light[row] / size[axis];
  s.column_shift = toward_light[column] / size[axis];
  s.path = 1 / size[axis];
  return s;
}

/// Light that leaves a slice towards the next one, with a border of full light around it.
class Border {
 public:
  Border(int rows, int columns)
      : pitch_(columns + 2 * width),
        values_(static_cast<std::size_t>(pitch_ * (rows + 2 * width)), 1.0f) {}
  float* row(int r) { return values_.data() + (r + width) * pitch_ + width; }
  std::ptrdiff_t pitch() const { return pitch_; }

 private:
  static constexpr std::ptrdiff_t width = 2;  // the light leans by at most one cell per slice
  std::ptrdiff_t pitch_;
  std::vector<float> values_;
};

}  // namespace

void sweep_light(const std::vector<float>& extinction, const LightGrid& grid, Vec3f toward_light,
                 std::vector<float>& light) {
  const Slicing s = slice_along(grid, toward_light);
  const float row_floor = std::floor(s.row_shift), column_floor = std::floor(s.column_shift);
  const float row_part = s.row_shift - row_floor, column_part = s.column_shift - column_floor;
  const int row_offset = static_cast<int>(row_floor),
            column_offset = static_cast<int>(column_floor);
  // The same four weights serve every cell: the light is parallel.
  const float w00 = (1 - row_part) * (1 - column_part), w01 = (1 - row_part) * column_part;
  const float w10 = row_part * (1 - column_part), w11 = row_part * column_part;

  light.resize(extinction.size());
  Border above(s.rows, s.columns), here(s.rows, s.columns);
  for (int k = 0; k < s.slices; ++k) {
    for (int r = 0; r < s.rows; ++r) {
      const std::ptrdiff_t start = s.first + k * s.slice_stride + r * s.row_stride;
      const float* e = extinction.data() + start;
      float* out = light.data() + start;
      const float* near = above.row(r + row_offset) + column_offset;
      const float* far = near + above.pitch();
      float* leaving = here.row(r);
      const auto cell = [&](int c, std::ptrdiff_t at) {
        const float arriving = w00 * near[c] + w01 * near[c + 1] + w10 * far[c] + w11 * far[c + 1];
        const float x = e[at] * s.path;
        out[at] = arriving;
        leaving[c] = arriving / (1 + x + 0.5f * x * x);  // exp(-x), close enough and smooth
      };
      if (s.column_stride == 1) {
        for (int c = 0; c < s.columns; ++c) cell(c, c);
      } else {
        for (int c = 0; c < s.columns; ++c) cell(c, c * s.column_stride);
      }
    }
    std::swap(above, here);
  }
}

}  // namespace neve::render::light
