/// The foreseen cost of the runs of a sweep, and the order and threads that it gives them.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "app/sweep/jobs/local.h"
#include "app/sweep/plan/order.h"
#include "app/sweep/plan/sweep_forecast.h"
#include "app/sweep/plan/sweep_options.h"
#include "tests/cli/run_neve.h"

namespace neve::app::sweep {
namespace {

class SweepForecasts : public testing::Test {
 protected:
  plan::SweepPlan plan_of(const std::string& axes) {
    folder_.write("scene.toml", test::tiny_scene);
    plan::SweepOptions options;
    options.file = folder_.write("sweep.toml", "[sweep]\nscene = \"scene.toml\"\n[axis]\n" + axes);
    return plan::plan_sweep(options);
  }

  static std::vector<std::size_t> all(const plan::SweepPlan& plan) {
    std::vector<std::size_t> places(plan.runs.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    return places;
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(SweepForecasts, StiffSnowAndLateFramesCostMore) {
  const plan::SweepPlan plan =
      plan_of("\"material.snow.youngs_modulus\" = [2e4, 2e6]\nframes = [4, 40]\n");
  const plan::SweepForecast forecast =
      plan::foresee_sweep(plan, all(plan), plan::whole_effort(1), 1);
  ASSERT_EQ(forecast.own.size(), 4u);
  EXPECT_GT(forecast.work[1].expected, forecast.work[0].expected);
  EXPECT_GT(forecast.work[2].expected, forecast.work[0].expected);
  EXPECT_GT(forecast.work[3].expected, forecast.work[1].expected);
  EXPECT_GT(forecast.work[3].expected, forecast.work[2].expected);
  EXPECT_GT(forecast.seconds_per_work, 0);
  const auto together = forecast.seconds_of_all(all(plan), 2);
  EXPECT_GE(together.expected, forecast.seconds(3).expected);
  EXPECT_LT(together.least, together.expected);
  EXPECT_GT(together.most, together.expected);
}

/// Counts of steps, not of seconds, bound the copies.
TEST_F(SweepForecasts, CostsAreTheSameAtAnyNumberOfThreads) {
  const plan::SweepPlan plan = plan_of("\"material.snow.hardening\" = [2, 5, 10, 20]\n");
  const auto work = [&](int cores) {
    std::vector<double> list;
    for (const forecast::Cost& cost : plan::foresee_sweep(plan, all(plan), {1e6}, cores).work)
      list.push_back(cost.expected);
    return list;
  };
  EXPECT_EQ(work(1), work(3));
}

TEST_F(SweepForecasts, ARunWithoutACopyCostsAsTheNearestWithOne) {
  const plan::SweepPlan plan =
      plan_of("\"material.snow.youngs_modulus\" = [2e4, 2.1e4, 1.9e6, 2e6]\nframes = [4, 20]\n");
  const plan::SweepForecast whole = plan::foresee_sweep(plan, all(plan), plan::whole_effort(1), 1);
  plan::SweepForecast some;
  for (double effort = 1e4; some.own.size() < 4; effort *= 1.07)
    some = plan::foresee_sweep(plan, all(plan), {effort}, 1);
  ASSERT_EQ(some.own.size(), 4u) << "efforts grow by less than a copy costs";
  for (const std::size_t k : {2u, 3u, 4u, 5u})
    EXPECT_EQ(std::count(some.own.begin(), some.own.end(), k), 0) << "corners have copies first";
  // Forecasts are near the full ones beside a corner, and far from it.
  EXPECT_NEAR(some.work[2].expected / some.work[0].expected,
              whole.work[2].expected / whole.work[0].expected, 0.3);
  EXPECT_NEAR(some.work[5].expected / some.work[7].expected,
              whole.work[5].expected / whole.work[7].expected, 0.3);
  EXPECT_GT(some.work[5].expected, some.work[3].expected);
}

TEST_F(SweepForecasts, TheLongestRunsAreNamedAndABudgetIsCompared) {
  const plan::SweepPlan plan = plan_of("frames = [4, 4, 5, 80]\n");
  const plan::SweepForecast forecast =
      plan::foresee_sweep(plan, all(plan), plan::whole_effort(1), 1);
  const auto text = [&](double budget) {
    return plan::forecast_text(plan, all(plan), forecast, 2, budget);
  };
  EXPECT_TRUE(text(0).starts_with("forecast: 4 runs, about ")) << text(0);
  EXPECT_NE(text(0).find(" on 2 cores\nthe longest: run 3, "), std::string::npos) << text(0);
  EXPECT_NE(text(1e-3).find("; the budget of 0 s is enough for about 0 of them"), std::string::npos)
      << text(1e-3);
  EXPECT_EQ(text(1e6).find("budget"), std::string::npos);
}

/// Seconds until all runs have ended that start in an order on some cores, one core each.
double end_of(const std::vector<std::size_t>& order, const std::vector<double>& work, int cores) {
  std::vector<double> free_at(static_cast<std::size_t>(cores), 0);
  for (const std::size_t k : order) *std::min_element(free_at.begin(), free_at.end()) += work[k];
  return *std::max_element(free_at.begin(), free_at.end());
}

TEST(LongestFirst, LeavesNoCoreWaitingForTheLastRun) {
  const std::vector<double> work{10, 10, 10, 10, 10, 10, 10, 10, 10, 60};
  const std::vector<std::size_t> given{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const std::vector<std::size_t> order = plan::longest_first(given, work);
  EXPECT_EQ(order.front(), 9u);
  EXPECT_EQ(end_of(given, work, 2), 100);
  EXPECT_EQ(end_of(order, work, 2), 80);
}

TEST(LongestFirst, RunsThatTakeAboutAsLongKeepTheirOrder) {
  EXPECT_EQ(plan::longest_first({3, 0, 2, 1}, {10, 11, 10.5, 12}),
            (std::vector<std::size_t>{3, 0, 2, 1}));
  EXPECT_EQ(plan::longest_first({0, 1, 2, 3}, {10, 30, 11, 31}),
            (std::vector<std::size_t>{1, 3, 0, 2}));
  EXPECT_EQ(plan::longest_first({}, {}), (std::vector<std::size_t>{}));
}

TEST(SweepThreads, ARunThatIsMostOfWhatIsLeftGetsSeveralThreads) {
  sweep::Run run;
  run.particles = 1e5;
  run.memory = 1e8;
  run.work = 100;
  EXPECT_EQ(jobs::threads_for(run, {2, 200}, 2, 64e9), 1);
  EXPECT_EQ(jobs::threads_for(run, {3, 120}, 2, 64e9), 2);
  EXPECT_EQ(jobs::threads_for(run, {9, 180}, 8, 64e9), 4);
  EXPECT_EQ(jobs::threads_for(run, {9, 900}, 8, 64e9), 1);
  run.particles = 5000;
  EXPECT_EQ(jobs::threads_for(run, {3, 120}, 2, 64e9), 1) << "too small to share";
}

}  // namespace
}  // namespace neve::app::sweep
