/// Histograms of quantities: bins, quantiles, what is in none of them.

#include "app/dump/histogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace neve::app::dump {
namespace {

Histogram of(std::vector<double> values, std::optional<scene::Range> expected = std::nullopt,
             std::vector<bool> negligible = {}) {
  Quantity quantity;
  quantity.name = "J_P";
  quantity.values = std::move(values);
  quantity.expected = expected;
  Listing listing;
  listing.is_negligible = std::move(negligible);
  return histogram_of(listing, quantity, 10);
}

std::vector<double> whole_numbers(int count) {
  std::vector<double> values(static_cast<std::size_t>(count));
  std::iota(values.begin(), values.end(), 0.5);
  return values;
}

TEST(Histogram, BinsOfEqualWidthHoldEveryValueOnce) {
  const Histogram h = of(whole_numbers(100));
  EXPECT_FALSE(h.is_logarithmic);
  ASSERT_EQ(h.counts.size(), 10u);
  for (const std::size_t count : h.counts) EXPECT_NEAR(double(count), 10, 1);
  EXPECT_EQ(h.rows, 100u);
  EXPECT_EQ(h.edge(0), 0.5);
  EXPECT_EQ(h.edge(10), 99.5);
  EXPECT_NEAR(h.q50, 50, 1);
  EXPECT_NEAR(h.q05, 5, 1);
  EXPECT_NEAR(h.q95, 95, 1);
}

TEST(Histogram, ValuesOverDecadesHaveBinsOfEqualRatioAndZerosAreApart) {
  std::vector<double> values{0, 0, 0};
  for (int k = 0; k <= 50; ++k) values.push_back(std::pow(10, -5 + 0.1 * k));
  const Histogram h = of(values);
  EXPECT_TRUE(h.is_logarithmic);
  EXPECT_EQ(h.zeros, 3u);
  EXPECT_EQ(h.rows, 51u);
  for (std::size_t bin = 0; bin < 10; ++bin)
    EXPECT_NEAR(h.edge(bin + 1) / h.edge(bin), 3.162, 0.01);
  for (const std::size_t count : h.counts) EXPECT_NEAR(double(count), 5, 1);
}

TEST(Histogram, LightNodesAndNoNumbersAreInNoBin) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Histogram h = of({1, 2, none, 1000}, scene::Range{0, 1.5}, {false, false, false, true});
  EXPECT_EQ(h.rows, 2u);
  EXPECT_EQ(h.not_finite, 1u);
  EXPECT_EQ(h.outside_expected, 2u) << "2, and the one that is no number";
  EXPECT_EQ(h.high, 2);
  EXPECT_FALSE(h.is_outside_expected(0));
  EXPECT_TRUE(h.is_outside_expected(9));
  EXPECT_NE(spread_text(h).find("1 are not numbers"), std::string::npos) << spread_text(h);
}

TEST(Histogram, OneValueAndNoneHaveWords) {
  const Histogram one = of({3, 3, 3});
  ASSERT_EQ(one.counts.size(), 1u);
  EXPECT_EQ(one.counts[0], 3u);
  EXPECT_EQ(histogram_lines(one).size(), 2u);
  const Histogram none = of({});
  EXPECT_TRUE(none.counts.empty());
  EXPECT_EQ(histogram_lines(none).size(), 1u);
}

TEST(Histogram, VectorsAreTheirLengths) {
  Quantity v;
  v.name = "v";
  v.components = 3;
  v.values = {3, 4, 0, 0, 0, 10};
  const Histogram h = histogram_of({}, v);
  EXPECT_EQ(h.name, "|v|");
  EXPECT_EQ(h.low, 5);
  EXPECT_EQ(h.high, 10);
}

}  // namespace
}  // namespace neve::app::dump
