#pragma once
/// Lanes of the compiler's vector extension: one source for every instruction set, IEEE results.
///
/// Kernel code: every function is inlined wherever it is used, so that no copy compiled for one
/// instruction set can be linked into a file compiled for another. A function that chooses between
/// instructions by macro must stay always_inline.

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "sim/base/scalar.h"

namespace neve {

template <class T, int N>
struct LanesOf {
  typedef T Type __attribute__((vector_size(N * sizeof(T))));
};
/// N numbers side by side.
template <class T, int N>
using Lanes = typename LanesOf<T, N>::Type;
/// Four of them: a node's or a particle's (x, y, z, w).
template <class Real>
using Quad = Lanes<Real, 4>;

/// float of Lanes<float, N>, and so on; a number counts as one lane.
template <class V>
using ElementOf = decltype(V{}[0] + 0);
template <class V>
inline constexpr int lane_count = static_cast<int>(sizeof(V) / sizeof(V{}[0]));

/// Result of comparing lanes: all bits set where true.
template <class V>
using MaskOf = decltype(V{} < V{});

/// Integers as wide as a real: cells and masks go with them lane by lane.
template <class Real>
using Integer = ElementOf<MaskOf<Quad<Real>>>;

// ---- making and asking --------------------------------------------------------------------------

/// The same number in every lane. (x - 0 is x for every x, also -0; x + 0 is not.)
template <class V>
NEVE_INLINE V all(ElementOf<V> x) {
  return x - V{};
}

/// One bit per lane of a mask.
template <class M>
NEVE_INLINE unsigned lane_bits(M mask) {
#if defined(__AVX512DQ__)
  if constexpr (sizeof(M) == 64 && lane_count<M> == 16)
    return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask));
  else if constexpr (sizeof(M) == 64)
    return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
  else
#endif
#if defined(__AVX2__)
      if constexpr (sizeof(M) == 32 && lane_count<M> == 8)
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
  else if constexpr (sizeof(M) == 32)
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
  else
#endif
#if defined(__SSE2__)
      if constexpr (sizeof(M) == 16 && lane_count<M> == 4)
    return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
  else
#endif
  {
    unsigned bits = 0;
    for (int l = 0; l < lane_count<M>; ++l) bits |= (mask[l] != 0 ? 1u : 0u) << l;
    return bits;
  }
}
template <class M>
NEVE_INLINE bool any_lane(M mask) {
  return lane_bits(mask) != 0;
}

/// The mask whose first `count` lanes are set.
template <class M>
NEVE_INLINE M first_lanes(int count) {
  M index{};
  for (int l = 0; l < lane_count<M>; ++l) index[l] = l;
  return index < all<M>(count);
}

// ---- arithmetic ---------------------------------------------------------------------------------

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

/// a b + c, rounded once where the instruction set can.
template <class V>
NEVE_INLINE V fused(V a, V b, V c) {
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64 && lane_count<V> == 16)
    return reinterpret_cast<V>(_mm512_fmadd_ps(
        reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b), reinterpret_cast<__m512>(c)));
  else if constexpr (sizeof(V) == 64)
    return reinterpret_cast<V>(_mm512_fmadd_pd(
        reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b), reinterpret_cast<__m512d>(c)));
  else
#endif
#if defined(__FMA__)
      if constexpr (sizeof(V) == 32 && lane_count<V> == 8)
    return reinterpret_cast<V>(_mm256_fmadd_ps(
        reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b), reinterpret_cast<__m256>(c)));
  else if constexpr (sizeof(V) == 32)
    return reinterpret_cast<V>(_mm256_fmadd_pd(
        reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(b), reinterpret_cast<__m256d>(c)));
  else if constexpr (sizeof(V) == 16 && lane_count<V> == 4)
    return reinterpret_cast<V>(_mm_fmadd_ps(
        reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(b), reinterpret_cast<__m128>(c)));
  else
#endif
    return a * b + c;
}

/// c - a b
template <class V>
NEVE_INLINE V fused_negative(V a, V b, V c) {
  return fused(-a, b, c);
}

