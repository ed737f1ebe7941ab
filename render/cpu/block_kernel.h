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
  return value_in_cells(padded, ((k + 1) * padded_side + (j + 1)) * padded_side + (i + 1), x, y, z,
                        padded_side, padded_side * padded_side);
}

/// Distances before and behind the level, and the values there.
template <class V>
struct Bracket {
  V a, b, value_a, value_b;

  NEVE_INLINE V guess(float level) const {
    return a + (b - a) * ((level - value_a) / larger_lanes(value_b - value_a, all<V>(1e-12f)));
  }
};

/// Some rays on their way through the block. Each step waits for the one before: two searches side
/// by side take hardly longer than one.
template <class V>
class LevelSearch {
  using I = MaskOf<V>;

 public:
  /// @param at     first sample in the tile
  /// @param lanes  those that may see the block
  NEVE_INLINE LevelSearch(const BlockJob& job, int at, const BlockRays<V>& rays, I lanes)
      : job_(job), at_(at), rays_(rays), before_(load_lanes<V>(job.hits->distance + at)) {
    marching_ = lanes & ((before_ == V{}) | (before_ > all<V>(job.nearest)));
  }

  NEVE_INLINE bool is_marching() const { return any_lane(marching_); }

  /// Leaves out rays that miss the part of the block that has the level, or are hidden there.
  NEVE_INLINE void clip() {
    V enter = all<V>(job_.view.near_distance);
    leave_ = before_ > V{} ? before_ : all<V>(1e30f);
    const auto cut = [&](float eye, V step, float low, float high) NEVE_INLINE_BODY {
      const V inverse = 1 / (step == V{} ? all<V>(1e-20f) : step);
      const V a = (low - eye) * inverse, b = (high - eye) * inverse;
      enter = larger_lanes(enter, smaller_lanes(a, b));
      leave_ = smaller_lanes(leave_, larger_lanes(a, b));
    };
    cut(rays_.eye.x, rays_.step.x, job_.box_low.x, job_.box_high.x);
    cut(rays_.eye.y, rays_.step.y, job_.box_low.y, job_.box_high.y);
    cut(rays_.eye.z, rays_.step.z, job_.box_low.z, job_.box_high.z);
    marching_ &= enter < leave_;
    distance_ = enter;
  }

  /// Looks at the places where the rays enter.
  NEVE_INLINE void enter() {
    per_node_ = 1 / square_root_lanes(square_of(rays_.step));
    value_ = block_value(job_.padded, rays_, distance_);
    at_once_ = found_ = marching_ & (value_ >= all<V>(job_.level));
    bracket_ = {distance_, distance_, value_, value_};
    marching_ &= ~found_;
    t_ = distance_;
  }

  NEVE_INLINE void step() {
    // The edge of a body rises by at most 0.4 a node, that of compressed snow by a little more.
    const V ahead = per_node_ * larger_lanes(2.0f * (job_.level - value_), all<V>(0.35f));
    const V next = smaller_lanes(t_ + ahead, leave_);
    const V next_value = block_value(job_.padded, rays_, next);
    // The cells behind have no surface where the level lies on their face: rounding must not let a
    // ray pass just before it.
    constexpr float rounding = 1e-4f;
    const V level = next < leave_ ? all<V>(job_.level) : all<V>(job_.level - rounding);
    const I crosses = marching_ & (next_value >= level);
    bracket_ = {crosses ? t_ : bracket_.a, crosses ? next : bracket_.b,
                crosses ? value_ : bracket_.value_a,
                crosses ? larger_lanes(next_value, all<V>(job_.level)) : bracket_.value_b};
    found_ |= crosses;
    marching_ &= ~crosses & (next < leave_);
    t_ = next;
    value_ = next_value;
  }

  NEVE_INLINE bool has_crossed() const { return any_lane(found_ & ~at_once_); }

  NEVE_INLINE void refine() {
    const V m = bracket_.guess(job_.level), v = block_value(job_.padded, rays_, m);
    const I is_behind = v >= all<V>(job_.level);
    bracket_ = {is_behind ? bracket_.a : m, is_behind ? m : bracket_.b,
                is_behind ? bracket_.value_a : v, is_behind ? v : bracket_.value_b};
  }

  NEVE_INLINE void store() const {
    if (!any_lane(found_)) return;
    const V distance = at_once_ ? distance_ : bracket_.guess(job_.level);
    store_lanes(found_ ? distance : before_, job_.hits->distance + at_);
    for (int l = 0; l < lane_count<V>; ++l)
      if (found_[l] != 0) job_.hits->block[at_ + l] = job_.number;
  }

 private:
  const BlockJob& job_;
  const int at_;
  const BlockRays<V>& rays_;
  const V before_;
  V leave_, distance_, per_node_, t_, value_;
  I marching_, found_, at_once_;
  Bracket<V> bracket_;
};

/// Keeps the nearer of a hit in the block and the one before.
template <class V>
NEVE_INLINE void march_block_lanes(const BlockJob& job) {
  const light::LaneView& view = job.view;
  const float per_sample = 1 / view.pixels_per_slope;
  const float half_width = 0.5f * static_cast<float>(view.width),
              half_height = 0.5f * static_cast<float>(view.height);
  const int first = (job.x_low - job.x) / lane_count<V> * lane_count<V>;
  for (int y = job.y_low; y <= job.y_high; y += 2)
    for (int x = first; x <= job.x_high - job.x; x += lane_count<V>) {
      const V column = sample_centers<V>() + static_cast<float>(job.x + x);
      const MaskOf<V> lanes = (column > all<V>(static_cast<float>(job.x_low))) &
                              (column < all<V>(static_cast<float>(job.x_high + 1)));
      const auto rays_of = [&](int row) NEVE_INLINE_BODY {
        const float up = (static_cast<float>(row) + 0.5f - half_height) * per_sample;
        const Points3<V> ray = all_points<V>(view.forward + up * view.up) +
                               view.right * ((column - half_width) * per_sample);
        return BlockRays<V>{job.eye, ray * all<V>(job.per_cell)};
      };
      // A row beyond the last one is that row again, without lanes.
      const int next_y = y < job.y_high ? y + 1 : y;
      const BlockRays<V> rays = rays_of(y), next_rays = rays_of(next_y);
      LevelSearch<V> search(job, (y - job.y) * light::tile_width + x, rays, lanes),
          next(job, (next_y - job.y) * light::tile_width + x, next_rays,
               next_y > y ? lanes : MaskOf<V>{});
      if (!search.is_marching() && !next.is_marching()) continue;
      search.clip();
      next.clip();
      if (!search.is_marching() && !next.is_marching()) continue;
      search.enter();
      next.enter();
      while (search.is_marching() || next.is_marching()) {
        search.step();
        next.step();
      }
      if (search.has_crossed() || next.has_crossed())
        for (int n = 0; n < 2; ++n) {
          search.refine();
          next.refine();
        }
      search.store();
      next.store();
    }
}

}  // namespace
}  // namespace neve::render::cpu
