#pragma once
/// Marches the rays of a tile through a block of a field, in lanes of samples side by side.

#include "render/cpu/block_job.h"
#include "render/cpu/lane_math.h"

namespace neve::render::cpu {
namespace {

/// Rays in nodes: place = eye + step * distance.
template <class V>
struct BlockRays {
  Vec3f eye;
  Points3<V> step;
};

/// Value at a distance, linear between nodes; places are kept in the block.
template <class V>
NEVE_INLINE V block_value(const float* padded, const BlockRays<V>& rays, V distance) {
  using I = MaskOf<V>;
  const auto place = [&](float eye, V step, I& low) NEVE_INLINE_BODY {
    const V x = eye + step * distance;
    low = __builtin_convertvector(clamp_lanes(x, 0, 7), I);
    return x - __builtin_convertvector(low, V);
  };
  I i, j, k;
  const V x = place(rays.eye.x, rays.step.x, i), y = place(rays.eye.y, rays.step.y, j),
          z = place(rays.eye.z, rays.step.z, k);
  const I at = ((k + 1) * padded_side + (j + 1)) * padded_side + (i + 1);
  const auto row = [&](int offset) NEVE_INLINE_BODY {
    const V a = gather_lanes<V>(padded, at + offset),
            b = gather_lanes<V>(padded, at + (offset + 1));
    return a + (b - a) * x;
  };
  const auto slice = [&](int offset) NEVE_INLINE_BODY {
    const V a = row(offset), b = row(offset + padded_side);
    return a + (b - a) * y;
  };
  const V a = slice(0), b = slice(padded_side * padded_side);
  return a + (b - a) * z;
}

/// Distances before and behind the level, and the values there.
template <class V>
struct Bracket {
  V a, b, value_a, value_b;

  NEVE_INLINE V guess(float level) const {
    return a + (b - a) * ((level - value_a) / larger_lanes(value_b - value_a, all<V>(1e-12f)));
  }
};

/// @param lanes    those that enter
/// @param distance in: where they enter; out: of the level, where `lanes` are left
template <class V>
NEVE_INLINE void find_level(const BlockJob& job, const BlockRays<V>& rays, V leave, V& distance,
                            MaskOf<V>& lanes) {
  using I = MaskOf<V>;
  const V per_node = 1 / square_root_lanes(square_of(rays.step));
  V t = distance, value = block_value(job.padded, rays, t);
  I found = lanes & (value >= all<V>(job.level));
  Bracket<V> bracket{t, t, value, value};
  const I at_once = found;
  I marching = lanes & ~found;
  while (any_lane(marching)) {
    // The edge of a body rises by at most 0.4 a node, that of compressed snow by a little more.
    const V ahead = per_node * larger_lanes(2.0f * (job.level - value), all<V>(0.35f));
    const V next = smaller_lanes(t + ahead, leave);
    const V next_value = block_value(job.padded, rays, next);
    const I crosses = marching & (next_value >= all<V>(job.level));
    bracket = {crosses ? t : bracket.a, crosses ? next : bracket.b,
               crosses ? value : bracket.value_a, crosses ? next_value : bracket.value_b};
    found |= crosses;
    marching &= ~crosses & (next < leave);
    t = next;
    value = next_value;
  }
  lanes = found;
  if (!any_lane(found & ~at_once)) return;
  for (int n = 0; n < 2; ++n) {
    const V m = bracket.guess(job.level), v = block_value(job.padded, rays, m);
    const I is_behind = v >= all<V>(job.level);
    bracket = {is_behind ? bracket.a : m, is_behind ? m : bracket.b,
               is_behind ? bracket.value_a : v, is_behind ? v : bracket.value_b};
  }
  distance = at_once ? distance : bracket.guess(job.level);
}

template <class V>
NEVE_INLINE void block_lanes(const BlockJob& job, int at, const BlockRays<V>& rays,
                             MaskOf<V> lanes) {
  const V before = load_lanes<V>(job.hits->distance + at);
  const MaskOf<V> has_hit = before > V{};
  lanes &= ~has_hit | (before > all<V>(job.nearest));
  if (!any_lane(lanes)) return;
  V enter = all<V>(job.view.near_distance), leave = has_hit ? before : all<V>(1e30f);
  const auto cut = [&](float eye, V step, float low, float high) NEVE_INLINE_BODY {
    const V inverse = 1 / (step == V{} ? all<V>(1e-20f) : step);
    const V a = (low - eye) * inverse, b = (high - eye) * inverse;
    enter = larger_lanes(enter, smaller_lanes(a, b));
    leave = smaller_lanes(leave, larger_lanes(a, b));
  };
  cut(rays.eye.x, rays.step.x, job.box_low.x, job.box_high.x);
  cut(rays.eye.y, rays.step.y, job.box_low.y, job.box_high.y);
  cut(rays.eye.z, rays.step.z, job.box_low.z, job.box_high.z);
  lanes &= enter < leave;
  if (!any_lane(lanes)) return;
  V distance = enter;
  find_level(job, rays, leave, distance, lanes);
  if (!any_lane(lanes)) return;
  store_lanes(lanes ? distance : before, job.hits->distance + at);
  for (int l = 0; l < lane_count<V>; ++l)
    if (lanes[l] != 0) job.hits->block[at + l] = job.number;
}

/// Keeps the nearer of a hit in the block and the one before.
template <class V>
NEVE_INLINE void march_block_lanes(const BlockJob& job) {
  const light::LaneView& view = job.view;
  const float per_sample = 1 / view.pixels_per_slope;
  const float half_width = 0.5f * static_cast<float>(view.width),
              half_height = 0.5f * static_cast<float>(view.height);
  const int first = (job.x_low - job.x) / lane_count<V> * lane_count<V>;
  for (int y = job.y_low; y <= job.y_high; ++y) {
    const float up = (static_cast<float>(y) + 0.5f - half_height) * per_sample;
    const Vec3f base = view.forward + up * view.up;
    for (int x = first; x <= job.x_high - job.x; x += lane_count<V>) {
      const V column = sample_centers<V>() + static_cast<float>(job.x + x);
      const MaskOf<V> lanes = (column > all<V>(static_cast<float>(job.x_low))) &
                              (column < all<V>(static_cast<float>(job.x_high + 1)));
      const Points3<V> ray =
          all_points<V>(base) + view.right * ((column - half_width) * per_sample);
      block_lanes(job, (y - job.y) * light::tile_width + x,
                  BlockRays<V>{job.eye, ray * all<V>(job.per_cell)}, lanes);
    }
  }
}

}  // namespace
}  // namespace neve::render::cpu