template <class V>
NEVE_INLINE V square_root_lanes(V x) {
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64 && lane_count<V> == 16)
    return reinterpret_cast<V>(_mm512_maskz_sqrt_ps(0xffff, reinterpret_cast<__m512>(x)));
  else if constexpr (sizeof(V) == 64)
    return reinterpret_cast<V>(_mm512_maskz_sqrt_pd(0xff, reinterpret_cast<__m512d>(x)));
  else
#endif
#if defined(__AVX2__)
      if constexpr (sizeof(V) == 32 && lane_count<V> == 8)
    return reinterpret_cast<V>(_mm256_sqrt_ps(reinterpret_cast<__m256>(x)));
  else if constexpr (sizeof(V) == 32)
    return reinterpret_cast<V>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(x)));
  else
#endif
#if defined(__SSE2__)
      if constexpr (sizeof(V) == 16 && lane_count<V> == 4)
    return reinterpret_cast<V>(_mm_sqrt_ps(reinterpret_cast<__m128>(x)));
  else
#endif
  {
    V y{};
    for (int l = 0; l < lane_count<V>; ++l) y[l] = square_root(x[l]);
    return y;
  }
}

/// 1/sqrt(x) for normal x > 0, the same bits on every machine (unlike the hardware's estimate). In
/// float an estimate from the exponent (relative error 3.4 %) is sharpened by a cubic and a Newton
/// step to about 2 units in the last place, without the slow divider.
template <class V>
NEVE_INLINE V inverse_square_root(V x) {
  if constexpr (sizeof(ElementOf<V>) == 4) {
    using I = MaskOf<V>;
    V y = reinterpret_cast<V>(0x5f375a86 - (reinterpret_cast<I>(x) >> 1));
    const V r = x * (y * y);
    y = y * fused(r, fused(r, all<V>(0.375f), all<V>(-1.25f)), all<V>(1.875f));
    const V error = fused(x * y * -0.5f, y, all<V>(0.5f));
    return fused(y, error, y);
  } else {
    return all<V>(1) / square_root_lanes(x);
  }
}

/// e^x by reduction to |r| <= ln2/2 and a Taylor polynomial: own code, so that bits do not depend
/// on the machine's C library. Relative error below 2 units in the last place; saturates at +-80 in
/// float and +-700 in double.
template <class V>
NEVE_INLINE V exponential_lanes(V x) {
  using Real = ElementOf<V>;
  using I = MaskOf<V>;
  constexpr bool is_float = sizeof(Real) == 4;
  constexpr Real most = is_float ? Real(80) : Real(700);
  x = smaller_lanes(larger_lanes(x, all<V>(-most)), all<V>(most));
  // Rounding to the nearest whole number by adding a number that pushes the fraction out of the
  // mantissa; the whole number is then in the lowest bits.
  const V shift = all<V>(is_float ? Real(12582912.0) : Real(6755399441055744.0));
  const V shifted = fused(x, all<V>(Real(1.4426950408889634)), shift);
  const V k = shifted - shift;
  V r;
  if constexpr (is_float)
    r = fused(k, all<V>(2.12194440e-4f), fused(k, all<V>(-0.693359375f), x));
  else
    r = fused(k, all<V>(-1.42860682030941723212e-6), fused(k, all<V>(-6.93145751953125e-1), x));
  constexpr int degree = is_float ? 7 : 13;
  Real factorial = 1;
  for (int n = 2; n <= degree; ++n) factorial *= static_cast<Real>(n);
  V p = all<V>(Real(1) / factorial);
  for (int n = degree; n > 1; --n) {
    factorial /= static_cast<Real>(n);
    p = fused(p, r, all<V>(Real(1) / factorial));
  }
  p = fused(p, r, all<V>(1));
  const I n = reinterpret_cast<I>(shifted) - reinterpret_cast<I>(shift);
  return p * reinterpret_cast<V>((n + (is_float ? 127 : 1023)) << (is_float ? 23 : 52));
}

