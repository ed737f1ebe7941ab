/// Arithmetic and movement of lanes at every SIMD level that this machine has.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "sim/kernels/simd.h"
#include "tests/support/lanes_probe.h"

namespace neve::test {
namespace {

using sim::kernels::SimdLevel;

template <class Real>
const LanesProbe<Real>& probe_of([[maybe_unused]] SimdLevel level) {
#ifdef __x86_64__
  if (level == SimdLevel::avx512) return LanesProbes<sim::kernels::Avx512Set>::probe(Real());
  if (level == SimdLevel::avx2) return LanesProbes<sim::kernels::Avx2Set>::probe(Real());
#endif
  return LanesProbes<sim::kernels::BaselineSet>::probe(Real());
}

/// body(probe) for float and double of each level.
template <class Body>
void with_every_probe(const Body& body) {
  for (const SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!sim::kernels::is_available(level)) continue;
    SCOPED_TRACE(sim::kernels::name(level));
    body(probe_of<float>(level), float());
    body(probe_of<double>(level), double());
  }
}

template <class Real>
std::vector<Real> numbers(int count, double min, double max, bool is_logarithmic) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(is_logarithmic ? std::log(min) : min,
                                              is_logarithmic ? std::log(max) : max);
  std::vector<Real> x(static_cast<std::size_t>(count));
  for (Real& value : x)
    value = static_cast<Real>(is_logarithmic ? std::exp(unit(random)) : unit(random));
  return x;
}

/// Largest |found / expected - 1| in units in the last place at 1.
template <class Real, class Function>
double worst_error(const std::vector<Real>& x, const std::vector<Real>& found,
                   const Function& function) {
  double worst = 0;
  for (std::size_t q = 0; q < x.size(); ++q) {
    const long double expected = function(static_cast<long double>(x[q]));
    const long double error = std::abs(static_cast<long double>(found[q]) - expected);
    if (error != 0) worst = std::max(worst, static_cast<double>(error / std::abs(expected)));
  }
  return worst / static_cast<double>(std::numeric_limits<Real>::epsilon());
}

constexpr int many = 1 << 16;

TEST(Lanes, ExponentialIsGoodToTwoUnitsInTheLastPlace) {
  with_every_probe([]<class Real>(const LanesProbe<Real>& probe, Real) {
    const double most = sizeof(Real) == 4 ? 80 : 700;
    for (const double range : {1e-6, 1.0, 20.0, most}) {
      const std::vector<Real> x = numbers<Real>(many, -range, range, false);
      std::vector<Real> y(x.size());
      probe.exponential(x.data(), y.data(), many);
      EXPECT_LE(worst_error(x, y, [](long double v) { return std::exp(v); }), 2);
    }
    // Beyond these ranges it stays where it is; 0 is exact; a value that is no number stays none.
    std::vector<Real> x(16), y(16);
    const Real infinity = std::numeric_limits<Real>::infinity();
    x = {Real(most),
         Real(2 * most),
         infinity,
         Real(-most),
         Real(-2 * most),
         -infinity,
         0,
         -Real(0),
         std::numeric_limits<Real>::quiet_NaN(),
         0,
         0,
         0,
         0,
         0,
         0,
         0};
    probe.exponential(x.data(), y.data(), 16);
    EXPECT_EQ(y[1], y[0]);
    EXPECT_EQ(y[2], y[0]);
    EXPECT_EQ(y[4], y[3]);
    EXPECT_EQ(y[5], y[3]);
    EXPECT_TRUE(std::isfinite(y[0]) && y[3] > 0);
    EXPECT_EQ(y[6], 1);
    EXPECT_EQ(y[7], 1);
    EXPECT_TRUE(std::isnan(y[8]));
  });
}

TEST(Lanes, LogarithmIsGoodToThreeUnitsInTheLastPlace) {
  with_every_probe([]<class Real>(const LanesProbe<Real>& probe, Real) {
    const auto logarithm = [](long double v) { return std::log(v); };
    std::vector<Real> y(many);
    // Next to 1 its relative accuracy is what neo-Hookean stress at small strain lives from.
    for (const auto& [min, max] : {std::pair{0.5, 2.0}, std::pair{0.999, 1.001},
                                   std::pair{1e-6, 1e6}, std::pair{1e-37, 1e37}}) {
      const std::vector<Real> x = numbers<Real>(many, min, max, true);
      probe.logarithm(x.data(), y.data(), many);
      EXPECT_LE(worst_error(x, y, logarithm), 3) << min;
    }
    std::vector<Real> x(16, Real(1));
    x[1] = std::nextafter(Real(1), Real(0));
    x[2] = std::nextafter(Real(1), Real(2));
    x[3] = std::numeric_limits<Real>::min();
    x[4] = std::numeric_limits<Real>::max();
    y.resize(16);
    probe.logarithm(x.data(), y.data(), 16);
    EXPECT_EQ(y[0], 0);
    EXPECT_LE(worst_error(x, y, logarithm), 3);
  });
}

TEST(Lanes, RootsAreGood) {
  with_every_probe([]<class Real>(const LanesProbe<Real>& probe, Real) {
    std::vector<Real> y(many);
    for (const auto& [min, max] : {std::pair{0.25, 4.0}, std::pair{1e-37, 1e37}}) {
      const std::vector<Real> x = numbers<Real>(many, min, max, true);
      probe.square_root(x.data(), y.data(), many);
      EXPECT_LE(worst_error(x, y, [](long double v) { return std::sqrt(v); }), 0.5 + 1e-9);
      probe.inverse_square_root(x.data(), y.data(), many);
      EXPECT_LE(worst_error(x, y, [](long double v) { return 1 / std::sqrt(v); }), 2);
    }
  });
}

