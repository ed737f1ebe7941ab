#pragma once
/// Arithmetic of the drawing kernels in lanes: vectors, powers, colours. Includes no standard
/// header and rounds every operation on its own, so that all instruction sets give the same bits.

#include "sim/base/lanes.h"
#include "sim/base/vec.h"

namespace neve::render::cpu {
namespace {

template <class V>
struct Points3 {
  V x, y, z;
};
template <class V>
NEVE_INLINE Points3<V> operator+(Points3<V> a, Points3<V> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
NEVE_INLINE Points3<V> operator*(Points3<V> a, V s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class V>
NEVE_INLINE Points3<V> operator*(Points3<V> a, Points3<V> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class V>
NEVE_INLINE Points3<V> operator*(Vec3f a, V s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class V>
NEVE_INLINE Points3<V> all_points(Vec3f a) {
  return {all<V>(a.x), all<V>(a.y), all<V>(a.z)};
}
template <class V>
NEVE_INLINE V along(const Points3<V>& p, Vec3f axis) {
  return p.x * axis.x + p.y * axis.y + p.z * axis.z;
}
template <class V>
NEVE_INLINE V square_of(const Points3<V>& p) {
  return p.x * p.x + p.y * p.y + p.z * p.z;
}
template <class V>
NEVE_INLINE Points3<V> choose(MaskOf<V> first, const Points3<V>& a, const Points3<V>& b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

template <class V>
NEVE_INLINE Points3<V> load_points(const float* const (&from)[3], int at) {
  return {load_lanes<V>(from[0] + at), load_lanes<V>(from[1] + at), load_lanes<V>(from[2] + at)};
}
template <class V>
NEVE_INLINE V inner(const Points3<V>& a, const Points3<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// Unit vectors; zero stays zero.
template <class V>
NEVE_INLINE Points3<V> normalized_lanes(const Points3<V>& p) {
  const V size = square_root_lanes(square_of(p));
  const V by = size > V{} ? size : all<V>(1);
  return {p.x / by, p.y / by, p.z / by};
}
template <class V>
NEVE_INLINE void store_points(const Points3<V>& p, float* const (&to)[3], int at) {
  store_lanes(p.x, to[0] + at);
  store_lanes(p.y, to[1] + at);
  store_lanes(p.z, to[2] + at);
}

/// Clamps lanes to [low, high]; NaN becomes low.
template <class V>
NEVE_INLINE V clamp_lanes(V x, float low, float high) {
  const V raised = x > all<V>(low) ? x : all<V>(low);
  return smaller_lanes(raised, all<V>(high));
}
template <class V>
NEVE_INLINE V unit_lanes(V x) {
  return clamp_lanes(x, 0, 1);
}
/// a where t is 0, b where t is 1.
template <class V>
NEVE_INLINE V mix_lanes(V a, V b, V t) {
  return a * (1 - t) + b * t;
}

/// Largest integers <= x, |x| < 2^23.
template <class V>
NEVE_INLINE MaskOf<V> floor_lanes(V x) {
  const MaskOf<V> i = __builtin_convertvector(x, MaskOf<V>);  // towards zero
  return i + (__builtin_convertvector(i, V) > x);             // true is -1
}
/// x - floor(x), |x| < 2^23.
template <class V>
NEVE_INLINE V fraction_lanes(V x) {
  return x - __builtin_convertvector(floor_lanes(x), V);
}

/// 0.5, 1.5, 2.5 ...: centres of samples side by side.
template <class V>
NEVE_INLINE V sample_centers() {
  V v{};
  for (int l = 0; l < lane_count<V>; ++l) v[l] = static_cast<float>(l) + 0.5f;
  return v;
}

/// log2 x for x > 0 and normal, error below 4e-6: with m = x / 2^n around 1, the series of
/// 2 atanh((m - 1) / (m + 1)) up to the fifth power.
template <class V>
NEVE_INLINE V rough_log2(V x) {
  using I = MaskOf<V>;
  const I bits = reinterpret_cast<I>(x);
  // Exponents are relative to sqrt(1/2), so that m is from there to sqrt(2).
  const I n = (bits - 0x3f3504f3) >> 23;
  const V m = reinterpret_cast<V>(bits - (n << 23));
  const V z = (m - 1) / (m + 1), z2 = z * z;
  const V series = 2.8853901f + z2 * (0.96179669f + z2 * 0.57707802f);
  return __builtin_convertvector(n, V) + z * series;
}

/// 2^x, relative error below 4e-6; x from -126 to 126.
template <class V>
NEVE_INLINE V rough_exp2(V x) {
  using I = MaskOf<V>;
  const V shift = all<V>(12582912.0f);  // pushes the fraction out of the mantissa
  const V shifted = x + shift, f = x - (shifted - shift);
  const V p =
      1 + f * (0.69314718f +
               f * (0.24022651f + f * (0.055504109f + f * (0.0096181291f + f * 0.0013333558f))));
  const I n = reinterpret_cast<I>(shifted) - reinterpret_cast<I>(shift);
  return p * reinterpret_cast<V>((n + 127) << 23);
}

/// x^e for 0 <= x <= 1e30 and 0 < e <= 1, relative error below 1e-5.
template <class V>
NEVE_INLINE V rough_power(V x, V e) {
  return rough_exp2(e * rough_log2(larger_lanes(x, all<V>(1e-30f))));
}
/// e^-x for x >= 0, relative error below 1e-5 until it is next to nothing.
template <class V>
NEVE_INLINE V rough_decay(V x) {
  return rough_exp2(larger_lanes(-1.4426950f * x, all<V>(-126)));
}

/// One word per lane, from[index].
template <class I>
NEVE_INLINE I gather_lanes(const unsigned* from, I index) {
#if defined(__AVX2__)
  if constexpr (sizeof(I) == 32)
    return reinterpret_cast<I>(_mm256_i32gather_epi32(reinterpret_cast<const int*>(from),
                                                      reinterpret_cast<__m256i>(index), 4));
#endif
  I out{};
  for (int l = 0; l < lane_count<I>; ++l) out[l] = static_cast<int>(from[index[l]]);
  return out;
}
template <class V>
NEVE_INLINE V gather_lanes(const float* from, MaskOf<V> index) {
  return reinterpret_cast<V>(gather_lanes(reinterpret_cast<const unsigned*>(from), index));
}

/// Two numbers side by side for each lane, from[index] and the next: half as many reads as of
/// one at a time.
template <class V>
NEVE_INLINE void gather_pairs(const float* from, const unsigned (&index)[lane_count<V>], V& first,
                              V& second) {
#if defined(__AVX2__)
  if constexpr (sizeof(V) == 32) {
    const auto two = [&](int a, int b) NEVE_INLINE_BODY {
      const __m128d low = _mm_load_sd(reinterpret_cast<const double*>(from + index[a]));
      return _mm_castpd_ps(_mm_loadh_pd(low, reinterpret_cast<const double*>(from + index[b])));
    };
    const __m256 even = _mm256_set_m128(two(4, 5), two(0, 1)),
                 odd = _mm256_set_m128(two(6, 7), two(2, 3));
    first = reinterpret_cast<V>(_mm256_shuffle_ps(even, odd, 0x88));
    second = reinterpret_cast<V>(_mm256_shuffle_ps(even, odd, 0xdd));
    return;
  }
#endif
  for (int l = 0; l < lane_count<V>; ++l) {
    first[l] = from[index[l]];
    second[l] = from[index[l] + 1];
  }
}

/// Linear between the eight nodes of the cell of each lane.
/// @param index  of the first node of the cell @param x, y, z  parts of the way through it
/// @param row, slice  numbers from one node to the next along y, and along z
template <class V>
NEVE_INLINE V value_in_cells(const float* nodes, MaskOf<V> index, V x, V y, V z, int row,
                             int slice) {
  alignas(32) unsigned at[lane_count<V>];
  __builtin_memcpy(at, &index, sizeof at);
  const auto along_row = [&](int offset) NEVE_INLINE_BODY {
    V a, b;
    gather_pairs<V>(nodes + offset, at, a, b);
    return a + (b - a) * x;
  };
  const auto in_slice = [&](int offset) NEVE_INLINE_BODY {
    const V a = along_row(offset), b = along_row(offset + row);
    return a + (b - a) * y;
  };
  const V a = in_slice(0), b = in_slice(slice);
  return a + (b - a) * z;
}

/// The n-th number of each row, one row per lane.
template <class V>
NEVE_INLINE void quads_by_number(const float (&rows)[lane_count<V>][4], V (&out)[4]) {
#if defined(__AVX2__)
  if constexpr (sizeof(V) == 32) {
    const auto two = [&](int l) NEVE_INLINE_BODY {
      return _mm256_set_m128(_mm_load_ps(rows[l + 4]), _mm_load_ps(rows[l]));
    };
    const __m256 a = two(0), b = two(1), c = two(2), d = two(3);
    const __m256 low_ab = _mm256_unpacklo_ps(a, b), high_ab = _mm256_unpackhi_ps(a, b),
                 low_cd = _mm256_unpacklo_ps(c, d), high_cd = _mm256_unpackhi_ps(c, d);
    out[0] = reinterpret_cast<V>(_mm256_shuffle_ps(low_ab, low_cd, 0x44));
    out[1] = reinterpret_cast<V>(_mm256_shuffle_ps(low_ab, low_cd, 0xee));
    out[2] = reinterpret_cast<V>(_mm256_shuffle_ps(high_ab, high_cd, 0x44));
    out[3] = reinterpret_cast<V>(_mm256_shuffle_ps(high_ab, high_cd, 0xee));
    return;
  }
#endif
  for (int n = 0; n < 4; ++n)
    for (int l = 0; l < lane_count<V>; ++l) out[n][l] = rows[l][n];
}

/// A byte of each word as a number from 0 to 1.
template <class V>
NEVE_INLINE V byte_share(MaskOf<V> word, int byte) {
  return __builtin_convertvector(word >> (8 * byte) & 0xff, V) * (1.0f / 255);
}
/// Numbers from 0 to 1 as bytes, rounded; values beyond are clamped.
template <class V>
NEVE_INLINE MaskOf<V> to_byte(V x) {
  return __builtin_convertvector(unit_lanes(x) * 255.0f + 0.5f, MaskOf<V>);
}

}  // namespace
}  // namespace neve::render::cpu