/// ln x for x > 0 and normal: x = 2^n m with m around 1, then ln m = 2 atanh((m - 1)/(m + 1)) by
/// its series.
template <class V>
NEVE_INLINE V logarithm_lanes(V x) {
  using Real = ElementOf<V>;
  using I = MaskOf<V>;
  using Int = Integer<Real>;
  constexpr bool is_float = sizeof(Real) == 4;
  constexpr int mantissa = is_float ? 23 : 52;
  constexpr Int one_bits = is_float ? Int(0x3f800000) : Int(0x3ff0000000000000ll);
  const I bits = reinterpret_cast<I>(x);
  V m = reinterpret_cast<V>((bits & ((Int(1) << mantissa) - 1)) | one_bits);
  I n = (bits >> mantissa) - (is_float ? 127 : 1023);
  const I is_large = m > all<V>(Real(1.4142135623730951));
  m = is_large ? m * Real(0.5) : m;
  n = is_large ? n + 1 : n;
  const V one = all<V>(1), z = (m - one) / (m + one), z2 = z * z;
  V p{};
  for (int k = is_float ? 9 : 21; k >= 3; k -= 2)
    p = fused(p, z2, all<V>(Real(1) / static_cast<Real>(k)));
  const V whole = __builtin_convertvector(n, V);
  // The largest term last, so that small logarithms keep their relative accuracy.
  return fused(z2 * p, z + z, z + z) + whole * Real(0.69314718055994530942);
}

// ---- moving lanes -------------------------------------------------------------------------------

template <int... I>
struct Indices {};
#if defined(__clang__)
template <class Int, Int... I>
using IndicesOf = Indices<I...>;
/// Indices<0, 1 ... N - 1>.
template <int N>
using Counted = __make_integer_seq<IndicesOf, int, N>;
#else
template <int N>
using Counted = Indices<__integer_pack(N)...>;
#endif
template <int I>
struct Constant {
  constexpr operator int() const { return I; }
};

/// body(0), body(1) ... body(N - 1) written out, so that arrays of registers stay in registers.
template <int N, class Body>
NEVE_INLINE void unrolled(const Body& body) {
  [&]<int... I>(Indices<I...>) NEVE_INLINE_BODY {
    (body(Constant<I>{}), ...);
  }
  (Counted<N>{});
}

/// Four quads of records in, four words in lanes out, and back: in every group of four lanes a 4x4
/// transpose.
template <class V>
struct FourWords {
  V w[4];
};
template <class V, int... I>
NEVE_INLINE void transpose_quads(FourWords<V>& r, Indices<I...>) {
  constexpr int n = lane_count<V>;
  const V a = __builtin_shufflevector(r.w[0], r.w[1], ((I & 1) * n + (I & ~3) + ((I >> 1) & 1))...);
  const V b = __builtin_shufflevector(r.w[2], r.w[3], ((I & 1) * n + (I & ~3) + ((I >> 1) & 1))...);
  const V c =
      __builtin_shufflevector(r.w[0], r.w[1], ((I & 1) * n + (I & ~3) + 2 + ((I >> 1) & 1))...);
  const V d =
      __builtin_shufflevector(r.w[2], r.w[3], ((I & 1) * n + (I & ~3) + 2 + ((I >> 1) & 1))...);
  r.w[0] = __builtin_shufflevector(a, b, ((I & 2) / 2 * n + (I & ~3) + (I & 1))...);
  r.w[1] = __builtin_shufflevector(a, b, ((I & 2) / 2 * n + (I & ~3) + 2 + (I & 1))...);
  r.w[2] = __builtin_shufflevector(c, d, ((I & 2) / 2 * n + (I & ~3) + (I & 1))...);
  r.w[3] = __builtin_shufflevector(c, d, ((I & 2) / 2 * n + (I & ~3) + 2 + (I & 1))...);
}

// The compiler builds some of these through the stack, which stalls; hence the instructions by
// name.

