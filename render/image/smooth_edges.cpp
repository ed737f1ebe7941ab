#include "render/image/smooth_edges.h"

#include <algorithm>
#include <cstdlib>

namespace neve::render {

namespace {

/// Contrast from which there is an edge, of 255: at least, and as a share of the brightest
/// neighbour.
constexpr int edge_min = 10, edge_share_of_256 = 41;
/// Pixels that an edge is followed to either side.
constexpr int longest = 12;

/// Returns the brightness of a pixel that is RGBA in memory.
std::uint8_t brightness_of(std::uint32_t color) {
  const auto part = [&](int bits) { return color >> bits & 0xff; };
  return static_cast<std::uint8_t>((77 * part(0) + 150 * part(8) + 29 * part(16)) >> 8);
}

std::uint32_t mixed(std::uint32_t a, std::uint32_t b, float share) {
  std::uint32_t out = 0;
  for (int bits = 0; bits < 32; bits += 8) {
    const auto from = static_cast<float>(a >> bits & 0xff),
               to = static_cast<float>(b >> bits & 0xff);
    out |= static_cast<std::uint32_t>(from + (to - from) * share + 0.5f) << bits;
  }
  return out;
}

/// A picture by its brightness; places beyond its borders are those of the border.
struct Plane {
  const std::uint8_t* at_0;
  int width, height;

  int operator()(int x, int y) const {
    x = std::clamp(x, 0, width - 1);
    y = std::clamp(y, 0, height - 1);
    return at_0[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x)];
  }
};

/// Pixels for which the edge continues to one side, and whether it steps towards this pixel there.
struct End {
  int distance = longest;
  bool steps = false;
};

/// Share of the pixel across an edge in this pixel, and the way to that one.
struct Blend {
  int dx = 0, dy = 0;
  float share = 0;
};

End end_of(const Plane& plane, int x, int y, int along_x, int along_y, const Blend& other,
           int step_up) {
  const int own_here = plane(x, y);
  for (int k = 1; k <= longest; ++k) {
    const int i = x + k * along_x, j = y + k * along_y;
    const int own = plane(i, j);
    const int step = plane(std::clamp(i, 0, plane.width - 1) + other.dx,
                           std::clamp(j, 0, plane.height - 1) + other.dy) -
                     own;
    if (2 * std::abs(step - step_up) < std::abs(step_up)) continue;
    return {k, 2 * std::abs(own - own_here) > std::abs(step_up)};
  }
  return {};
}

Blend blend_at(const Plane& plane, int x, int y) {
  const int m = plane(x, y), right = plane(x + 1, y), left = plane(x - 1, y),
            above = plane(x, y + 1), below = plane(x, y - 1);
  const int contrast =
      std::max({m, right, left, above, below}) - std::min({m, right, left, above, below});
  // The edge runs along the axis across which brightness bends least.
  const int above_right = plane(x + 1, y + 1), above_left = plane(x - 1, y + 1),
            below_right = plane(x + 1, y - 1), below_left = plane(x - 1, y - 1);
  const int bends_up = 2 * std::abs(above + below - 2 * m) +
                       std::abs(above_left + below_left - 2 * left) +
                       std::abs(above_right + below_right - 2 * right);
  const int bends_aside = 2 * std::abs(right + left - 2 * m) +
                          std::abs(above_right + above_left - 2 * above) +
                          std::abs(below_right + below_left - 2 * below);
  const bool is_level = bends_up >= bends_aside;
  const int ahead = is_level ? above : right, behind = is_level ? below : left;
  const bool is_ahead = std::abs(ahead - m) >= std::abs(behind - m);
  const int side = is_ahead ? 1 : -1, step_up = (is_ahead ? ahead : behind) - m;
  // An edge that is too weak beside another one of this pixel is not followed.
  if (2 * std::abs(step_up) < contrast) return {};
  Blend blend{is_level ? 0 : side, is_level ? side : 0, 0};
  const int along_x = is_level ? 1 : 0, along_y = 1 - along_x;
  const End first = end_of(plane, x, y, -along_x, -along_y, blend, step_up),
            second = end_of(plane, x, y, along_x, along_y, blend, step_up);
  const End& near = first.distance <= second.distance ? first : second;
  if (!near.steps) return {};
  const auto whole = static_cast<float>(first.distance + second.distance - 1);
  blend.share = std::max(0.5f - (static_cast<float>(near.distance) - 0.5f) / whole, 0.0f);
  return blend;
}

/// Marks the pixels of a row at edges.
void mark_row(const std::uint8_t* row, const std::uint8_t* above, const std::uint8_t* below,
              int width, std::uint8_t* is_edge) {
  const auto mark = [&](int x, int left, int right) {
    const int most =
        std::max(std::max(std::max(row[left], row[right]), row[x]), std::max(above[x], below[x]));
    const int least =
        std::min(std::min(std::min(row[left], row[right]), row[x]), std::min(above[x], below[x]));
    is_edge[x] = (most - least >= edge_min) & (256 * (most - least) >= edge_share_of_256 * most);
  };
  mark(0, 0, std::min(1, width - 1));
  for (int x = 1; x < width - 1; ++x) mark(x, x - 1, x + 1);
  if (width > 1) mark(width - 1, width - 2, width - 1);
}

template <class Body>
void over_rows(ThreadPool* pool, int height, const Body& body) {
  const auto rows = [&](std::size_t begin, std::size_t end) {
    body(static_cast<int>(begin), static_cast<int>(end));
  };
  const auto count = static_cast<std::size_t>(height);
  if (pool)
    pool->ranges(count, pool->thread_count(), rows);
  else
    rows(0, count);
}

}  // namespace

const std::uint32_t* SmoothEdges::of(const std::uint32_t* picture, int pitch, int width, int height,
                                     ThreadPool* pool) {
  const std::size_t w = static_cast<std::size_t>(width);
  brightness_.resize(w * static_cast<std::size_t>(height));
  smooth_.resize(brightness_.size());
  const auto source = [&](int y) {
    return picture + static_cast<std::size_t>(y) * static_cast<std::size_t>(pitch);
  };
  const auto row = [&](int y) { return brightness_.data() + static_cast<std::size_t>(y) * w; };
  over_rows(pool, height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      std::transform(source(y), source(y) + width, row(y), brightness_of);
  });
  const Plane plane{brightness_.data(), width, height};
  over_rows(pool, height, [&](int begin, int end) {
    std::vector<std::uint8_t> is_edge(w);
    for (int y = begin; y < end; ++y) {
      std::uint32_t* out = smooth_.data() + static_cast<std::size_t>(y) * w;
      std::copy_n(source(y), width, out);
      mark_row(row(y), row(std::min(y + 1, height - 1)), row(std::max(y - 1, 0)), width,
               is_edge.data());
      for (int x = 0; x < width; ++x) {
        if (!is_edge[static_cast<std::size_t>(x)]) continue;
        const Blend blend = blend_at(plane, x, y);
        const int i = std::clamp(x + blend.dx, 0, width - 1),
                  j = std::clamp(y + blend.dy, 0, height - 1);
        if (blend.share > 0) out[x] = mixed(out[x], source(j)[i], blend.share);
      }
    }
  });
  return smooth_.data();
}

}  // namespace neve::render
