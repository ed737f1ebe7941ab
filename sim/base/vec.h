#pragma once
/// Small vectors and matrices without dependencies: for kernels and for drawing.

#include "sim/base/scalar.h"

namespace neve {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  NEVE_INLINE constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  NEVE_INLINE constexpr const T& operator[](int axis) const {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
  friend NEVE_INLINE constexpr Vec3 operator+(Vec3 a, Vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend NEVE_INLINE constexpr Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend NEVE_INLINE constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend NEVE_INLINE constexpr Vec3 operator*(Vec3 a, Vec3 b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
  }
  friend NEVE_INLINE constexpr Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend NEVE_INLINE constexpr Vec3 operator*(T s, Vec3 a) { return a * s; }
  friend NEVE_INLINE constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec3f = Vec3<float>;
using Vec3i = Vec3<int>;

template <class T>
NEVE_INLINE constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
NEVE_INLINE constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
NEVE_INLINE T length(Vec3<T> a) {
  return square_root(dot(a, a));
}

/// Unit vector along a; the zero vector stays zero.
template <class T>
NEVE_INLINE Vec3<T> normalized(Vec3<T> a) {
  const T l = length(a);
  return l > T(0) ? a / l : a;
}

}  // namespace neve
