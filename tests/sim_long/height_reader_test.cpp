/// The time that large height fields take.

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "sim/files/height_reader.h"
#include "tests/support/height_files.h"

namespace neve::test {
namespace {

/// 36 MB of text. Measured: 0.2 s; the limit is that of a person who waits. Time of the processor,
/// so that other processes do not count.
TEST(HeightReader, FourMillionPostsAreReadWithinTwoSeconds) {
  const std::string text = height_grid(2000, 2000, 2, [](double x, double z) {
    return 2000 + 300 * std::sin(x / 400) + 200 * std::cos(z / 300);
  });
  const std::clock_t start = std::clock();
  const sim::files::HeightGrid grid = sim::files::parse_heights(text, "large.asc", {});
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 2);
  EXPECT_EQ(grid.height.size(), 4000000u);
}

}  // namespace
}  // namespace neve::test
