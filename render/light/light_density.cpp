#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "render/light/light_fields.h"

namespace neve::render::light {
namespace {

/// Weights are summed as integers: exact in any order, so neither the order of the points nor the
/// split into threads shows. 12 bits leave room for a million points in one cell.
constexpr float weight_one = 4096;

void add_point(const LightGrid& grid, Vec3f p, std::vector<std::uint32_t>& sums) {
  const Vec3f x = (p - grid.origin) / grid.cell - Vec3f{0.5f, 0.5f, 0.5f};
  // The negation also turns away NaN.
  if (!(x.x >= 0 && x.y >= 0 && x.z >= 0 && x.x < static_cast<float>(grid.size.x - 1) &&
        x.y < static_cast<float>(grid.size.y - 1) && x.z < static_cast<float>(grid.size.z - 1)))
    return;
  const int i = static_cast<int>(x.x), j = static_cast<int>(x.y), k = static_cast<int>(x.z);
  const float fx = x.x - static_cast<float>(i), fy = x.y - static_cast<float>(j),
              fz = x.z - static_cast<float>(k);
  const std::size_t row = static_cast<std::size_t>(grid.size.x);
  const std::size_t slice = row * static_cast<std::size_t>(grid.size.y);
  std::uint32_t* corner = sums.data() + static_cast<std::size_t>(k) * slice +
                          static_cast<std::size_t>(j) * row + static_cast<std::size_t>(i);
  for (std::size_t n = 0; n < 8; ++n) {
    const float w = (n & 1 ? fx : 1 - fx) * (n & 2 ? fy : 1 - fy) * (n & 4 ? fz : 1 - fz);
    corner[(n & 1) + (n >> 1 & 1) * row + (n >> 2) * slice] +=
        static_cast<std::uint32_t>(w * weight_one + 0.5f);
  }
}

/// One pass of a three-wide box along an axis, zero outside.
void blur_axis(const LightGrid& grid, int axis, const std::vector<float>& in,
               std::vector<float>& out, int first_slice, int last_slice) {
  const std::ptrdiff_t row = grid.size.x, slice = row * grid.size.y;
  const std::ptrdiff_t stride = axis == 0 ? 1 : axis == 1 ? row : slice;
  const int last = grid.size[axis] - 1;
  for (int k = first_slice; k < last_slice; ++k) {
    for (int j = 0; j < grid.size.y; ++j) {
      const std::ptrdiff_t start = k * slice + j * row;
      const float* from = in.data() + start;
      float* to = out.data() + start;
      const int at = axis == 1 ? j : k;
      const int begin = axis == 0 ? 1 : 0, end = axis == 0 ? last : grid.size.x;
      const float low = axis != 0 && at == 0 ? 0.0f : 1.0f;
      const float high = axis != 0 && at == last ? 0.0f : 1.0f;
      const std::ptrdiff_t down = low > 0 ? -stride : 0, up = high > 0 ? stride : 0;
      for (int i = begin; i < end; ++i)
        to[i] = (low * from[i + down] + from[i] + high * from[i + up]) * (1.0f / 3);
      if (axis == 0) {
        to[0] = (from[0] + (last > 0 ? from[1] : 0)) * (1.0f / 3);
        if (last > 0) to[last] = (from[last - 1] + from[last]) * (1.0f / 3);
      }
    }
  }
}

}  // namespace

void for_each_task(int count, ThreadPool* pool, const std::function<void(int)>& task) {
  if (!pool) {
    for (int i = 0; i < count; ++i) task(i);
    return;
  }
  std::atomic<int> next{0};
  pool->run(std::min(count, pool->thread_count()), [&](int) {
    for (int i = next++; i < count; i = next++) task(i);
  });
}

void bin_points(const Points& points, const LightGrid& grid, ThreadPool* pool,
                LightBuffers& buffers) {
  // Every part has sums of its own; more than a few cost more to add up than they save.
  const std::size_t parts = pool && points.position.size() > 20000
                                ? static_cast<std::size_t>(std::min(pool->thread_count(), 4))
                                : 1;
  std::vector<std::vector<std::uint32_t>>& sums = buffers.sums;
  sums.resize(std::max(sums.size(), parts));
  for_each_task(static_cast<int>(parts), pool, [&](int task) {
    const auto part = static_cast<std::size_t>(task);
    sums[part].assign(grid.count(), 0);
    const std::size_t count = points.position.size();
    for (std::size_t p = count * part / parts; p < count * (part + 1) / parts; ++p)
      add_point(grid, points.position[p], sums[part]);
  });

  // Packed points fill a cell to spread around 1; 0.8 makes most of them full.
  const float per_cell = std::pow(grid.cell / std::max(points.spacing, 1e-9f), 3.0f);
  const float scale = 1 / (0.8f * std::max(per_cell, 1.0f) * weight_one);
  buffers.density.resize(grid.count());
  const auto slice = static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y);
  for_each_task(grid.size.z, pool, [&](int k) {
    const std::size_t begin = slice * static_cast<std::size_t>(k), end = begin + slice;
    for (std::size_t part = 1; part < parts; ++part)
      for (std::size_t i = begin; i < end; ++i) sums[0][i] += sums[part][i];
    for (std::size_t i = begin; i < end; ++i)
      buffers.density[i] = std::min(1.0f, static_cast<float>(sums[0][i]) * scale);
  });
}

