#pragma once
/// Lanes of the compiler's vector extension: the same source on every instruction set, IEEE
/// results. Kernel code: no standard headers beyond what the compiler itself provides.

#define NEVE_INLINE inline __attribute__((always_inline))

namespace neve {

/// Four lanes: a node's or a particle's (x, y, z, w).
template <class Real>
struct QuadOf;
template <>
struct QuadOf<float> {
  typedef float Type __attribute__((vector_size(16)));
};
template <>
struct QuadOf<double> {
  typedef double Type __attribute__((vector_size(32)));
};
template <class Real>
using Quad = typename QuadOf<Real>::Type;

NEVE_INLINE float square_root(float x) {
  return __builtin_sqrtf(x);
}
NEVE_INLINE double square_root(double x) {
  return __builtin_sqrt(x);
}
NEVE_INLINE float absolute(float x) {
  return __builtin_fabsf(x);
}
NEVE_INLINE double absolute(double x) {
  return __builtin_fabs(x);
}
NEVE_INLINE bool is_finite(float x) {
  return __builtin_isfinite(x);
}
NEVE_INLINE bool is_finite(double x) {
  return __builtin_isfinite(x);
}

template <class T>
NEVE_INLINE T smaller(T a, T b) {
  return b < a ? b : a;
}
template <class T>
NEVE_INLINE T larger(T a, T b) {
  return a < b ? b : a;
}

/// Largest integer <= x, for |x| < 2^31. The baseline instruction set has no rounding instruction.
template <class Real>
NEVE_INLINE int floor_to_int(Real x) {
  const int n = static_cast<int>(x);
  return n - (static_cast<Real>(n) > x ? 1 : 0);
}

/// Result of comparing quads: all bits set where true.
template <class V>
using MaskOf = decltype(V{} < V{});

/// The same number in every lane.
template <class V>
NEVE_INLINE V all(double x) {
  return V{} + static_cast<decltype(V{}[0] + 0)>(x);
}

template <class M>
NEVE_INLINE bool any_lane(M mask) {
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}
template <class V>
NEVE_INLINE V absolute_lanes(V x) {
  return x < V{} ? -x : x;
}
template <class V>
NEVE_INLINE V larger_lanes(V a, V b) {
  return a < b ? b : a;
}
template <class V>
NEVE_INLINE V smaller_lanes(V a, V b) {
  return b < a ? b : a;
}
NEVE_INLINE Quad<float> square_root_lanes(Quad<float> x) {
#ifdef __SSE2__
  return __builtin_ia32_sqrtps(x);
#else
  return Quad<float>{square_root(x[0]), square_root(x[1]), square_root(x[2]), square_root(x[3])};
#endif
}
NEVE_INLINE Quad<double> square_root_lanes(Quad<double> x) {
  return Quad<double>{square_root(x[0]), square_root(x[1]), square_root(x[2]), square_root(x[3])};
}

/// e^x by reduction to |r| <= ln2/2 and a Taylor polynomial: own code, so that bits do not depend on
/// the machine's C library. Relative error below 2 units in the last place; saturates at +-80 in
/// float and +-700 in double.
NEVE_INLINE Quad<float> exponential_lanes(Quad<float> x) {
  typedef int Int4 __attribute__((vector_size(16)));
  x = smaller_lanes(larger_lanes(x, all<Quad<float>>(-80)), all<Quad<float>>(80));
  // Rounding to the nearest whole number by adding what pushes the fraction out of the mantissa.
  const Quad<float> shift = all<Quad<float>>(12582912.0);
  const Quad<float> k = (x * 1.44269504f + shift) - shift;
  const Quad<float> r = (x - k * 0.693359375f) + k * 2.12194440e-4f;
  Quad<float> p = all<Quad<float>>(1.0 / 5040);
  p = p * r + 1.0f / 720;
  p = p * r + 1.0f / 120;
  p = p * r + 1.0f / 24;
  p = p * r + 1.0f / 6;
  p = p * r + 0.5f;
  p = p * (r * r) + r + 1.0f;
  const Int4 n = __builtin_convertvector(k, Int4);
  return p * reinterpret_cast<Quad<float>>((n + 127) << 23);
}
NEVE_INLINE Quad<double> exponential_lanes(Quad<double> x) {
  typedef long long Long4 __attribute__((vector_size(32)));
  x = smaller_lanes(larger_lanes(x, all<Quad<double>>(-700)), all<Quad<double>>(700));
  const Quad<double> shift = all<Quad<double>>(6755399441055744.0);
  const Quad<double> k = (x * 1.4426950408889634 + shift) - shift;
  const Quad<double> r = (x - k * 6.93145751953125e-1) - k * 1.42860682030941723212e-6;
  Quad<double> p = all<Quad<double>>(1.0 / 6227020800.0);
  p = p * r + 1.0 / 479001600.0;
  p = p * r + 1.0 / 39916800.0;
  p = p * r + 1.0 / 3628800.0;
  p = p * r + 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  p = p * (r * r) + r + 1.0;
  const Long4 n = __builtin_convertvector(k, Long4);
  return p * reinterpret_cast<Quad<double>>((n + 1023) << 52);
}

/// ln x for x > 0 (0 and below give a large negative number): x = 2^n m with m around 1, then
/// ln m = 2 atanh((m - 1)/(m + 1)) by its series.
template <class Real>
NEVE_INLINE Real logarithm(Real x_in) {
  constexpr bool is_float = sizeof(Real) == 4;
  const double x = larger(static_cast<double>(x_in), 1e-300);
  const long long bits = __builtin_bit_cast(long long, x);
  long long n = (bits >> 52) - 1023;
  double m = __builtin_bit_cast(double, (bits & 0x000fffffffffffffll) | 0x3ff0000000000000ll);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    n += 1;
  }
  const double z = (m - 1.0) / (m + 1.0), z2 = z * z;
  double p = 0;
  for (int k = is_float ? 9 : 21; k >= 1; k -= 2) p = p * z2 + 1.0 / k;
  return static_cast<Real>(static_cast<double>(n) * 0.69314718055994530942 + 2.0 * z * p);
}

}  // namespace neve
