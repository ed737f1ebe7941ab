#pragma once
/// Colour, relief and facets of grains, in lanes of samples.

#include "render/cpu/grain_look_job.h"
#include "render/cpu/lane_math.h"
#include "sim/base/mix64.h"

namespace neve::render::cpu {
namespace {

template <class V>
NEVE_INLINE Points3<V> cross_lanes(const Points3<V>& a, const Points3<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A rotation for each lane; see Turn.
template <class V>
struct LaneTurns {
  V w;
  Points3<V> axis;

  NEVE_INLINE LaneTurns(MaskOf<V> low, MaskOf<V> high)
      : w(__builtin_convertvector(low << 16 >> 16, V) / 32767.0f),
        axis(Points3<V>{__builtin_convertvector(low >> 16, V),
                        __builtin_convertvector(high << 16 >> 16, V),
                        __builtin_convertvector(high >> 16, V)} *
             all<V>(1.0f / 32767)) {}
  NEVE_INLINE Points3<V> forth(const Points3<V>& v) const { return turned(v, v * w); }
  NEVE_INLINE Points3<V> back(const Points3<V>& v) const { return turned(v, v * -w); }

 private:
  NEVE_INLINE Points3<V> turned(const Points3<V>& v, const Points3<V>& along) const {
    return v + cross_lanes(axis, cross_lanes(axis, v) + along) * all<V>(2);
  }
};

/// The facet in the tiny cell of a grain that a place is in; one in a hundred mirrors the sun.
/// @param offset  of the place from the grain, in spacings, in the frame of the grain
template <class V>
NEVE_INLINE Points3<V> facets_of(MaskOf<V> seed, const Points3<V>& offset) {
  using I = MaskOf<V>;
  constexpr int lanes = lane_count<V>;
  const auto cell = [](V x) NEVE_INLINE_BODY { return floor_lanes(x * 6.0f) + 64; };
  const I low = seed << 24 ^ cell(offset.x) << 16 ^ cell(offset.y) << 8 ^ cell(offset.z),
          high = seed >> 8 & 0xffffff;
  I first{}, second{};
  for (int l = 0; l < lanes; ++l) {
    const __UINT64_TYPE__ random =
        mix64(static_cast<__UINT64_TYPE__>(static_cast<unsigned>(high[l])) << 32 |
              static_cast<unsigned>(low[l]));
    first[l] = static_cast<int>(random);
    second[l] = static_cast<int>(random >> 32);
  }
  const auto along = [](I bits) NEVE_INLINE_BODY {
    return __builtin_convertvector(bits & 0xffff, V) * (2.0f / 65535) - 1;
  };
  return normalized_lanes(Points3<V>{along(first), along(first >> 16), along(second)});
}

template <class V>
struct LaneRelief {
  V height;
  Points3<V> slope;  ///< per unit of place
};

/// @param place in units @param pixels samples per spacing
template <class V>
NEVE_INLINE LaneRelief<V> relief_at(const GrainLookJob& job, const Points3<V>& place, V pixels) {
  using I = MaskOf<V>;
  using Texel = Lanes<float, 4>;
  constexpr int lanes = lane_count<V>, mask = noise_side - 1;
  const Points3<V> p = place * all<V>(noise_texels_per_unit);
  const I i = floor_lanes(p.x), j = floor_lanes(p.y), k = floor_lanes(p.z);
  const V x = p.x - __builtin_convertvector(i, V), y = p.y - __builtin_convertvector(j, V),
          z = p.z - __builtin_convertvector(k, V);
  const I column[2] = {i & mask, (i + 1) & mask};
  const auto row = [&](int b, int c) NEVE_INLINE_BODY {
    return (((k + c) & mask) * noise_side + ((j + b) & mask)) * noise_side;
  };
  const I rows[4] = {row(0, 0), row(1, 0), row(0, 1), row(1, 1)};
  // Coarser where the finest octaves are smaller than a sample.
  const I level = -((pixels <= all<V>(7)) + (pixels <= all<V>(3.5f)));  // true is -1
  alignas(32) float sums[lanes][4];
  for (int l = 0; l < lanes; ++l) {
    const float* from = job.noise[level[l]];
    const auto texel = [&](int r, int c) NEVE_INLINE_BODY {
      Texel t;
      __builtin_memcpy(&t, from + 4 * (rows[r][l] + column[c][l]), sizeof t);
      return t;
    };
    const auto along_row = [&](int r) NEVE_INLINE_BODY {
      const Texel low = texel(r, 0), high = texel(r, 1);
      return low + (high - low) * x[l];
    };
    const auto slice = [&](int c) NEVE_INLINE_BODY {
      const Texel low = along_row(2 * c), high = along_row(2 * c + 1);
      return low + (high - low) * y[l];
    };
    const Texel low = slice(0), high = slice(1), sum = low + (high - low) * z[l];
    __builtin_memcpy(sums[l], &sum, sizeof sum);
  }
  V by_number[4];
  quads_by_number<V>(sums, by_number);
  return {by_number[0], {by_number[1], by_number[2], by_number[3]}};
}

template <class V>
NEVE_INLINE void look_at_grains(const GrainLookJob& job) {
  using I = MaskOf<V>;
  constexpr float units_per_spacing = 1.4f;
  const auto* words = reinterpret_cast<const unsigned*>(job.grains);
  constexpr int size = sizeof(Grain) / sizeof(unsigned);
  for (int at = 0; at < job.count; at += lane_count<V>) {
    I grain;
    __builtin_memcpy(&grain, job.grain + at, sizeof grain);
    grain *= size;
    const auto word = [&](int n) NEVE_INLINE_BODY { return gather_lanes(words + n, grain); };
    const auto number = [&](int n) NEVE_INLINE_BODY { return reinterpret_cast<V>(word(n)); };
    const V pixels = job.spacing / load_lanes<V>(job.sample_size + at);
    const I color = word(3), seed = word(4);
    const auto albedo = [&](int byte) NEVE_INLINE_BODY {
      const V root = byte_share<V>(color, byte);
      return root * root;
    };
    store_points(Points3<V>{albedo(0), albedo(1), albedo(2)}, job.albedo, at);
    const LaneTurns<V> turn(word(5), word(6));
    const Points3<V> from_grain =
        load_points<V>(job.world, at) + Points3<V>{-number(0), -number(1), -number(2)};
    const Points3<V> offset = turn.back(from_grain * all<V>(1 / job.spacing));
    if (job.wants_facets) {
      const I sparkles = pixels > all<V>(min_sparkling);
      const Points3<V> none{};
      store_points(any_lane(sparkles) ? choose(sparkles, facets_of<V>(seed, offset), none) : none,
                   job.facet, at);
    }
    const auto shift = [&](int byte) NEVE_INLINE_BODY {
      return __builtin_convertvector(seed >> (8 * byte) & 0xff, V) * (4.0f / 256);
    };
    const LaneRelief<V> relief = relief_at<V>(
        job, offset * all<V>(units_per_spacing) + Points3<V>{shift(0), shift(1), shift(2)}, pixels);
    const V factor = number(7);
    store_lanes(relief.height * factor, job.height + at);
    store_points(turn.forth(relief.slope) * (units_per_spacing * factor), job.slope, at);
  }
}

}  // namespace
}  // namespace neve::render::cpu
