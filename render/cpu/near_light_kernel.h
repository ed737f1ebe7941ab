#pragma once
/// Light that snow within a few nodes leaves: what the cells of the light volume are too coarse
/// for. In lanes of nodes of a surface, or for one place.

#include "render/cpu/lane_math.h"
#include "render/cpu/near_light_job.h"

namespace neve::render::cpu {
namespace {

/// @tparam V  lanes of float, or float @param node  place in nodes from the corner of a block
template <class V>
NEVE_INLINE Points3<V> within_reach(const Points3<V>& node) {
  const auto keep = [](V x) NEVE_INLINE_BODY { return clamp_lanes(x, -6.5f, 13.5f); };
  return {keep(node.x), keep(node.y), keep(node.z)};
}

/// Thickness of the snow that shades a place. Starts where flat snow does not shade itself, however
/// low the sun.
/// @param share  of a place within reach
template <class V>
NEVE_INLINE V snow_before_sun(const auto& share, const Points3<V>& place, const Points3<V>& normal,
                              Vec3f toward) {
  const Points3<V> start = place + normal * all<V>(1.4f);
  V thickness{};
  for (int n = 0; n < 4; ++n) {
    const Vec3f way = toward * (0.7f + 1.15f * static_cast<float>(n));
    thickness += larger_lanes(V{}, share(within_reach(start + all_points<V>(way))) - 0.12f);
  }
  return thickness;
}

/// Thickness of the snow that the sun shines through on its way to a place.
template <class V>
NEVE_INLINE V snow_within(const auto& share, const Points3<V>& place, Vec3f toward) {
  const auto at = [&](float nodes) NEVE_INLINE_BODY {
    return share(within_reach(place + all_points<V>(toward * nodes)));
  };
  return at(0.7f) + 1.3f * at(1.9f) + 1.7f * at(3.4f) + 2.2f * at(5.4f);
}

/// Part of the sky that near snow leaves.
template <class V>
NEVE_INLINE V open_sky(const auto& share, const Points3<V>& place, const Points3<V>& normal) {
  // The bumps of flat snow are no crevices.
  const auto over = [&](float nodes) NEVE_INLINE_BODY {
    return larger_lanes(V{}, share(within_reach(place + normal * all<V>(nodes))) - 0.04f);
  };
  return 1 / (1 + 2.2f * over(2.0f) + 1.4f * over(4.0f));
}

/// Linear between nodes.
/// @param place  within reach
template <class V>
NEVE_INLINE V near_share(const float* near, const Points3<V>& place) {
  using I = MaskOf<V>;
  const I i = floor_lanes(place.x), j = floor_lanes(place.y), k = floor_lanes(place.z);
  const V x = place.x - __builtin_convertvector(i, V), y = place.y - __builtin_convertvector(j, V),
          z = place.z - __builtin_convertvector(k, V);
  const I index = ((k + near_margin) * near_side + j + near_margin) * near_side + i + near_margin;
  return value_in_cells(near, index, x, y, z, near_side, near_side * near_side);
}

template <class V>
NEVE_INLINE void light_near(const NearLightJob& job) {
  const auto share = [&](const Points3<V>& place)
                         NEVE_INLINE_BODY { return near_share<V>(job.near, place); };
  for (int at = 0; at < job.count; at += lane_count<V>) {
    const Points3<V> place = load_points<V>(job.place, at), normal = load_points<V>(job.normal, at);
    store_lanes(snow_before_sun(share, place, normal, job.toward), job.before_sun + at);
    store_lanes(snow_within(share, place, job.toward), job.within + at);
    store_lanes(open_sky(share, place, normal), job.open_sky + at);
  }
}

}  // namespace
}  // namespace neve::render::cpu
