/// Selections of runs of a sweep, and job arrays that take them.

#include "app/sweep/plan/selection.h"

#include <gtest/gtest.h>

#include "app/support/errors.h"
#include "app/sweep/jobs/slurm.h"

namespace neve::app {
namespace {

TEST(SweepSelection, SelectionsOfRunsAreNumbersAndRanges) {
  EXPECT_EQ(app::sweep::plan::parse_selection("--only", "3,7-9,1", 20),
            (std::vector<int>{1, 3, 7, 8, 9}));
  EXPECT_EQ(app::sweep::plan::parse_selection("--only", "2,2,1-3", 3), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(app::sweep::plan::parse_selection("--only", "0", 0), (std::vector<int>{0}));
  for (const char* wrong : {"", ",", "1,", "a", "-1", "3-1", "1-", "1 2", "21", "5-21", "1--2"})
    EXPECT_THROW(app::sweep::plan::parse_selection("--only", wrong, 20), app::UsageError) << wrong;
}

TEST(SweepSelection, SelectionsOfRunsAreWrittenInTheShortestWay) {
  EXPECT_EQ(app::sweep::plan::selection_text({0, 1, 2, 3, 7, 9, 10}), "0-3,7,9-10");
  EXPECT_EQ(app::sweep::plan::selection_text({5}), "5");
  EXPECT_EQ(app::sweep::plan::selection_text({}), "");
}

TEST(SweepSelection, ShardsAreCountedFromOne) {
  EXPECT_EQ(app::sweep::plan::parse_shard("2/8").index, 2);
  EXPECT_EQ(app::sweep::plan::parse_shard("2/8").count, 8);
  for (const char* wrong : {"", "2", "0/8", "9/8", "a/b", "1/", "/8", "-1/8", "1/0"})
    EXPECT_THROW(app::sweep::plan::parse_shard(wrong), app::UsageError) << wrong;
}

TEST(SlurmArrays, ArraysHoldTheMissingRunsBelowTheLimitOfTheSite) {
  const auto one = app::sweep::jobs::split_arrays({1, 4, 10, 11, 12}, 1001);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].offset, 0);
  EXPECT_EQ(one[0].tasks, "1,4,10-12");
  const auto split = app::sweep::jobs::split_arrays({0, 9, 10, 11, 35}, 10);
  ASSERT_EQ(split.size(), 3u);
  EXPECT_EQ(split[0].tasks, "0,9");
  EXPECT_EQ(split[1].offset, 10);
  EXPECT_EQ(split[1].tasks, "0-1");
  EXPECT_EQ(split[2].offset, 30);
  EXPECT_EQ(split[2].tasks, "5");
}

}  // namespace
}  // namespace neve::app