TEST(Lanes, FusedRoundsOnceWhereTheInstructionSetCan) {
  with_every_probe([]<class Real>(const LanesProbe<Real>& probe, Real) {
    const std::vector<Real> a = numbers<Real>(64, -1, 1, false), b(a.rbegin(), a.rend());
    std::vector<Real> c(64), y(64);
    for (std::size_t q = 0; q < 64; ++q) c[q] = -a[q] * b[q];
    probe.fused(a.data(), b.data(), c.data(), y.data(), 64);
    const bool is_baseline = probe.width == 4 && &probe == &probe_of<Real>(SimdLevel::baseline);
    for (std::size_t q = 0; q < 64; ++q)
      EXPECT_EQ(y[q], is_baseline ? a[q] * b[q] + c[q] : std::fma(a[q], b[q], c[q]));
  });
}

template <class Real>
std::vector<Real> counted(int count) {
  std::vector<Real> x(static_cast<std::size_t>(count));
  for (std::size_t q = 0; q < x.size(); ++q) x[q] = static_cast<Real>(q + 1);
  return x;
}

TEST(Lanes, TransposesGoThereAndBack) {
  with_every_probe([]<class Real>(const LanesProbe<Real>& probe, Real) {
    const int W = probe.width;
    const std::vector<Real> quads = counted<Real>(4 * W);
    std::vector<Real> words(quads.size()), back(quads.size());
    probe.words_of_quads(quads.data(), words.data());
    for (int l = 0; l < W; ++l)
      for (int k = 0; k < 4; ++k) EXPECT_EQ(words[k * W + l], quads[4 * l + k]);
    probe.quads_of_words(words.data(), back.data());
    EXPECT_EQ(back, quads);
  });
}

TEST(Lanes, CompressAndExpandAreInverse) {
  with_every_probe([]<class Real>(const LanesProbe<Real>& probe, Real) {
    const int W = probe.width;
    const std::vector<Real> lanes = counted<Real>(W);
    const std::vector<Real> others(lanes.size(), Real(-7));
    for (unsigned bits = 0; bits < 1u << W; ++bits) {
      std::vector<Real> packed(lanes.size(), Real(-1)), out(lanes.size());
      probe.compress(lanes.data(), bits, packed.data());
      int count = 0;
      for (int l = 0; l < W; ++l)
        if (bits >> l & 1) {
          ASSERT_EQ(packed[count++], lanes[l]) << bits;
        }
      probe.expand(others.data(), bits, packed.data(), out.data());
      for (int l = 0; l < W; ++l) ASSERT_EQ(out[l], bits >> l & 1 ? lanes[l] : others[l]) << bits;
    }
  });
}

TEST(Lanes, MasksHaveOneBitPerLane) {
  with_every_probe([]<class Real>(const LanesProbe<Real>& probe, Real) {
    const int W = probe.width;
    for (int count = -2; count <= W + 2; ++count)
      EXPECT_EQ(probe.bits_of_first_lanes(count), (1u << std::clamp(count, 0, W)) - 1);
    const std::vector<Real> zero(static_cast<std::size_t>(W));
    for (unsigned bits = 0; bits < 1u << W; ++bits) {
      std::vector<Real> x(zero.size());
      for (int l = 0; l < W; ++l)
        x[l] = bits >> l & 1 ? Real(1) : std::numeric_limits<Real>::quiet_NaN();
      ASSERT_EQ(probe.bits_of_greater(x.data(), zero.data()), bits);
    }
  });
}

TEST(Lanes, HalvesAndQuadsKeepTheirPlaces) {
  with_every_probe([]<class Real>(const LanesProbe<Real>& probe, Real) {
    const int W = probe.width;
    const std::vector<Real> x = counted<Real>(W);
    std::vector<Real> y(x.size());
    probe.swap_halves(x.data(), y.data());
    for (int l = 0; l < W; ++l) EXPECT_EQ(y[l], x[W == 4 ? l : (l + W / 2) % W]);
    probe.repeat(x.data(), y.data());
    for (int l = 0; l < W; ++l) EXPECT_EQ(y[l], x[l % 4]);
    probe.spread(x.data(), y.data());
    for (int l = 0; l < W; ++l) EXPECT_EQ(y[l], x[l / 4]);
    for (int l = 0; l < W; ++l) {
      std::vector<Real> one(x.size());
      one[l] = 5;
      EXPECT_EQ(probe.largest(one.data()), 5);
      EXPECT_EQ(probe.smallest(one.data()), 0);
      one[l] = -5;
      EXPECT_EQ(probe.largest(one.data()), 0);
      EXPECT_EQ(probe.smallest(one.data()), -5);
    }
    const std::vector<Real> rows = counted<Real>(64);  // whole numbers: every order gives the same
    std::vector<Real> sums(16);
    probe.row_sums(rows.data(), sums.data());
    for (int r = 0; r < 4; ++r)
      for (int k = 0; k < 4; ++k) {
        Real sum = 0;
        for (int node = 0; node < 4; ++node) sum += rows[16 * r + 4 * node + k];
        EXPECT_EQ(sums[4 * r + k], sum);
      }
  });
}

}  // namespace
}  // namespace neve::test