namespace {

/// Position of each cell of a row between texels: the lower texel and the fraction towards the
/// next.
struct Between {
  int low = -1;  ///< -1: outside
  float part = 0;
};

std::vector<Between> between_texels(const SmokeGrid& smoke, const LightGrid& grid, int axis) {
  std::vector<Between> all(static_cast<std::size_t>(grid.size[axis]));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const float place = grid.origin[axis] + grid.cell * (static_cast<float>(i) + 0.5f);
    const float x = (place - smoke.origin[axis]) / smoke.spacing;
    if (!(x >= 0 && x < static_cast<float>(smoke.size[axis] - 1))) continue;
    all[i].low = static_cast<int>(x);
    all[i].part = x - static_cast<float>(all[i].low);
  }
  return all;
}

}  // namespace

void add_smoke(const SmokeGrid& smoke, const LightGrid& grid, ThreadPool* pool,
               std::vector<float>& density) {
  const std::vector<Between> xs = between_texels(smoke, grid, 0),
                             ys = between_texels(smoke, grid, 1),
                             zs = between_texels(smoke, grid, 2);
  // Cells of 0.8 node spacings are the cells that the extinction is defined for.
  const float thickness = grid.cell / (smoke_spacings_per_cell * smoke.node_spacing);
  const std::size_t row = static_cast<std::size_t>(smoke.size.x),
                    slice = row * static_cast<std::size_t>(smoke.size.y);
  for_each_task(grid.size.z, pool, [&](int k) {
    const Between z = zs[static_cast<std::size_t>(k)];
    if (z.low < 0) return;
    for (int j = 0; j < grid.size.y; ++j) {
      const Between y = ys[static_cast<std::size_t>(j)];
      if (y.low < 0) continue;
      float* out =
          density.data() + (static_cast<std::ptrdiff_t>(k) * grid.size.y + j) * grid.size.x;
      const float* low = smoke.opacity.data() + smoke.index(0, y.low, z.low);
      for (std::size_t i = 0; i < xs.size(); ++i) {
        if (xs[i].low < 0) continue;
        const auto along_x = [&](const float* at) {
          return at[xs[i].low] * (1 - xs[i].part) + at[xs[i].low + 1] * xs[i].part;
        };
        const float near = along_x(low) * (1 - y.part) + along_x(low + row) * y.part;
        const float far = along_x(low + slice) * (1 - y.part) + along_x(low + slice + row) * y.part;
        out[i] = std::max(out[i], thickness * (near * (1 - z.part) + far * z.part));
      }
    }
  });
}

namespace {

/// Marks the cells of a grid that faces go through.
class FaceMarker {
 public:
  FaceMarker(const LightGrid& grid, std::vector<float>& solid) : grid_(grid), solid_(solid) {
    const Vec3f size{static_cast<float>(grid.size.x), static_cast<float>(grid.size.y),
                     static_cast<float>(grid.size.z)};
    low_ = grid.origin - grid.cell * Vec3f{1, 1, 1};
    high_ = grid.origin + grid.cell * (size + Vec3f{1, 1, 1});
  }

