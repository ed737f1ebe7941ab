#pragma once
/// The sphere splatter in lanes. Included by one file per instruction set; everything is in an
/// unnamed namespace, includes no standard header, and rounds every operation on its own, so that
/// all instruction sets give the same bits.
///
/// The ray of slope s = c + d hits the sphere whose centre appears at slope c, at distance z along
/// the view and with radius r = ratio z. With q = (c.x, c.y, 1), Q = |q|^2, ray = q + (d.x, d.y,
/// 0), L = |ray|^2, num = q . ray, and the chord's discriminant
///   D = ratio^2 L - |d|^2 - (c x d)^2
/// the first hit lies at z (num - sqrt D) / L along the view. As num^2 - D = L (Q - ratio^2), the
/// inverse of that is (num + sqrt D) / (z (Q - ratio^2)): one root and no division per sample. In d
/// nothing large cancels, however small the sphere is against its distance.

#include "render/cpu/lane_math.h"
#include "render/cpu/splat_job.h"

namespace neve::render::cpu {
namespace {

// ---- projection ---------------------------------------------------------------------------------

/// First and last sample along one axis whose centre lies within the sphere's outline.
template <class V>
struct Extent {
  MaskOf<V> low, high;
};

/// The planes through the eye that touch the sphere have slopes (c -+ ratio sqrt(c^2 + t)) / t with
/// t = 1 - ratio^2; a sphere that reaches the plane of the eye may be anywhere.
template <class V>
NEVE_INLINE Extent<V> extent_of(V slope, V ratio, float pixels_per_slope, int size) {
  const V t = all<V>(1) - ratio * ratio;
  const MaskOf<V> is_bounded = t > all<V>(2e-3f);
  const V safe = is_bounded ? t : all<V>(1);
  const V reach = ratio * square_root_lanes(slope * slope + safe);
  const float half = 0.5f * static_cast<float>(size), end = static_cast<float>(size);
  // A hundredth of a sample is more than rounding moves an outline.
  const V low = all<V>(half - 0.51f) + pixels_per_slope * ((slope - reach) / safe);
  const V high = all<V>(half - 0.49f) + pixels_per_slope * ((slope + reach) / safe);
  const V first = is_bounded ? clamp_lanes(low, -1, end) : all<V>(-1);
  const V last = is_bounded ? clamp_lanes(high, -1, end - 1) : all<V>(end - 1);
  return {floor_lanes(first) + 1, floor_lanes(last)};
}

template <class V>
NEVE_INLINE Points3<V> load_points(const ProjectJob& job, int first, int count) {
  Points3<V> p{};
  for (int l = 0; l < lane_count<V>; ++l) {
    const int disc = first + (l < count ? l : 0);
    const Vec3f& at = job.position[job.order ? static_cast<int>(job.order[disc]) : disc];
    p.x[l] = at.x - job.view.eye.x;
    p.y[l] = at.y - job.view.eye.y;
    p.z[l] = at.z - job.view.eye.z;
  }
  return p;
}

template <class V>
NEVE_INLINE void project_lanes(const ProjectJob& job, int first, int count) {
  using I = MaskOf<V>;
  const SplatView& view = job.view;
  const Points3<V> p = load_points<V>(job, first, count);
  const V z = along(p, view.forward);
  const V inverse = all<V>(1) / z;
  const V slope_x = along(p, view.right) * inverse, slope_y = along(p, view.up) * inverse;
  const V ratio = larger_lanes(view.radius * inverse, all<V>(view.min_ratio));
  const V Q = all<V>(1) + slope_x * slope_x + slope_y * slope_y;
  const V outside = Q - ratio * ratio;

  // Comparisons also turn away NaN. A sphere around the eye is left out.
  const V distance2 = p.x * p.x + p.y * p.y + p.z * p.z;
  I is_seen = (z > all<V>(view.near_distance)) & (z < all<V>(1e30f)) & (Q < all<V>(1e30f)) &
              (distance2 >= all<V>(1.1f * view.radius * view.radius)) & (outside > all<V>(0));
  const Extent<V> across = extent_of(slope_x, ratio, view.pixels_per_slope, view.width);
  const Extent<V> upward = extent_of(slope_y, ratio, view.pixels_per_slope, view.height);
  is_seen &= (across.low <= across.high) & (upward.low <= upward.high);

  const V x = all<V>(0.5f * static_cast<float>(view.width)) + view.pixels_per_slope * slope_x;
  const V y = all<V>(0.5f * static_cast<float>(view.height)) + view.pixels_per_slope * slope_y;
  const V scale = inverse / outside;
  // Rounded up, so that nothing is taken for hidden that is not.
  const V left = all<V>(1) - ratio;
  const V nearest = left > all<V>(1e-3f) ? 1.00001f * inverse / left : all<V>(__builtin_inff());
  for (int l = 0; l < lane_count<V>; ++l) {
    if (l >= count) break;
    SplatDisc& disc = job.discs[first + l];
    if (is_seen[l] == 0) {
      disc.x_low = 1;
      disc.x_high = 0;
      continue;
    }
    disc.x = x[l];
    disc.y = y[l];
    disc.ratio = ratio[l];
    disc.scale = scale[l];
    disc.nearest = nearest[l];
    disc.x_low = static_cast<unsigned short>(across.low[l]);
    disc.x_high = static_cast<unsigned short>(across.high[l]);
    disc.y_low = static_cast<unsigned short>(upward.low[l]);
    disc.y_high = static_cast<unsigned short>(upward.high[l]);
  }
}

template <class V>
NEVE_INLINE void project_discs(const ProjectJob& job) {
  for (int i = job.begin; i < job.end; i += lane_count<V>)
    project_lanes<V>(job, i, smaller(lane_count<V>, job.end - i));
}

// ---- drawing a tile -----------------------------------------------------------------------------

constexpr int block_side = 8;
constexpr int blocks_across = light::tile_width / block_side;
constexpr int block_count = blocks_across * (light::tile_height / block_side);
static_assert(block_count <= 32, "one bit each");

/// The nearest surface so far, and for each block of samples a bound behind which all is hidden.
struct Tile {
  float* inverse;              ///< 1/m along the view; 0: none
  int* disc;                   ///< -1: none
  float covered[block_count];  ///< 1/m: every sample of the block has this much or more
  unsigned stale;              ///< blocks drawn to since `covered` was found
};

struct Span {
  int x0, x1, y0, y1;  ///< samples of the tile, ends included
};

/// Smallest inverse distance of a block.
template <class V>
NEVE_INLINE float min_of_block(const Tile& tile, int block) {
  const float* row = tile.inverse + block / blocks_across * block_side * light::tile_width +
                     block % blocks_across * block_side;
  V least = load_lanes<V>(row);
  for (int y = 0; y < block_side; ++y, row += light::tile_width)
    for (int x = 0; x < block_side; x += lane_count<V>)
      least = smaller_lanes(least, load_lanes<V>(row + x));
  return smallest_lane(least);
}

/// True if nothing nearer than `nearest` is visible within the span.
template <class V>
NEVE_INLINE bool is_hidden(Tile& tile, const Span& span, float nearest) {
  for (int by = span.y0 / block_side; by <= span.y1 / block_side; ++by) {
    for (int bx = span.x0 / block_side; bx <= span.x1 / block_side; ++bx) {
      const int block = by * blocks_across + bx;
      if (tile.covered[block] >= nearest) continue;
      if ((tile.stale >> block & 1u) == 0) return false;
      tile.stale &= ~(1u << block);
      tile.covered[block] = min_of_block<V>(tile, block);
      if (tile.covered[block] < nearest) return false;
    }
  }
  return true;
}

NEVE_INLINE unsigned blocks_of(const Span& span) {
  unsigned bits = 0;
  for (int by = span.y0 / block_side; by <= span.y1 / block_side; ++by)
    for (int bx = span.x0 / block_side; bx <= span.x1 / block_side; ++bx)
      bits |= 1u << (by * blocks_across + bx);
  return bits;
}

template <class V>
NEVE_INLINE void draw_disc(const TileJob& job, Tile& tile, const Span& span, int index) {
  using I = MaskOf<V>;
  const SplatDisc& disc = job.discs[index];
  const float per_sample = 1 / job.view.pixels_per_slope;
  const float cx = (disc.x - 0.5f * static_cast<float>(job.view.width)) * per_sample;
  const float cy = (disc.y - 0.5f * static_cast<float>(job.view.height)) * per_sample;
  const float Q = 1 + cx * cx + cy * cy, ratio2 = disc.ratio * disc.ratio;
  const V scale = all<V>(disc.scale), a2 = all<V>(ratio2 - 1 - cy * cy);
  const V slope_x = all<V>(cx), id_bits = reinterpret_cast<V>(all<I>(index));
  const V centers = sample_centers<V>();
  const int first = span.x0 / lane_count<V> * lane_count<V>;
  const float left = static_cast<float>(job.x) - disc.x;
  for (int y = span.y0; y <= span.y1; ++y) {
    const float dy = (static_cast<float>(job.y + y) + 0.5f - disc.y) * per_sample;
    // D = (a2 dx + a1) dx + a0 and num = n0 + c.x dx along the row.
    const V a1 = all<V>(2 * cx * (ratio2 + cy * dy));
    const V a0 = all<V>(ratio2 * (Q + 2 * dy * cy + dy * dy) - dy * dy - cx * cx * (dy * dy));
    const V n0 = all<V>(Q + cy * dy);
    float* inverse = tile.inverse + y * light::tile_width;
    int* owner = tile.disc + y * light::tile_width;
    for (int x = first; x <= span.x1; x += lane_count<V>) {
      const V dx = (centers + (static_cast<float>(x) + left)) * per_sample;
      const V D = (a2 * dx + a1) * dx + a0;
      const V root = square_root_lanes(larger_lanes(D, V{}));
      const V hit = (n0 + slope_x * dx + root) * scale;
      const V before = load_lanes<V>(inverse + x);
      const I is_nearer = (D > V{}) & (hit > before);
      if (!any_lane(is_nearer)) continue;
      store_lanes(is_nearer ? hit : before, inverse + x);
      float* ids = reinterpret_cast<float*>(owner + x);
      store_lanes(is_nearer ? id_bits : load_lanes<V>(ids), ids);
    }
  }
}

/// Discs of the lanes, as far as normals need them.
template <class V>
struct Discs {
  V x, y, ratio;
  MaskOf<V> color;
};

template <class V>
NEVE_INLINE Discs<V> gather_discs(const TileJob& job, const int* owner) {
  Discs<V> d{};
  d.ratio = all<V>(1);
  for (int l = 0; l < lane_count<V>; ++l) {
    if (owner[l] < 0) continue;
    const SplatDisc& disc = job.discs[owner[l]];
    d.x[l] = disc.x;
    d.y[l] = disc.y;
    d.ratio[l] = disc.ratio;
    d.color[l] = static_cast<int>(disc.color);
  }
  return d;
}

/// Unit normals where the rays of the lanes hit, in the axes of the view: the hit is
/// z/L (d num - q (q . d + |d|^2) - ray sqrt D) away from the centre.
template <class V>
NEVE_INLINE Points3<V> normals_of(const SplatView& view, const Discs<V>& disc, V x, float y) {
  const float per_sample = 1 / view.pixels_per_slope;
  const V cx = (disc.x - 0.5f * static_cast<float>(view.width)) * per_sample;
  const V cy = (disc.y - 0.5f * static_cast<float>(view.height)) * per_sample;
  const V dx = (x - disc.x) * per_sample, dy = (all<V>(y) - disc.y) * per_sample;
  const V Q = all<V>(1) + cx * cx + cy * cy, g = cx * dx + cy * dy, d2 = dx * dx + dy * dy;
  const V L = Q + 2 * g + d2, cross = cx * dy - cy * dx;
  const V D = disc.ratio * disc.ratio * L - d2 - cross * cross;
  const V root = square_root_lanes(larger_lanes(D, V{})), num = Q + g, back = g + d2;
  const V part = all<V>(1) / (disc.ratio * L);
  return {part * (dx * num - cx * back - (cx + dx) * root),
          part * (dy * num - cy * back - (cy + dy) * root), part * (-back - root)};
}

/// Turns the disc that each sample of a lane shows into its visible surface.
template <class V>
NEVE_INLINE void finish_samples(const TileJob& job, int x, int y) {
  using I = MaskOf<V>;
  light::GBufferTile& out = *job.out;
  const int at = y * light::tile_width + x;
  const I is_hit = load_lanes<V>(out.inverse + at) > V{};
  I kind{}, color{};
  if (any_lane(is_hit)) {
    const Discs<V> disc = gather_discs<V>(job, out.kind + at);
    const V px = sample_centers<V>() + static_cast<float>(job.x + x);
    const Points3<V> n = normals_of(job.view, disc, px, static_cast<float>(job.y + y) + 0.5f);
    const auto axis = [&](float Vec3f::*m) NEVE_INLINE_BODY {
      return n.x * (job.view.right.*m) + n.y * (job.view.up.*m) + n.z * (job.view.forward.*m);
    };
    store_lanes(axis(&Vec3f::x), out.normal_x + at);
    store_lanes(axis(&Vec3f::y), out.normal_y + at);
    store_lanes(axis(&Vec3f::z), out.normal_z + at);
    kind = is_hit & job.kind;
    color = is_hit & disc.color;
  }
  __builtin_memcpy(out.kind + at, &kind, sizeof kind);
  __builtin_memcpy(out.albedo + at, &color, sizeof color);
}

template <class V>
NEVE_INLINE void draw_tile_lanes(const TileJob& job) {
  Tile tile;
  tile.inverse = job.out->inverse;
  tile.disc = job.out->kind;
  __builtin_memset(job.out->inverse, 0, sizeof job.out->inverse);
  __builtin_memset(job.out->kind, job.count > 0 ? 0xff : 0, sizeof job.out->kind);
  if (job.count == 0) return;
  __builtin_memset(tile.covered, 0, sizeof tile.covered);
  tile.stale = 0;
  for (int k = 0; k < job.count; ++k) {
    const SplatDisc& disc = job.discs[job.list[k]];
    const Span span = {
        larger(disc.x_low - job.x, 0), smaller(disc.x_high - job.x, light::tile_width - 1),
        larger(disc.y_low - job.y, 0), smaller(disc.y_high - job.y, light::tile_height - 1)};
    if (is_hidden<V>(tile, span, disc.nearest)) continue;
    draw_disc<V>(job, tile, span, job.list[k]);
    tile.stale |= blocks_of(span);
  }
  for (int y = 0; y < light::tile_height; ++y)
    for (int x = 0; x < light::tile_width; x += lane_count<V>) finish_samples<V>(job, x, y);
}

}  // namespace
}  // namespace neve::render::cpu