/// The lower (0) or upper (1) half of the lanes.
template <int half, class V>
NEVE_INLINE auto half_of(V v) {
  using H = Lanes<ElementOf<V>, lane_count<V> / 2>;
#if defined(__AVX512DQ__)
  if constexpr (sizeof(V) == 64)
    return reinterpret_cast<H>(_mm512_extractf32x8_ps(reinterpret_cast<__m512>(v), half));
  else
#endif
#if defined(__AVX2__)
      if constexpr (sizeof(V) == 32)
    return reinterpret_cast<H>(_mm256_extractf128_ps(reinterpret_cast<__m256>(v), half));
  else
#endif
  {
    H h{};
    for (int l = 0; l < lane_count<H>; ++l) h[l] = v[half * lane_count<H> + l];
    return h;
  }
}
template <int group, class V>
NEVE_INLINE auto quad_of(V v) {
  if constexpr (lane_count<V> == 4)
    return v;
  else if constexpr (lane_count<V> == 8)
    return half_of<group>(v);
  else
    return half_of<group % 2>(half_of<group / 2>(v));
}

/// Two halves side by side.
template <class H>
NEVE_INLINE auto join_halves(H low, H high) {
  using V = Lanes<ElementOf<H>, 2 * lane_count<H>>;
#if defined(__AVX512DQ__)
  if constexpr (sizeof(H) == 32)
    return reinterpret_cast<V>(_mm512_insertf32x8(
        _mm512_castps256_ps512(reinterpret_cast<__m256>(low)), reinterpret_cast<__m256>(high), 1));
  else
#endif
#if defined(__AVX2__)
      if constexpr (sizeof(H) == 16)
    return reinterpret_cast<V>(_mm256_insertf128_ps(
        _mm256_castps128_ps256(reinterpret_cast<__m128>(low)), reinterpret_cast<__m128>(high), 1));
  else
#endif
  {
    V v{};
    for (int l = 0; l < lane_count<H>; ++l) {
      v[l] = low[l];
      v[lane_count<H> + l] = high[l];
    }
    return v;
  }
}
/// The same quad N/4 times.
template <int N, class Q>
NEVE_INLINE Lanes<ElementOf<Q>, N> repeat_quad(Q q) {
  using V [[maybe_unused]] = Lanes<ElementOf<Q>, N>;
  if constexpr (N == 4) return q;
#if defined(__AVX512DQ__)
  if constexpr (N == 16 && sizeof(V) == 64)
    return reinterpret_cast<V>(_mm512_broadcast_f32x4(reinterpret_cast<__m128>(q)));
  if constexpr (N == 8 && sizeof(V) == 64)
    return reinterpret_cast<V>(_mm512_broadcast_f64x4(reinterpret_cast<__m256d>(q)));
#endif
  if constexpr (N == 8) return join_halves(q, q);
  if constexpr (N == 16) return join_halves(join_halves(q, q), join_halves(q, q));
}

template <int k, class Q>
NEVE_INLINE Q four_of(Q q) {
  return __builtin_shufflevector(q, q, k, k, k, k);
}
/// Numbers first, first + 1 ... of a quad, each four times.
template <int N, int first, class Q>
NEVE_INLINE Lanes<ElementOf<Q>, N> spread_quad(Q q) {
  using V [[maybe_unused]] = Lanes<ElementOf<Q>, N>;
  if constexpr (N == 4) return four_of<first>(q);
#if defined(__AVX512DQ__)
  // Each 128 bits get the number of those 128 bits.
  if constexpr (N == 16 && sizeof(V) == 64)
    return reinterpret_cast<V>(
        _mm512_permutevar_ps(_mm512_broadcast_f32x4(reinterpret_cast<__m128>(q)),
                             _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3)));
  if constexpr (N == 8 && sizeof(V) == 64)
    return reinterpret_cast<V>(_mm512_permutexvar_pd(
        _mm512_setr_epi64(first, first, first, first, first + 1, first + 1, first + 1, first + 1),
        _mm512_castpd256_pd512(reinterpret_cast<__m256d>(q))));
