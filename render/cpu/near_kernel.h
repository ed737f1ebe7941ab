#pragma once
/// Finds the two grains nearest to each place, in lanes of grains: those of a cube and of the next
/// one along x lie side by side in memory.

#include "render/cpu/lane_math.h"
#include "render/cpu/near_job.h"

namespace neve::render::cpu {
namespace {

/// Farther than all grains: what is not there.
constexpr float nowhere = 1e30f;

/// The nearest two of all, as numbers whose order is that of the distances, then the grains.
struct FoundTwo {
  unsigned long long first = key_of(nowhere, no_grain), second = first;

  static NEVE_INLINE unsigned long long key_of(float squared, unsigned grain) {
    return static_cast<unsigned long long>(__builtin_bit_cast(unsigned, squared)) << 32 | grain;
  }
  NEVE_INLINE void take(float squared, unsigned grain) {
    const unsigned long long key = key_of(squared, grain);
    second = smaller(second, larger(first, key));
    first = smaller(first, key);
  }
};

template <class V>
NEVE_INLINE float min_of(V v) {
  if constexpr (lane_count < V >> 4) {
    return min_of(smaller_lanes(half_of<0>(v), half_of<1>(v)));
  } else {
    v = smaller_lanes(v, __builtin_shufflevector(v, v, 2, 3, 0, 1));
    return smaller(v[0], v[1]);
  }
}

/// The nearest two of some grains, in each lane. The order of several that are equally near is not
/// sure: found() says so.
template <class V>
struct NearestTwo {
  using I = MaskOf<V>;
  V first = all<V>(nowhere), second = first;  ///< m2
  I first_grain{}, second_grain{}, tie{};

  NEVE_INLINE void take(V squared, I grain) {
    const I is_first = squared < first, is_second = squared < second;
    tie |= (squared == first) | (squared == second);
    second_grain = is_first ? first_grain : is_second ? grain : second_grain;
    second = smaller_lanes(second, larger_lanes(first, squared));
    first_grain = is_first ? grain : first_grain;
    first = smaller_lanes(first, squared);
  }

  /// Reduces the lanes to the two nearest grains. @return false if a nearer one may lie outside
  NEVE_INLINE bool found(FoundTwo& two) const {
    const float nearest = min_of(first);
    const I has_nearest = first == all<V>(nearest);
    const V rest = has_nearest ? second : first;
    const I rest_grain = has_nearest ? second_grain : first_grain;
    const float next = min_of(rest);
    const unsigned in = lane_bits(has_nearest), next_in = lane_bits(rest == all<V>(next));
    two.first = FoundTwo::key_of(nearest, static_cast<unsigned>(first_grain[__builtin_ctz(in)]));
    two.second = FoundTwo::key_of(next, static_cast<unsigned>(rest_grain[__builtin_ctz(next_in)]));
    return !any_lane(tie) && (in & (in - 1)) == 0 && (next_in & (next_in - 1)) == 0;
  }
};

/// Along one axis: the cube of a place, and the next one on its nearer side.
struct NearCubes {
  int own, next;
};
NEVE_INLINE NearCubes near_cubes(float node) {
  const int own = floor_to_int(0.5f * node);
  return {own, node - 2.0f * static_cast<float>(own) < 1 ? own - 1 : own + 1};
}

template <class V>
NEVE_INLINE void take_grains(const NearJob& job, unsigned first, unsigned end, const V (&place)[3],
                             NearestTwo<V>& nearest) {
  using I = MaskOf<V>;
  I lane{};
  for (int l = 0; l < lane_count<V>; ++l) lane[l] = l;
  for (unsigned p = first; p < end; p += lane_count<V>) {
    const V x = place[0] - load_lanes<V>(job.grain[0] + p),
            y = place[1] - load_lanes<V>(job.grain[1] + p),
            z = place[2] - load_lanes<V>(job.grain[2] + p);
    const I grain = lane + static_cast<int>(p);
    const V squared = x * x + y * y + z * z;
    nearest.take(grain < static_cast<int>(end) ? squared : all<V>(2 * nowhere), grain);
  }
}

/// One after the other: right where several are equally near, and where there are less than two.
NEVE_INLINE void take_each(const NearJob& job, unsigned first, unsigned end, Vec3f place,
                           FoundTwo& found) {
  for (unsigned p = first; p < end; ++p) {
    const float x = place.x - job.grain[0][p], y = place.y - job.grain[1][p],
                z = place.z - job.grain[2][p];
    found.take(x * x + y * y + z * z, p);
  }
}

/// Number of a cube by its place from the corner of a block, -4 to 7; no_grain: of no block.
NEVE_INLINE unsigned cube_number(const NearJob& job, unsigned block, int i, int j, int k) {
  const int side = ((k + 4) >> 2) * 9 + ((j + 4) >> 2) * 3 + ((i + 4) >> 2);
  const unsigned other = job.near[block][side];
  if (other == no_grain) return no_grain;
  return other * static_cast<unsigned>(cubes_per_block) +
         static_cast<unsigned>((k & 3) << 4 | (j & 3) << 2 | (i & 3));
}

/// use(first grain, end) for the cubes around a place, as far as they have grains.
NEVE_INLINE void for_near_grains(const NearJob& job, int n, const auto& use) {
  const unsigned block = job.block[n];
  if (block == no_grain) return;
  const NearCubes x = near_cubes(job.node[0][n]), y = near_cubes(job.node[1][n]),
                  z = near_cubes(job.node[2][n]);
  const int low = smaller(x.own, x.next);
  const bool is_one_row = low >= 0 && low < cubes_per_side - 1;
  for (int row = 0; row < 4; ++row) {
    const int j = row & 1 ? y.next : y.own, k = row & 2 ? z.next : z.own;
    const unsigned cube = cube_number(job, block, low, j, k);
    if (cube != no_grain) use(job.first[cube], job.first[cube + (is_one_row ? 2 : 1)]);
    if (is_one_row) continue;
    const unsigned next = cube_number(job, block, low + 1, j, k);
    if (next != no_grain) use(job.first[next], job.first[next + 1]);
  }
}

template <class V>
NEVE_INLINE void find_nearest(const NearJob& job) {
  for (int n = 0; n < job.count; ++n) {
    const Vec3f at{job.world[0][n], job.world[1][n], job.world[2][n]};
    const V place[3] = {all<V>(at.x), all<V>(at.y), all<V>(at.z)};
    NearestTwo<V> nearest;
    for_near_grains(job, n, [&](unsigned first, unsigned end) NEVE_INLINE_BODY {
      take_grains(job, first, end, place, nearest);
    });
    FoundTwo found;
    if (!nearest.found(found)) {
      found = {};
      for_near_grains(job, n, [&](unsigned first, unsigned end) NEVE_INLINE_BODY {
        take_each(job, first, end, at, found);
      });
    }
    const auto squared = [](unsigned long long key) NEVE_INLINE_BODY {
      return __builtin_bit_cast(float, static_cast<unsigned>(key >> 32));
    };
    job.nearest[n] = static_cast<unsigned>(found.first);
    job.second[n] = static_cast<unsigned>(found.second);
    job.nearest_squared[n] = squared(found.first);
    job.second_squared[n] = squared(found.second);
  }
}

}  // namespace
}  // namespace neve::render::cpu
