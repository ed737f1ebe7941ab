#include "render/frame/occlusion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace neve::render {

// Tiles of a third of the radius: a disc covers a dozen of them, and asking about a disc reads few.
OcclusionGrid::OcclusionGrid(const View& view, float typical_radius)
    : tile_(std::clamp(std::floor(typical_radius / 3), 1.0f, 64.0f)),
      columns_(static_cast<int>(std::ceil(static_cast<float>(view.width) / tile_))),
      rows_(static_cast<int>(std::ceil(static_cast<float>(view.height) / tile_))),
      limit_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
             std::numeric_limits<float>::infinity()) {}

OcclusionGrid::Span OcclusionGrid::touched(float low, float high, int count) const {
  const float last = static_cast<float>(count - 1);
  return {static_cast<int>(std::clamp(std::floor(low / tile_), 0.0f, last)),
          static_cast<int>(std::clamp(std::floor(high / tile_), 0.0f, last))};
}

bool OcclusionGrid::hides(float x, float y, float reach, float nearest) const {
  const Span across = touched(x - reach, x + reach, columns_);
  const Span along = touched(y - reach, y + reach, rows_);
  for (int j = along.first; j <= along.last; ++j) {
    const float* row = limit_.data() + static_cast<std::ptrdiff_t>(j) * columns_;
    for (int i = across.first; i <= across.last; ++i) {
      if (!(row[i] < nearest)) return false;
    }
  }
  return true;
}

void OcclusionGrid::cover(float x, float y, float radius, float farthest) {
  if (radius < 0.5f * tile_) return;
  const Span across = touched(x - radius, x + radius, columns_);
  const Span along = touched(y - radius, y + radius, rows_);
  const auto far_edge = [&](int tile, float center) {
    const float low = static_cast<float>(tile) * tile_;
    return std::max(std::abs(low - center), std::abs(low + tile_ - center));
  };
  for (int j = along.first; j <= along.last; ++j) {
    const float dy = far_edge(j, y);
    float* row = limit_.data() + static_cast<std::ptrdiff_t>(j) * columns_;
    for (int i = across.first; i <= across.last; ++i) {
      const float dx = far_edge(i, x);
      if (dx * dx + dy * dy <= radius * radius) row[i] = std::min(row[i], farthest);
    }
  }
}

}  // namespace neve::render
