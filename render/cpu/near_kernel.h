#pragma once
/// Finds the two grains nearest to each place, in lanes of grains: those of a cube and of the next
/// one along x lie side by side in memory.

#include "render/cpu/lane_math.h"
#include "render/cpu/near_job.h"

namespace neve::render::cpu {
namespace {

/// The nearest two of some grains, in each lane; among equals that of the lower number.
template <class V>
struct NearestTwo {
  V first, second;  ///< m2
  MaskOf<V> first_grain, second_grain;

  static NEVE_INLINE NearestTwo none() {
    const MaskOf<V> no = all<MaskOf<V>>(static_cast<int>(no_grain));
    return {all<V>(1e30f), all<V>(1e30f), no, no};
  }
  static NEVE_INLINE MaskOf<V> is_before(V a, MaskOf<V> grain_a, V b, MaskOf<V> grain_b) {
    return (a < b) | ((a == b) & (grain_a < grain_b));
  }
  NEVE_INLINE void take(V squared, MaskOf<V> grain) {
    const MaskOf<V> is_first = is_before(squared, grain, first, first_grain),
                    is_second = is_before(squared, grain, second, second_grain);
    second = is_first ? first : is_second ? squared : second;
    second_grain = is_first ? first_grain : is_second ? grain : second_grain;
    first = is_first ? squared : first;
    first_grain = is_first ? grain : first_grain;
  }
};

/// The nearest two of all lanes, as numbers whose order is that of the distances, then the grains.
struct FoundTwo {
  unsigned long long first, second;

  NEVE_INLINE void take(float squared, int grain) {
    const unsigned long long key =
        static_cast<unsigned long long>(__builtin_bit_cast(unsigned, squared)) << 32 |
        static_cast<unsigned>(grain);
    second = smaller(second, larger(first, key));
    first = smaller(first, key);
  }
};

template <class V>
NEVE_INLINE FoundTwo of_lanes(const NearestTwo<V>& in) {
  if constexpr (lane_count < V >> 4) {
    NearestTwo<decltype(half_of<0>(in.first))> low{half_of<0>(in.first), half_of<0>(in.second),
                                                   half_of<0>(in.first_grain),
                                                   half_of<0>(in.second_grain)};
    low.take(half_of<1>(in.first), half_of<1>(in.first_grain));
    low.take(half_of<1>(in.second), half_of<1>(in.second_grain));
    return of_lanes(low);
  } else {
    FoundTwo out{~0ull, ~0ull};
    for (int l = 0; l < 4; ++l) {
      out.take(in.first[l], in.first_grain[l]);
      out.take(in.second[l], in.second_grain[l]);
    }
    return out;
  }
}

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
    const I is_there = grain < static_cast<int>(end);
    nearest.take(is_there ? x * x + y * y + z * z : all<V>(1e30f),
                 is_there ? grain : all<I>(static_cast<int>(no_grain)));
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

template <class V>
NEVE_INLINE void find_nearest(const NearJob& job) {
  for (int n = 0; n < job.count; ++n) {
    auto nearest = NearestTwo<V>::none();
    const unsigned block = job.block[n];
    if (block != no_grain) {
      const V place[3] = {all<V>(job.world[0][n]), all<V>(job.world[1][n]),
                          all<V>(job.world[2][n])};
      const NearCubes x = near_cubes(job.node[0][n]), y = near_cubes(job.node[1][n]),
                      z = near_cubes(job.node[2][n]);
      const int low = smaller(x.own, x.next);
      const bool is_one_row = low >= 0 && low < cubes_per_side - 1;
      for (int row = 0; row < 4; ++row) {
        const int j = row & 1 ? y.next : y.own, k = row & 2 ? z.next : z.own;
        const unsigned cube = cube_number(job, block, low, j, k);
        if (cube != no_grain)
          take_grains(job, job.first[cube], job.first[cube + (is_one_row ? 2 : 1)], place, nearest);
        if (is_one_row) continue;
        const unsigned next = cube_number(job, block, low + 1, j, k);
        if (next != no_grain)
          take_grains(job, job.first[next], job.first[next + 1], place, nearest);
      }
    }
    const FoundTwo found = of_lanes(nearest);
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
