#pragma once
/// Scalar arithmetic for kernels and drawing, without standard headers.

#define NEVE_INLINE inline __attribute__((always_inline))
/// Inlines a lambda: it stands after the parameters.
#define NEVE_INLINE_BODY __attribute__((always_inline))
/// Marks a kernel that is worth a call: the instruction set must be among its template arguments.
#define NEVE_NOINLINE __attribute__((noinline))

namespace neve {

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

}  // namespace neve
