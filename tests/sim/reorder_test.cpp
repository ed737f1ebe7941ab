/// Records in a new order, without a second copy.

#include "sim/state/reorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace {

using namespace neve;
using namespace neve::sim;

struct Wide {
  std::uint32_t value[5];
};

/// Sorts numbers that wandered `distance` places from order.
void expect_reordered(std::size_t count, double distance, int threads) {
  ThreadPool pool(threads);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(0, distance);
  std::vector<double> rank(count);
  for (std::size_t q = 0; q < count; ++q) rank[q] = static_cast<double>(q) + shift(random);
  std::vector<std::uint32_t> order(count), iota(count);
  std::iota(iota.begin(), iota.end(), 0u);
  order = iota;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return rank[a] < rank[b]; });
  std::vector<Wide> records(count), expected(count);
  for (std::uint32_t q = 0; q < count; ++q) records[q] = {{q, q + 1, q + 2, q + 3, q + 4}};
  for (std::size_t q = 0; q < count; ++q) expected[q] = records[order[q]];
  engine::Reordering<Wide> reordering;
  reordering.run(records, order, pool, threads);
  EXPECT_EQ(order, iota);
  for (std::size_t q = 0; q < count; ++q)
    for (int k = 0; k < 5; ++k) ASSERT_EQ(records[q].value[k], expected[q].value[k]);
  if (distance < 100 && count > 1000) {
    EXPECT_LT(reordering.memory_bytes(), 4 * count);
  }
}

TEST(Reordering, ReorderingPutsEveryRecordWhereTheOrderSays) {
  for (const int threads : {1, 2, 3, 7})
    for (const std::size_t count : {0, 1, 2, 13, 10000})
      for (const double distance : {0.0, 5.0, 50.0, 1000.0, 1e6})
        expect_reordered(count, distance, threads);
}

}  // namespace