#endif
#if defined(__AVX2__)
  if constexpr (N == 8 && sizeof(V) == 32)
    return reinterpret_cast<V>(_mm256_permutevar_ps(
        reinterpret_cast<__m256>(join_halves(q, q)),
        _mm256_setr_epi32(first, first, first, first, first + 1, first + 1, first + 1, first + 1)));
#endif
  if constexpr (N == 8) return join_halves(four_of<first>(q), four_of<first + 1>(q));
}

/// quad(l) of every lane l, word by word.
template <class V, class Read>
NEVE_INLINE FourWords<V> gather_words(const Read& quad) {
  FourWords<V> out;
  unrolled<4>([&](auto t) NEVE_INLINE_BODY {
    if constexpr (lane_count<V> == 4)
      out.w[t] = quad(t);
    else if constexpr (lane_count<V> == 8)
      out.w[t] = join_halves(quad(t), quad(4 + t));
    else
      out.w[t] =
          join_halves(join_halves(quad(t), quad(4 + t)), join_halves(quad(8 + t), quad(12 + t)));
  });
  transpose_quads(out, Counted<lane_count<V>>{});
  return out;
}
/// The inverse: write(l, quad) for every lane l.
template <class V, class Write>
NEVE_INLINE void scatter_words(FourWords<V> words, const Write& write) {
  transpose_quads(words, Counted<lane_count<V>>{});
  unrolled<4>([&](auto t) NEVE_INLINE_BODY {
    unrolled<lane_count<V> / 4>([&](auto g)
                                    NEVE_INLINE_BODY { write(4 * g + t, quad_of<g>(words.w[t])); });
  });
}

/// Four consecutive words at byte `offset` of one record per lane.
template <class V, class Record>
NEVE_INLINE FourWords<V> load_words(Record* const* records, int offset) {
  return gather_words<V>([&](int l) NEVE_INLINE_BODY {
    Quad<ElementOf<V>> q;
    __builtin_memcpy(&q, reinterpret_cast<const char*>(records[l]) + offset, sizeof q);
    return q;
  });
}
/// Writes them to the first `count` records.
template <class V, class Record>
NEVE_INLINE void store_words(const FourWords<V>& words, Record* const* records, int offset,
                             int count) {
  scatter_words(words, [&](int l, Quad<ElementOf<V>> q) NEVE_INLINE_BODY {
    if (l < count) __builtin_memcpy(reinterpret_cast<char*>(records[l]) + offset, &q, sizeof q);
  });
}

/// The same from and to adjacent quads, one per lane.
template <class V>
NEVE_INLINE FourWords<V> load_quads(const Quad<ElementOf<V>>* from) {
  return gather_words<V>([&](int l) NEVE_INLINE_BODY { return from[l]; });
}
template <class V>
NEVE_INLINE void store_quads(const FourWords<V>& words, Quad<ElementOf<V>>* to) {
  scatter_words(words, [&](int l, Quad<ElementOf<V>> q) NEVE_INLINE_BODY { to[l] = q; });
}

/// Moves the lanes named by some bits together, and back to their places.
template <class V>
class LanePacking {
 public:
  using Real = ElementOf<V>;

  NEVE_INLINE explicit LanePacking(unsigned bits) : bits_(bits) {
#if defined(__AVX2__) && defined(__BMI2__)
    if constexpr (sizeof(V) == 32 && lane_count<V> == 8) {
      // A byte per lane, all set where the lane is named; then the numbers of the named lanes moved
      // together, and for every named lane how many come before it.
      const unsigned long long named = _pdep_u64(bits, 0x0101010101010101) * 0xff;
      constexpr unsigned long long numbers = 0x0706050403020100;
      together_ = widened(_pext_u64(numbers, named));
      apart_ = widened(_pdep_u64(numbers, named));
      is_named_ = reinterpret_cast<MaskOf<V>>(
          _mm256_cvtepi8_epi32(_mm_cvtsi64_si128(static_cast<long long>(named))));
    }
#endif
  }

