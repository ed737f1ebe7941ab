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

/// Within [low, high]; NaN becomes low.
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
