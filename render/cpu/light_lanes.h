#pragma once
/// A LightVolume read in lanes, with the linear interpolation that textures of OpenGL have.

#include "render/cpu/lane_math.h"
#include "render/light/light_job.h"
#include "render/light/shading_constants.h"

namespace neve::render::cpu {
namespace {

/// The eight cells around a place and their weights; beyond the edge as at the edge.
template <class V>
struct CellsAround {
  MaskOf<V> corner;  ///< index of the lowest
  int step_x, step_y, step_z;
  V x, y, z;  ///< part of the way to the next
};

template <class V>
NEVE_INLINE CellsAround<V> cells_around(const light::LightCells& cells, const Points3<V>& p) {
  const float per_cell = 1 / cells.cell;
  const auto place = [&](V at, float origin, int count, MaskOf<V>& low) NEVE_INLINE_BODY {
    const V x = clamp_lanes((at - origin) * per_cell - 0.5f, 0, static_cast<float>(count - 1));
    low = __builtin_convertvector(x, MaskOf<V>);
    low = low > count - 2 ? all<MaskOf<V>>(larger(count - 2, 0)) : low;
    return x - __builtin_convertvector(low, V);
  };
  MaskOf<V> i, j, k;
  CellsAround<V> out;
  out.x = place(p.x, cells.origin.x, cells.count.x, i);
  out.y = place(p.y, cells.origin.y, cells.count.y, j);
  out.z = place(p.z, cells.origin.z, cells.count.z, k);
  out.corner = (k * cells.count.y + j) * cells.count.x + i;
  out.step_x = cells.count.x > 1 ? 1 : 0;
  out.step_y = cells.count.y > 1 ? cells.count.x : 0;
  out.step_z = cells.count.z > 1 ? cells.count.x * cells.count.y : 0;
  return out;
}

/// Calls take(word, weight) for each of the eight cells.
template <class V, class Take>
NEVE_INLINE void for_each_cell(const CellsAround<V>& at, const unsigned* words, const Take& take) {
  for (int n = 0; n < 4; ++n) {
    const V w = ((n & 1) ? at.y : 1 - at.y) * ((n & 2) ? at.z : 1 - at.z);
    const MaskOf<V> row = at.corner + ((n & 1) * at.step_y + (n >> 1) * at.step_z);
    take(gather_lanes(words, row), w * (1 - at.x));
    take(gather_lanes(words, row + at.step_x), w * at.x);
  }
}

template <class V>
NEVE_INLINE MaskOf<V> is_in_box(const light::LightCells& cells, const Points3<V>& p) {
  const auto is_between = [&](V x, float low, int count) NEVE_INLINE_BODY {
    return (x > all<V>(low)) & (x < all<V>(low + static_cast<float>(count) * cells.cell));
  };
  return is_between(p.x, cells.origin.x, cells.count.x) &
         is_between(p.y, cells.origin.y, cells.count.y) &
         is_between(p.z, cells.origin.z, cells.count.z);
}

/// Outward normal of the body times its certainty, zero in other lanes.
template <class V>
NEVE_INLINE Points3<V> body_lanes(const light::LightCells& cells, const Points3<V>& p,
                                  MaskOf<V> lanes) {
  Points3<V> sum{};
  if (!any_lane(lanes)) return sum;
  const CellsAround<V> at = cells_around(cells, choose(lanes, p, all_points<V>(cells.origin)));
  for_each_cell(at, cells.body, [&](MaskOf<V> word, V weight) NEVE_INLINE_BODY {
    sum.x += weight * __builtin_convertvector(word << 24 >> 24, V);
    sum.y += weight * __builtin_convertvector(word << 16 >> 24, V);
    sum.z += weight * __builtin_convertvector(word << 8 >> 24, V);
  });
  return choose(lanes, sum * all<V>(1.0f / 127), Points3<V>{});
}

/// Key light at p. Outside the box the ray towards the light is followed to where it enters.
template <class V>
NEVE_INLINE V key_lanes(const light::LightCells& cells, Vec3f toward_light, Points3<V> p,
                        MaskOf<V> lanes) {
  using I = MaskOf<V>;
  I is_shaded = lanes;
  const I is_outside = lanes & ~is_in_box(cells, p);
  if (any_lane(is_outside)) {
    V enter = all<V>(-1e30f), leave = all<V>(1e30f);
    const auto cut = [&](V x, float direction, float low, int count) NEVE_INLINE_BODY {
      const float inverse = 1 / (direction == 0 ? 1e-7f : direction);
      const V a = (low - x) * inverse,
              b = (low + static_cast<float>(count) * cells.cell - x) * inverse;
      enter = larger_lanes(enter, smaller_lanes(a, b));
      leave = smaller_lanes(leave, larger_lanes(a, b));
    };
    cut(p.x, toward_light.x, cells.origin.x, cells.count.x);
    cut(p.y, toward_light.y, cells.origin.y, cells.count.y);
    cut(p.z, toward_light.z, cells.origin.z, cells.count.z);
    is_shaded &= ~is_outside | ((enter >= V{}) & (enter <= leave));
    p = choose(is_outside, p + toward_light * (enter + light::entry_offset * cells.cell), p);
  }
  if (!any_lane(is_shaded)) return all<V>(1);
  V sum{};
  const CellsAround<V> at = cells_around(cells, choose(is_shaded, p, all_points<V>(cells.origin)));
  for_each_cell(at, cells.light, [&](I word, V weight) NEVE_INLINE_BODY {
    sum += weight * __builtin_convertvector(word & 0xffff, V);
  });
  return is_shaded ? sum * (1.0f / 65535) : all<V>(1);
}

/// Sky at p, fading to all of it over the outermost cells of the box.
template <class V>
NEVE_INLINE V sky_lanes(const light::LightCells& cells, const Points3<V>& p, MaskOf<V> lanes) {
  using I = MaskOf<V>;
  const float per_cell = 1 / cells.cell;
  const auto inside = [&](V x, float low, int count) NEVE_INLINE_BODY {
    const V from_low = (x - low) * per_cell;
    return smaller_lanes(from_low, static_cast<float>(count) - from_low);
  };
  const V nearest = smaller_lanes(smaller_lanes(inside(p.x, cells.origin.x, cells.count.x),
                                                inside(p.y, cells.origin.y, cells.count.y)),
                                  inside(p.z, cells.origin.z, cells.count.z));
  const V weight = lanes ? unit_lanes(nearest * (1 / light::sky_fade_cells)) : V{};
  const I is_near = weight > V{};
  if (!any_lane(is_near)) return all<V>(1);
  V sum{};
  const CellsAround<V> at = cells_around(cells, choose(is_near, p, all_points<V>(cells.origin)));
  for_each_cell(at, cells.light, [&](I word, V part) NEVE_INLINE_BODY {
    sum += part * __builtin_convertvector(word >> 16 & 0xffff, V);
  });
  return mix_lanes(all<V>(1), sum * (1.0f / 65535), weight);
}

}  // namespace
}  // namespace neve::render::cpu
