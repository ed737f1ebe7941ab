#pragma once
/// Results of lanes.h, compiled once per instruction set: files that include this include no
/// standard library, as kernels do.

#include "sim/base/lanes.h"
#include "sim/kernels/row.h"

namespace neve::test {

/// Functions of N numbers, one per lane and batch; N is a multiple of 16.
template <class Real>
struct LanesProbe {
  int width;
  void (*exponential)(const Real* x, Real* y, int N);
  void (*logarithm)(const Real* x, Real* y, int N);
  void (*inverse_square_root)(const Real* x, Real* y, int N);
  void (*square_root)(const Real* x, Real* y, int N);
  void (*fused)(const Real* a, const Real* b, const Real* c, Real* y, int N);
  /// Reads `width` quads, transposes them to words, writes word by word; and back.
  void (*words_of_quads)(const Real* quads, Real* words);
  void (*quads_of_words)(const Real* words, Real* quads);
  void (*compress)(const Real* lanes, unsigned bits, Real* out);
  void (*expand)(const Real* lanes, unsigned bits, const Real* in, Real* out);
  unsigned (*bits_of_first_lanes)(int count);
  unsigned (*bits_of_greater)(const Real* a, const Real* b);
  Real (*largest)(const Real* x);
  Real (*smallest)(const Real* x);
  /// halves: all lanes, taken apart and joined again, upper half first; quads: last quad first
  void (*swap_halves)(const Real* x, Real* y);
  /// Repetitions of a quad: itself width/4 times; and numbers 0, 1 ... each four times.
  void (*repeat)(const Real* quad, Real* y);
  void (*spread)(const Real* quad, Real* y);
  /// Sums over the quads of four rows of 16 numbers, side by side.
  void (*row_sums)(const Real* rows, Real* sums);
};

template <class Set, class Real>
struct LanesProbeOf {
  static constexpr int W = Set::template lanes<Real>;
  using V = Lanes<Real, W>;
  using Row = sim::kernels::Row<Real, Set>;

  template <class Function>
  NEVE_INLINE static void each(const Real* x, Real* y, int N, const Function& f) {
    for (int q = 0; q < N; q += W) store_lanes(f(load_lanes<V>(x + q)), y + q);
  }
  static void exponential(const Real* x, Real* y, int N) {
    each(x, y, N, [](V v) NEVE_INLINE_BODY { return exponential_lanes(v); });
  }
  static void logarithm(const Real* x, Real* y, int N) {
    each(x, y, N, [](V v) NEVE_INLINE_BODY { return logarithm_lanes(v); });
  }
  static void inverse_root(const Real* x, Real* y, int N) {
    each(x, y, N, [](V v) NEVE_INLINE_BODY { return inverse_square_root(v); });
  }
  static void root(const Real* x, Real* y, int N) {
    each(x, y, N, [](V v) NEVE_INLINE_BODY { return square_root_lanes(v); });
  }
  static void multiply_add(const Real* a, const Real* b, const Real* c, Real* y, int N) {
    for (int q = 0; q < N; q += W)
      store_lanes(fused(load_lanes<V>(a + q), load_lanes<V>(b + q), load_lanes<V>(c + q)), y + q);
  }
  static void words_of_quads(const Real* quads, Real* words) {
    Quad<Real> in[W];
    __builtin_memcpy(in, quads, sizeof in);
    const FourWords<V> out = load_quads<V>(in);
    for (int k = 0; k < 4; ++k) store_lanes(out.w[k], words + k * W);
  }
  static void quads_of_words(const Real* words, Real* quads) {
    FourWords<V> in;
    for (int k = 0; k < 4; ++k) in.w[k] = load_lanes<V>(words + k * W);
    Quad<Real> out[W];
    store_quads(in, out);
    __builtin_memcpy(quads, out, sizeof out);
  }
  static void compressed(const Real* lanes, unsigned bits, Real* out) {
    LanePacking<V>(bits).compress(load_lanes<V>(lanes), out);
  }
  static void expanded(const Real* lanes, unsigned bits, const Real* in, Real* out) {
    store_lanes(LanePacking<V>(bits).expand(load_lanes<V>(lanes), in), out);
  }
  static unsigned bits_of_first_lanes(int count) {
    return lane_bits(first_lanes<MaskOf<V>>(count));
  }
  static unsigned bits_of_greater(const Real* a, const Real* b) {
    return lane_bits(load_lanes<V>(a) > load_lanes<V>(b));
  }
  static Real largest(const Real* x) { return largest_lane(load_lanes<V>(x)); }
  static Real smallest(const Real* x) { return smallest_lane(load_lanes<V>(x)); }
  static void swap_halves(const Real* x, Real* y) {
    const V v = load_lanes<V>(x);
    if constexpr (W == 4)
      store_lanes(quad_of<0>(v), y);
    else
      store_lanes(join_halves(half_of<1>(v), half_of<0>(v)), y);
  }
  static void repeat(const Real* quad, Real* y) {
    store_lanes(repeat_quad<W>(load_lanes<Quad<Real>>(quad)), y);
  }
  static void spread(const Real* quad, Real* y) {
    store_lanes(spread_quad<W, 0>(load_lanes<Quad<Real>>(quad)), y);
  }
  static void row_sums(const Real* rows, Real* sums) {
    Row row[4];
    for (int r = 0; r < 4; ++r) __builtin_memcpy(&row[r], rows + 16 * r, sizeof(Row));
    Quad<Real> out[4];
    sums_of(row[0], row[1], row[2], row[3], out);
    __builtin_memcpy(sums, out, sizeof out);
  }

  static constexpr LanesProbe<Real> table{
      W,          exponential,  logarithm,           inverse_root,
      root,       multiply_add, words_of_quads,      quads_of_words,
      compressed, expanded,     bits_of_first_lanes, bits_of_greater,
      largest,    smallest,     swap_halves,         repeat,
      spread,     row_sums};
};

/// One file per instruction set defines its own.
template <class Set>
struct LanesProbes {
  static const LanesProbe<float>& probe(float);
  static const LanesProbe<double>& probe(double);
};

}  // namespace neve::test

#define NEVE_DEFINE_LANES_PROBES(Set)                         \
  template <>                                                 \
  const LanesProbe<float>& LanesProbes<Set>::probe(float) {   \
    return LanesProbeOf<Set, float>::table;                   \
  }                                                           \
  template <>                                                 \
  const LanesProbe<double>& LanesProbes<Set>::probe(double) { \
    return LanesProbeOf<Set, double>::table;                  \
  }
