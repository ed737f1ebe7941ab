#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "render/light/light_fields.h"

namespace neve::render::light {
namespace {

constexpr int max_cells = 96;  // per axis
constexpr float spacings_per_cell = 1.6f;
constexpr int margin_cells = 4;  // room for shadows and for blurring

struct LightBox {
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

/// Values of some ranks among the finite coordinates along one axis, and how many there are.
class Ranks {
 public:
  Ranks(const std::vector<Vec3f>& position, float Vec3f::*axis)
      : position_(position), axis_(axis), bin_(position.size(), no_bin) {
    for (const Vec3f& p : position) {
      const float x = p.*axis;
      if (!std::isfinite(x)) continue;
      ++count_;
      low_ = std::min(low_, x);
      high_ = std::max(high_, x);
    }
    // Halves, as the difference of the ends may not be finite.
    scale_ = 0.5f * static_cast<float>(bins - 1) / std::max(0.5f * high_ - 0.5f * low_, 1e-37f);
    for (std::size_t p = 0; p < position.size(); ++p) {
      if (!std::isfinite(position[p].*axis)) continue;
      bin_[p] = bin_of(position[p].*axis);
      ++sizes_[bin_[p]];
    }
  }
  std::size_t count() const { return count_; }
  float low() const { return low_; }
  float high() const { return high_; }

  /// The value with `rank` smaller ones: only those in its bin have to be sorted.
  float at(std::size_t rank) const {
    std::uint16_t bin = 0;
    while (rank >= sizes_[bin]) rank -= sizes_[bin++];
    std::vector<float> values;
    values.reserve(sizes_[bin]);
    for (std::size_t p = 0; p < bin_.size(); ++p)
      if (bin_[p] == bin) values.push_back(position_[p].*axis_);
    const auto it = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), it, values.end());
    return *it;
  }

 private:
  static constexpr std::size_t bins = 1024;
  static constexpr std::uint16_t no_bin = bins;
  /// Never smaller for a larger value.
  std::uint16_t bin_of(float x) const {
    return static_cast<std::uint16_t>(
        std::clamp(scale_ * (0.5f * x - 0.5f * low_) * 2, 0.0f, static_cast<float>(bins - 1)));
  }

  const std::vector<Vec3f>& position_;
  float Vec3f::*axis_;
  std::vector<std::uint16_t> bin_;  ///< of each point; of one that is not finite none
  std::size_t count_ = 0;
  float low_ = std::numeric_limits<float>::infinity(), high_ = -low_, scale_ = 0;
  std::array<std::uint32_t, bins> sizes_{};
};

/// Extends the box along one axis over nearly all values: the middle 99 % widened by half of its
/// width, but no wider than the data. A few strays do not blow the box up.
void include_most(const Ranks& values, int axis, LightBox& box) {
  if (values.count() == 0) return;
  const std::size_t cut = values.count() < 8 ? 0 : std::max<std::size_t>(1, values.count() / 200);
  const float middle_low = values.at(cut), middle_high = values.at(values.count() - 1 - cut);
  const float extra = 0.5f * (middle_high - middle_low);
  box.include(axis, std::max(values.low(), middle_low - extra));
  box.include(axis, std::min(values.high(), middle_high + extra));
}

LightBox box_of_points(const std::vector<Vec3f>& position, ThreadPool* pool) {
  constexpr std::array<float Vec3f::*, 3> members = {&Vec3f::x, &Vec3f::y, &Vec3f::z};
  LightBox box;
  for_each_task(3, pool, [&](int axis) {
    include_most(Ranks(position, members[static_cast<std::size_t>(axis)]), axis, box);
  });
  return box;
}

void include_smoke(const SmokeGrid& smoke, LightBox& box) {
  for (int axis = 0; axis < 3; ++axis) {
    box.include(axis, smoke.origin[axis] + smoke.spacing);
    box.include(axis,
                smoke.origin[axis] + smoke.spacing * static_cast<float>(smoke.size[axis] - 2));
  }
}

/// Takes in a mesh, but no further from the snow than their own extent: it throws its shadow on
/// snow beside it, and a large or distant one must not coarsen the light on the snow.
void include_mesh(const TriangleMesh& mesh, const LightBox& snow, LightBox& box) {
  const float reach = snow.is_empty() ? LightBox::inf : snow.extent();
  LightBox clipped;
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
                         const SmokeGrid& smoke, ThreadPool* pool) {
  LightBox snow = box_of_points(points.position, pool);
  float finest = snow.is_empty() ? 0 : spacings_per_cell * points.spacing;
  if (!smoke.is_empty()) {
    include_smoke(smoke, snow);
    if (!(finest > 0)) finest = smoke_spacings_per_cell * smoke.node_spacing;
  }
  LightBox box = snow;
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

}  // namespace neve::render::light