  void add(Vec3f a, Vec3f b, Vec3f c) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto [least, most] = std::minmax({a[axis], b[axis], c[axis]});
      // The negation also turns away NaN.
      if (!(least <= high_[axis] && most >= low_[axis])) return;
    }
    // Samples half a cell apart leave no holes.
    const float longest = std::max({length(b - a), length(c - a), length(c - b)});
    const float steps = std::max(2 * longest / grid_.cell + 1, 1.0f);
    if (steps <= max_steps) return add_samples(a, b, c, static_cast<int>(steps));
    if (!(steps < std::numeric_limits<float>::infinity())) return;
    const Vec3f ab = 0.5f * (a + b), bc = 0.5f * (b + c), ca = 0.5f * (c + a);
    add(a, ab, ca);
    add(ab, b, bc);
    add(ca, bc, c);
    add(ab, bc, ca);
  }

 private:
  static constexpr float max_steps = 1024;

  void add_samples(Vec3f a, Vec3f b, Vec3f c, int steps) {
    const auto all = static_cast<float>(steps);
    for (int i = 0; i <= steps; ++i) {
      const float u = static_cast<float>(i) / all;
      const Vec3f start = a + u * (b - a), along = c - a;
      // Most of a large face is outside of the grid.
      float first = 0, last = 1;
      for (int axis = 0; axis < 3; ++axis) {
        if (along[axis] == 0) continue;
        const float at_low = (low_[axis] - start[axis]) / along[axis];
        const float at_high = (high_[axis] - start[axis]) / along[axis];
        first = std::max(first, std::min(at_low, at_high));
        last = std::min(last, std::max(at_low, at_high));
      }
      if (!(first <= last)) continue;
      const int end = std::min(steps - i, static_cast<int>(last * all) + 2);
      for (int j = std::max(0, static_cast<int>(first * all) - 1); j <= end; ++j)
        mark(a + u * (b - a) + static_cast<float>(j) / all * (c - a));
    }
  }

  void mark(Vec3f p) {
    const Vec3f x = (p - grid_.origin) / grid_.cell;
    if (!(x.x >= 0 && x.y >= 0 && x.z >= 0 && x.x < static_cast<float>(grid_.size.x) &&
          x.y < static_cast<float>(grid_.size.y) && x.z < static_cast<float>(grid_.size.z)))
      return;
    const std::size_t row = static_cast<std::size_t>(x.z) * static_cast<std::size_t>(grid_.size.y) +
                            static_cast<std::size_t>(x.y);
    solid_[row * static_cast<std::size_t>(grid_.size.x) + static_cast<std::size_t>(x.x)] = 1;
  }

  const LightGrid& grid_;
  std::vector<float>& solid_;
  Vec3f low_, high_;  ///< a cell around the grid
};

}  // namespace

std::vector<float> voxelize(const std::vector<TriangleMesh>& meshes, const LightGrid& grid) {
  std::vector<float> solid(grid.count());
  FaceMarker marker(grid, solid);
  for (const TriangleMesh& mesh : meshes)
    for (std::size_t t = 0; t + 2 < mesh.index.size(); t += 3)
      marker.add(mesh.position[mesh.index[t]], mesh.position[mesh.index[t + 1]],
                 mesh.position[mesh.index[t + 2]]);
  return solid;
}

void blur(const LightGrid& grid, ThreadPool* pool, LightBuffers& buffers) {
  buffers.smooth.resize(buffers.density.size());
  buffers.blurred.resize(buffers.density.size());
  const std::vector<float>* from = &buffers.density;
  for (int pass = 0; pass < 6; ++pass) {
    std::vector<float>& to = pass % 2 == 0 ? buffers.blurred : buffers.smooth;
    const int tasks = std::min(8, grid.size.z);
    for_each_task(tasks, pool, [&](int t) {
      blur_axis(grid, pass % 3, *from, to, grid.size.z * t / tasks, grid.size.z * (t + 1) / tasks);
    });
    from = &to;
  }
}

}  // namespace neve::render::light
