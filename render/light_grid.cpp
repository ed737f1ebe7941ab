#include <algorithm>
#include <cmath>
#include <limits>

#include "render/light_fields.h"

namespace neve::render {
namespace {

constexpr int max_cells = 96;  // per axis
constexpr float spacings_per_cell = 1.6f;
constexpr int margin_cells = 4;  // room for shadows and for blurring

struct Box {
  static constexpr float inf = std::numeric_limits<float>::infinity();
  Vec3f low{inf, inf, inf}, high{-inf, -inf, -inf};

  void include(int axis, float x) {
    if (!std::isfinite(x)) return;
    low[axis] = std::min(low[axis], x);
    high[axis] = std::max(high[axis], x);
  }
  bool is_empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  float extent() const {
    return is_empty() ? 0 : std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  }
};

/// Extends the box along one axis over nearly all values: the middle 99 % widened by half of its
/// width, but no wider than the data. A few strays do not blow the box up.
void include_most(std::vector<float>& values, int axis, Box& box) {
  if (values.empty()) return;
  const std::size_t cut = values.size() < 8 ? 0 : std::max<std::size_t>(1, values.size() / 200);
  const auto at = [&](std::size_t k) {
    const auto it = values.begin() + static_cast<std::ptrdiff_t>(k);
    std::nth_element(values.begin(), it, values.end());
    return *it;
  };
  const float middle_low = at(cut), middle_high = at(values.size() - 1 - cut);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const float extra = 0.5f * (middle_high - middle_low);
  box.include(axis, std::max(*low, middle_low - extra));
  box.include(axis, std::min(*high, middle_high + extra));
}

Box box_of_points(const std::vector<Vec3f>& position) {
  Box box;
  std::vector<float> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (const Vec3f& p : position) {
      if (std::isfinite(p[axis])) values.push_back(p[axis]);
    }
    include_most(values, axis, box);
  }
  return box;
}

void include_smoke(const SmokeGrid& smoke, Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    box.include(axis, smoke.origin[axis] + smoke.spacing);
    box.include(axis,
                smoke.origin[axis] + smoke.spacing * static_cast<float>(smoke.size[axis] - 2));
  }
}

/// Takes in a mesh, but no further from the snow than their own extent: it throws its shadow on
/// snow beside it, and a large or distant one must not coarsen the light on the snow.
void include_mesh(const TriangleMesh& mesh, const Box& snow, Box& box) {
  const float reach = snow.is_empty() ? Box::inf : snow.extent();
  Box clipped;
  for (const Vec3f& p : mesh.position) {
    for (int axis = 0; axis < 3; ++axis) clipped.include(axis, p[axis]);
  }
  if (!snow.is_empty()) {
    for (int axis = 0; axis < 3; ++axis) {
      clipped.low[axis] = std::max(clipped.low[axis], snow.low[axis] - reach);
      clipped.high[axis] = std::min(clipped.high[axis], snow.high[axis] + reach);
    }
  }
  if (clipped.is_empty()) return;
  for (int axis = 0; axis < 3; ++axis) {
    box.include(axis, clipped.low[axis]);
    box.include(axis, clipped.high[axis]);
  }
}

}  // namespace

LightGrid fit_light_grid(const Points& points, const std::vector<TriangleMesh>& meshes,
                         const SmokeGrid& smoke) {
  Box snow = box_of_points(points.position);
  float finest = snow.is_empty() ? 0 : spacings_per_cell * points.spacing;
  if (!smoke.is_empty()) {
    include_smoke(smoke, snow);
    if (!(finest > 0)) finest = smoke_spacings_per_cell * smoke.node_spacing;
  }
  Box box = snow;
  for (const TriangleMesh& mesh : meshes) include_mesh(mesh, snow, box);
  LightGrid grid;
  if (box.is_empty()) return grid;

  if (!(finest > 0)) finest = box.extent() / 40;
  grid.cell = std::max({finest, box.extent() / (max_cells - 2 * margin_cells - 1), 1e-6f});
  for (int axis = 0; axis < 3; ++axis) {
    const float width = box.high[axis] - box.low[axis];
    const int cells = static_cast<int>(std::ceil(width / grid.cell)) + 2 * margin_cells;
    grid.size[axis] = std::min(cells, max_cells);
    grid.origin[axis] =
        box.low[axis] + 0.5f * (width - grid.cell * static_cast<float>(grid.size[axis]));
  }
  return grid;
}

}  // namespace neve::render
