#pragma once
/// A row of a tile: four nodes along z with four channels each, in as many registers as the
/// instruction set needs.

#include "sim/base/lanes.h"

namespace neve::sim::kernels {

/// Widths of the instruction sets that kernels are built for. They are part of every kernel's type,
/// so no two files share one.
struct BaselineSet {
  template <class Real>
  static constexpr int lanes = 4;
};
struct Avx2Set {
  template <class Real>
  static constexpr int lanes = 32 / sizeof(Real);
};
struct Avx512Set {
  template <class Real>
  static constexpr int lanes = 64 / sizeof(Real);
};

template <class Real, class Set>
struct Row {
  static constexpr int width = Set::template lanes<Real>;
  static constexpr int parts = 16 / width;
  using V = Lanes<Real, width>;
  V part[parts];

  NEVE_INLINE static Row zero() { return repeat(Quad<Real>{}); }

  NEVE_INLINE static Row load(const Quad<Real>* nodes) {
    Row r;
    unrolled<parts>([&](auto p) NEVE_INLINE_BODY {
      __builtin_memcpy(&r.part[p], reinterpret_cast<const Real*>(nodes) + p * width, sizeof(V));
    });
    return r;
  }
  NEVE_INLINE void store(Quad<Real>* nodes) const {
    unrolled<parts>([&](auto p) NEVE_INLINE_BODY {
      __builtin_memcpy(reinterpret_cast<Real*>(nodes) + p * width, &part[p], sizeof(V));
    });
  }
  NEVE_INLINE void add_to(Quad<Real>* nodes) const { (load(nodes) + *this).store(nodes); }

  /// The same quad at every node.
  NEVE_INLINE static Row repeat(Quad<Real> q) {
    Row r;
    unrolled<parts>([&](auto p) NEVE_INLINE_BODY { r.part[p] = repeat_quad<width>(q); });
    return r;
  }

  /// Number k of a quad in all channels of node k.
  NEVE_INLINE static Row spread(Quad<Real> q) {
    Row r;
    unrolled<parts>([&](auto p)
                        NEVE_INLINE_BODY { r.part[p] = spread_quad<width, p * width / 4>(q); });
    return r;
  }

  friend NEVE_INLINE Row operator+(const Row& a, const Row& b) {
    Row r;
    unrolled<parts>([&](auto p) NEVE_INLINE_BODY { r.part[p] = a.part[p] + b.part[p]; });
    return r;
  }
  friend NEVE_INLINE Row operator-(const Row& a, const Row& b) {
    Row r;
    unrolled<parts>([&](auto p) NEVE_INLINE_BODY { r.part[p] = a.part[p] - b.part[p]; });
    return r;
  }
  friend NEVE_INLINE Row operator*(const Row& a, const Row& b) {
    Row r;
    unrolled<parts>([&](auto p) NEVE_INLINE_BODY { r.part[p] = a.part[p] * b.part[p]; });
    return r;
  }
  friend NEVE_INLINE Row operator*(const Row& a, Real s) {
    Row r;
    unrolled<parts>([&](auto p) NEVE_INLINE_BODY { r.part[p] = a.part[p] * s; });
    return r;
  }
  /// a b + c
  friend NEVE_INLINE Row fused(const Row& a, const Row& b, const Row& c) {
    Row r;
    unrolled<parts>([&](auto p)
                        NEVE_INLINE_BODY { r.part[p] = fused(a.part[p], b.part[p], c.part[p]); });
    return r;
  }
  friend NEVE_INLINE Row fused(const Row& a, Real s, const Row& c) {
    Row r;
    const V factor = all<V>(s);
    unrolled<parts>([&](auto p)
                        NEVE_INLINE_BODY { r.part[p] = fused(a.part[p], factor, c.part[p]); });
    return r;
  }

  /// Sum over the four nodes.
  NEVE_INLINE Quad<Real> sum() const {
    if constexpr (width == 4) {
      return (part[0] + part[1]) + (part[2] + part[3]);
    } else if constexpr (width == 8) {
      const V both = part[0] + part[1];
      return half_of<0>(both) + half_of<1>(both);
    } else {
      const auto both = half_of<0>(part[0]) + half_of<1>(part[0]);
      return half_of<0>(both) + half_of<1>(both);
    }
  }
};

/// The sums over the nodes of four rows, side by side.
template <class Real, class Set>
NEVE_INLINE void sums_of(const Row<Real, Set>& a, const Row<Real, Set>& b, const Row<Real, Set>& c,
                         const Row<Real, Set>& d, Quad<Real>* out) {
#if defined(__AVX512DQ__)
  if constexpr (Row<Real, Set>::width == 16) {
    // Halves added pair by pair, then their quarters: the four sums come out in their places.
    const auto fold = [](__m512 x, __m512 y) NEVE_INLINE_BODY {
      return _mm512_shuffle_f32x4(x, y, 0x44) + _mm512_shuffle_f32x4(x, y, 0xee);
    };
    const __m512 ab =
        fold(reinterpret_cast<__m512>(a.part[0]), reinterpret_cast<__m512>(b.part[0]));
    const __m512 cd =
        fold(reinterpret_cast<__m512>(c.part[0]), reinterpret_cast<__m512>(d.part[0]));
    const __m512 sums = _mm512_shuffle_f32x4(ab, cd, 0x88) + _mm512_shuffle_f32x4(ab, cd, 0xdd);
    __builtin_memcpy(out, &sums, sizeof sums);
    return;
  }
#endif
  out[0] = a.sum();
  out[1] = b.sum();
  out[2] = c.sum();
  out[3] = d.sum();
}

}  // namespace neve::sim::kernels
