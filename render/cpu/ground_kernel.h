#pragma once
/// Infinite planes with grid lines into a tile of the G-buffer, in lanes: shaders/ground.frag.

#include "render/cpu/lane_math.h"
#include "render/cpu/surface_job.h"
#include "render/light/shading_constants.h"

namespace neve::render::cpu {
namespace {

/// Share of a sample that the lines of one direction cover, from the number of lines that it spans.
template <class V>
NEVE_INLINE V line_cover(V at, V span, float line_width) {
  const V pixels = absolute_lanes(fraction_lanes(at - 0.5f) - 0.5f) / span;
  const V cover = unit_lanes(all<V>(0.5f * line_width + 0.5f) - pixels);
  const float first = light::line_veil_first, last = light::line_veil_last;
  const V t = unit_lanes((span - first) * (1 / (last - first)));
  return cover * (1 - t * t * (3 - 2 * t));
}

/// The same ray quantity at a sample and at the two that OpenGL takes derivatives with: its
/// partners in the square of 2x2.
template <class V>
struct Trio {
  V here, across, up;
};
/// @param at value at the sample @param dx, dy its steps to the next sample
/// @param sx, sy which way the partners are, 1 or -1
template <class V>
NEVE_INLINE Trio<V> trio_of(V at, float dx, float dy, V sx, float sy) {
  return {at, at + dx * sx, at + dy * sy};
}

template <class V>
NEVE_INLINE V line_share(const GroundJob& job, const Trio<V>& inverse, Vec3f base, V x, V sx,
                         float sy) {
  const float per_sample = 1 / job.view.pixels_per_slope;
  const auto on_grid = [&](Vec3f axis, float eye) NEVE_INLINE_BODY {
    const float dx = dot(job.view.right, axis) * per_sample,
                dy = dot(job.view.up, axis) * per_sample;
    const Trio<V> t = trio_of<V>(dot(base, axis) + x * dx, dx, dy, sx, sy);
    const float scale = 1 / job.line_spacing;
    const V at = t.here / inverse.here * scale;
    const V span = absolute_lanes(t.across / inverse.across * scale - at) +
                   absolute_lanes(t.up / inverse.up * scale - at);
    return line_cover(at + eye, larger_lanes(span, all<V>(1e-6f)), job.line_width);
  };
  return larger_lanes(on_grid(job.tangent, job.eye_on_grid[0]),
                      on_grid(job.bitangent, job.eye_on_grid[1]));
}

/// @param base ray through the middle of the picture's row, x samples right of it the lanes
template <class V>
NEVE_INLINE void ground_lanes(const GroundJob& job, light::GBufferTile& tile, int at, Vec3f base,
                              V x, float sy) {
  using I = MaskOf<V>;
  const float per_sample = 1 / job.view.pixels_per_slope;
  const float per_plane = 1 / dot(job.point, job.normal);
  const float dx = dot(job.view.right, job.normal) * per_sample * per_plane;
  const float dy = dot(job.view.up, job.normal) * per_sample * per_plane;
  const V inverse = all<V>(dot(base, job.normal) * per_plane) + x * dx;
  const V before = load_lanes<V>(tile.inverse + at);
  I is_seen = (inverse > before) & (inverse < all<V>(1 / job.view.near_distance));
  if (!any_lane(is_seen)) return;

  const V z = 1 / (is_seen ? inverse : all<V>(1));
  const Points3<V> ray = all_points<V>(base) + job.view.right * (x * per_sample);
  const Points3<V> from_center = ray * z + all_points<V>(-job.fade_center);
  const V left =
      rough_decay(square_of(from_center) * (1 / (job.fade_distance * job.fade_distance)));
  is_seen &= left >= all<V>(light::ground_min);
  if (!any_lane(is_seen)) return;

  I number{};
  for (int l = 0; l < lane_count<V>; ++l) number[l] = l;
  const V sx = (number & 1) == 0 ? all<V>(1) : all<V>(-1);
  const V line = line_share(job, trio_of(inverse, dx, dy, sx, sy), base, x, sx, sy);
  const V bright = square_root_lanes(1 + light::line_brightness * line);
  const I albedo = to_byte(job.root_color.x * bright) | to_byte(job.root_color.y * bright) << 8 |
                   to_byte(job.root_color.z * bright) << 16 | to_byte(left) << 24;
  const auto put = [&](float* to, V value) NEVE_INLINE_BODY {
    store_lanes(is_seen ? value : load_lanes<V>(to + at), to + at);
  };
  const auto put_words = [&](void* to, I value) NEVE_INLINE_BODY {
    put(static_cast<float*>(to), reinterpret_cast<V>(value));
  };
  put(tile.inverse, inverse);
  put(tile.normal_x, all<V>(job.normal.x));
  put(tile.normal_y, all<V>(job.normal.y));
  put(tile.normal_z, all<V>(job.normal.z));
  put_words(tile.kind, all<I>(job.kind));
  put_words(tile.albedo, albedo);
}

/// @param corner_x, corner_y lower left sample of the tile
template <class V>
NEVE_INLINE void ground_tile_lanes(const GroundJob& job, light::GBufferTile& tile, int corner_x,
                                   int corner_y) {
  const light::LaneView& view = job.view;
  for (int y = 0; y < light::tile_height; ++y) {
    const float up =
        static_cast<float>(corner_y + y) + 0.5f - 0.5f * static_cast<float>(view.height);
    const Vec3f base = view.forward + (up / view.pixels_per_slope) * view.up;
    const float sy = (y & 1) == 0 ? 1.0f : -1.0f;
    const float left = static_cast<float>(corner_x) - 0.5f * static_cast<float>(view.width);
    for (int x = 0; x < light::tile_width; x += lane_count<V>)
      ground_lanes<V>(job, tile, y * light::tile_width + x, base,
                      sample_centers<V>() + (left + static_cast<float>(x)), sy);
  }
}

// ---- what OpenGL has drawn ----------------------------------------------------------------------

/// Half floats in the lower 16 bits, normal or zero.
template <class V>
NEVE_INLINE V from_half(MaskOf<V> h) {
  const MaskOf<V> magnitude = (h & 0x7fff) << 13, sign = (h & 0x8000) << 16;
  const MaskOf<V> bits =
      magnitude < all<MaskOf<V>>(1 << 23) ? MaskOf<V>{} : magnitude + (112 << 23);
  return reinterpret_cast<V>(bits | sign);
}

/// Takes in the samples that are nearer than those of the tile.
template <class V>
NEVE_INLINE void solid_tile_lanes(const SolidJob& job, light::GBufferTile& tile) {
  using I = MaskOf<V>;
  for (int y = 0; y < job.rows; ++y) {
    for (int x = 0; x < job.columns; x += lane_count<V>) {
      const int at = y * light::tile_width + x;
      const long from = static_cast<long>(y) * job.pitch + x;
      const V depth = load_lanes<V>(job.depth + from);
      const V inverse = (1 - depth) * (1 / job.near_distance);
      const I is_nearer = inverse > load_lanes<V>(tile.inverse + at);
      if (!any_lane(is_nearer)) continue;
      for (int l = 0; l < lane_count<V>; ++l) {
        if (is_nearer[l] == 0 || x + l >= job.columns) continue;
        const unsigned short* half = job.normal_kind + 4 * (from + l);
        const Lanes<float, 4> words =
            from_half<Lanes<float, 4>>(Lanes<int, 4>{half[0], half[1], half[2], half[3]});
        tile.inverse[at + l] = inverse[l];
        tile.normal_x[at + l] = words[0];
        tile.normal_y[at + l] = words[1];
        tile.normal_z[at + l] = words[2];
        tile.kind[at + l] = static_cast<int>(words[3]);
        tile.albedo[at + l] = job.albedo[from + l];
      }
    }
  }
}

}  // namespace
}  // namespace neve::render::cpu