  /// The lanes moved together; up to a whole vector is overwritten.
  NEVE_INLINE void compress(V v, Real* out) const {
#if defined(__AVX512F__)
    if constexpr (sizeof(V) == 64 && sizeof(Real) == 4) {
      const __m512 packed =
          _mm512_maskz_compress_ps(static_cast<__mmask16>(bits_), reinterpret_cast<__m512>(v));
      return _mm512_storeu_ps(reinterpret_cast<float*>(out), packed);
    } else if constexpr (sizeof(V) == 64) {
      const __m512d packed =
          _mm512_maskz_compress_pd(static_cast<__mmask8>(bits_), reinterpret_cast<__m512d>(v));
      return _mm512_storeu_pd(reinterpret_cast<double*>(out), packed);
    } else
#endif
#if defined(__AVX2__) && defined(__BMI2__)
        if constexpr (sizeof(V) == 32 && lane_count<V> == 8) {
      return _mm256_storeu_ps(reinterpret_cast<float*>(out),
                              _mm256_permutevar8x32_ps(reinterpret_cast<__m256>(v), together_));
    } else
#endif
    {
      Real lane[lane_count<V>];
      __builtin_memcpy(lane, &v, sizeof v);
      for (unsigned bits = bits_; bits != 0; bits &= bits - 1) *out++ = lane[__builtin_ctz(bits)];
    }
  }

  /// The named lanes take the next numbers of `in`, the others stay. A whole vector is read.
  NEVE_INLINE V expand(V v, const Real* in) const {
#if defined(__AVX512F__)
    if constexpr (sizeof(V) == 64 && sizeof(Real) == 4) {
      return reinterpret_cast<V>(
          _mm512_mask_expand_ps(reinterpret_cast<__m512>(v), static_cast<__mmask16>(bits_),
                                _mm512_loadu_ps(reinterpret_cast<const float*>(in))));
    } else if constexpr (sizeof(V) == 64) {
      return reinterpret_cast<V>(
          _mm512_mask_expand_pd(reinterpret_cast<__m512d>(v), static_cast<__mmask8>(bits_),
                                _mm512_loadu_pd(reinterpret_cast<const double*>(in))));
    } else
#endif
#if defined(__AVX2__) && defined(__BMI2__)
        if constexpr (sizeof(V) == 32 && lane_count<V> == 8) {
      const V moved = reinterpret_cast<V>(
          _mm256_permutevar8x32_ps(_mm256_loadu_ps(reinterpret_cast<const float*>(in)), apart_));
      return is_named_ ? moved : v;
    } else
#endif
    {
      Real lane[lane_count<V>];
      __builtin_memcpy(lane, &v, sizeof v);
      for (unsigned bits = bits_; bits != 0; bits &= bits - 1) lane[__builtin_ctz(bits)] = *in++;
      __builtin_memcpy(&v, lane, sizeof v);
      return v;
    }
  }

 private:
  unsigned bits_;
#if defined(__AVX2__) && defined(__BMI2__)
  NEVE_INLINE static __m256i widened(unsigned long long bytes) {
    return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(bytes)));
  }
  __m256i together_, apart_;
  MaskOf<V> is_named_;
#endif
};

template <class V>
NEVE_INLINE V load_lanes(const ElementOf<V>* from) {
  V v;
  __builtin_memcpy(&v, from, sizeof(V));
  return v;
}
template <class V>
NEVE_INLINE void store_lanes(V v, ElementOf<V>* to) {
  __builtin_memcpy(to, &v, sizeof(V));
}

/// The largest, smallest and sum of all lanes; the sum goes from the first to the last.
template <class V>
NEVE_INLINE ElementOf<V> largest_lane(V v) {
  ElementOf<V> out = v[0];
  for (int l = 1; l < lane_count<V>; ++l) out = larger(out, ElementOf<V>(v[l]));
  return out;
}
template <class V>
NEVE_INLINE ElementOf<V> smallest_lane(V v) {
  return -largest_lane(-v);
}

}  // namespace neve
