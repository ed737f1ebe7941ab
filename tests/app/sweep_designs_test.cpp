/// Samples that fill space evenly, screenings, and conditions between axes.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "app/scene/toml/error.h"
#include "app/sweep/plan/designs.h"
#include "app/sweep/plan/expand.h"
#include "app/sweep/read/read_sweep.h"
#include "app/sweep/sheet/effects.h"
#include "tests/support/temporary_folder.h"

namespace neve::app::sweep {
namespace {

constexpr std::uint64_t seed = 7;

/// Each axis is a (0, 1)-sequence: of any aligned 2^k points, one lies in each of 2^k parts. A
/// wrong direction number breaks that.
TEST(SobolPlaces, EveryPartOfEveryAxisIsMetOnce) {
  for (std::size_t axis = 0; axis < plan::max_sobol_axes; ++axis)
    for (const std::uint32_t count : {2u, 16u, 64u, 256u, 1024u})
      for (const std::uint32_t first : {0u, count, 3 * count}) {
        std::set<int> parts;
        for (std::uint32_t k = 0; k < count; ++k) {
          const double u = plan::sobol_place(first + k, axis, seed);
          ASSERT_GE(u, 0);
          ASSERT_LT(u, 1);
          parts.insert(static_cast<int>(u * count));
        }
        EXPECT_EQ(parts.size(), count) << "axis " << axis << " from " << first;
      }
}

/// Squared L2-star discrepancy (Warnock 1972).
double discrepancy(const std::vector<std::vector<double>>& points) {
  const auto n = static_cast<double>(points.size());
  const std::size_t d = points.front().size();
  double single = 0, pairs = 0;
  for (const auto& x : points) {
    double product = 1;
    for (std::size_t a = 0; a < d; ++a) product *= (1 - x[a] * x[a]) / 2;
    single += product;
    for (const auto& y : points) {
      double both = 1;
      for (std::size_t a = 0; a < d; ++a) both *= 1 - std::max(x[a], y[a]);
      pairs += both;
    }
  }
  return std::pow(1.0 / 3, static_cast<double>(d)) - 2 / n * single + pairs / (n * n);
}

/// Uniform samples have the expected square (2^-d - 3^-d) / n. Two axes at a time show correlated
/// direction numbers, which all axes together would hide.
TEST(SobolPlaces, PairsOfAxesAreMoreEvenThanChance) {
  constexpr std::uint32_t count = 1024;
  const double chance = (1.0 / 4 - 1.0 / 9) / count;
  double worst = 0, mean = 0;
  int pairs = 0;
  for (std::size_t a = 0; a < plan::max_sobol_axes; ++a)
    for (std::size_t b = 0; b < a; ++b) {
      std::vector<std::vector<double>> points;
      for (std::uint32_t k = 0; k < count; ++k)
        points.push_back({plan::sobol_place(k, a, seed), plan::sobol_place(k, b, seed)});
      const double share = discrepancy(points) / chance;
      worst = std::max(worst, share);
      mean += share;
      ++pairs;
    }
  EXPECT_LT(worst, 0.5);
  EXPECT_LT(mean / pairs, 0.05);
}

/// Six axes: far below chance, and another seed gives other points that are as even.
TEST(SobolPlaces, SixAxesAreEvenForAnySeed) {
  constexpr std::uint32_t count = 128;
  const double chance = (std::pow(2.0, -6) - std::pow(3.0, -6)) / count;
  std::set<double> firsts;
  for (std::uint64_t s = 1; s <= 5; ++s) {
    std::vector<std::vector<double>> points;
    for (std::uint32_t k = 0; k < count; ++k) {
      points.emplace_back();
      for (std::size_t a = 0; a < 6; ++a) points.back().push_back(plan::sobol_place(k, a, s));
    }
    EXPECT_LT(discrepancy(points), 0.4 * chance) << "seed " << s;
    firsts.insert(points[0][0]);
  }
  EXPECT_EQ(firsts.size(), 5u);
}

TEST(MorrisTrajectories, ChangeOneAxisAtATimeAndEachOnce) {
  for (std::uint64_t t = 0; t < 50; ++t) {
    const auto points = plan::morris_trajectory(t, 5, seed);
    ASSERT_EQ(points.size(), 6u);
    std::set<std::size_t> moved;
    for (std::size_t k = 1; k < points.size(); ++k)
      for (std::size_t a = 0; a < 5; ++a) {
        ASSERT_GE(points[k][a], 0);
        ASSERT_LT(points[k][a], plan::morris_levels);
        if (points[k][a] == points[k - 1][a]) continue;
        EXPECT_EQ(std::abs(points[k][a] - points[k - 1][a]), plan::morris_step);
        EXPECT_TRUE(moved.insert(a).second);
      }
    EXPECT_EQ(moved.size(), 5u);
  }
}

/// Runs of a screening whose first metric is a function of the levels.
struct Screening {
  store::Manifest manifest;
  std::vector<store::RunResult> results;

  template <class F>
  Screening(std::size_t axes, std::uint64_t trajectories, const F& f) {
    for (std::size_t a = 0; a < axes; ++a)
      manifest.screened.push_back({"axis " + std::to_string(a), {}, {"a" + std::to_string(a)}});
    for (std::uint64_t t = 0; t < trajectories; ++t)
      for (const std::vector<int>& levels : plan::morris_trajectory(t, axes, seed)) {
        Run& run = manifest.runs.emplace_back();
        run.index = static_cast<int>(manifest.runs.size()) - 1;
        run.coordinates = levels;
        std::vector<double> x;
        for (const int level : levels) x.push_back(level / (plan::morris_levels - 1.0));
        store::RunResult& result = results.emplace_back();
        result.status.state = store::RunState::ok;
        result.frames = {0};
        result.metrics.resize(store::metric_infos().size());
        result.metrics[0] = f(x);
      }
  }
  std::vector<sheet::Effect> effects() const { return sheet::effects_on(manifest, results, 0); }
};

/// 3 x0 - 2 x1 + 5 x2 x3 + 0 x4: the effects of a line are its slope, without spread; of a product,
/// the mean of the other factor (levels 0, 1/3, 2/3, 1: one half) and their deviation (0.373).
TEST(MorrisEffects, AreThoseOfAKnownFunction) {
  const Screening screening(
      5, 400, [](const std::vector<double>& x) { return 3 * x[0] - 2 * x[1] + 5 * x[2] * x[3]; });
  const std::vector<sheet::Effect> e = screening.effects();
  ASSERT_EQ(e.size(), 5u);
  for (const sheet::Effect& effect : e) EXPECT_EQ(effect.steps, 400);
  EXPECT_NEAR(e[0].mean, 3, 1e-12);
  EXPECT_NEAR(e[0].spread, 0, 1e-12);
  EXPECT_NEAR(e[1].mean, -2, 1e-12);
  EXPECT_NEAR(e[1].strength, 2, 1e-12);
  // 400 draws of a deviation of 5 x 0.373: the mean errs by 0.09, three times that is allowed.
  for (const std::size_t a : {2u, 3u}) {
    EXPECT_NEAR(e[a].mean, 2.5, 0.28);
    EXPECT_NEAR(e[a].spread, 5 * 0.373, 0.2);
    EXPECT_TRUE(e[a].is_one_way());
  }
  EXPECT_EQ(e[4].strength, 0);
}

/// The deviation tells a parameter that does both from one that does nothing.
TEST(MorrisEffects, ThatCancelAreStrongAllTheSame) {
  const Screening screening(
      2, 200, [](const std::vector<double>& x) { return 4 * (x[0] - 0.5) * (x[1] - 0.5); });
  const sheet::Effect e = screening.effects()[0];
  EXPECT_LT(std::abs(e.mean), 0.4);
  EXPECT_GT(e.strength, 1);
  EXPECT_FALSE(e.is_one_way());
}

/// A run that did not get to its end takes two steps with it, and no more.
TEST(MorrisEffects, LeaveOutRunsThatFailed) {
  Screening screening(3, 10, [](const std::vector<double>& x) { return x[0] + x[1] + x[2]; });
  screening.results[5].status.state = store::RunState::diverged;
  screening.results[5].metrics[0] = 1e9;
  screening.results[5].frames.clear();
  int steps = 0;
  for (const sheet::Effect& effect : screening.effects()) {
    steps += effect.steps;
    EXPECT_NEAR(effect.mean, 1, 1e-12);
  }
  EXPECT_EQ(steps, 28);
  const std::string svg = sheet::effects_svg(screening.manifest, screening.results, true);
  EXPECT_NE(svg.find("axis 2"), std::string::npos);
  EXPECT_EQ(sheet::effect_lines(screening.manifest, screening.results).size(), 1u);
  EXPECT_NE(sheet::effects_csv(screening.manifest, screening.results).find("spread,m,\"a0\","),
            std::string::npos);
}

class Designs : public testing::Test {
 protected:
  Designs() {
    folder_.write("scene.toml",
                  "[[body]]\nshape = { sphere = { center = [0, 1, 0], radius = 0.1 } }\n");
  }
  std::vector<sweep::Run> runs(const std::string& text) {
    folder_.write("sweep.toml", "[sweep]\nscene = \"scene.toml\"\n" + text);
    return plan::expand(read::read_sweep((folder_ / "sweep.toml").string(), {}));
  }
  /// "LINE:COLUMN MESSAGE; HINT"
  std::string complaint(const std::string& text) {
    try {
      runs(text);
    } catch (const scene::toml::SceneError& error) {
      return std::to_string(error.line) + ":" + std::to_string(error.column) + " " + error.message +
             "; " + error.hint;
    }
    return "";
  }
  test::TemporaryFolder folder_;
};

const std::string two_axes =
    "[axis]\n\"material.snow.critical_compression\" = { uniform = [0.01, 0.05] }\n"
    "\"material.snow.critical_stretch\" = { log_uniform = [0.001, 0.05] }\n"
    "\"solver.transfer\" = [\"flip\", \"apic\", \"mls\"]\n";

std::vector<std::vector<std::string>> texts(const std::vector<Run>& runs) {
  std::vector<std::vector<std::string>> list;
  for (const Run& run : runs) {
    list.emplace_back();
    for (const scene::Override& setting : run.settings) list.back().push_back(setting.value);
  }
  return list;
}

/// Few whole numbers and entries of lists take other shares of their range than the levels do.
TEST_F(Designs, EffectsAreForTheWholeRangeOfListsWholeNumbersAndDistributions) {
  folder_.write("sweep.toml",
                "[sweep]\nscene = \"scene.toml\"\nmethod = \"morris\"\nsamples = 20\n[axis]\n"
                "\"material.snow.hardening\" = [5, 10]\n"
                "\"material.snow.critical_compression\" = [0.01, 0.02, 0.03]\n"
                "\"material.snow.density\" = [500, 400, 300, 200, 100]\n"
                "\"material.snow.critical_stretch\" = { log_uniform = [0.001, 0.05] }\n"
                "\"material.snow.youngs_modulus\" = { normal = [1e5, 1e4] }\n"
                "seed = { uniform = [1, 3] }\n"
                "fps = [24]\n"
                "\"solver.transfer\" = [\"flip\", \"apic\", \"mls\"]\n");
  const read::Sweep sweep = read::read_sweep((folder_ / "sweep.toml").string(), {});
  store::Manifest manifest;
  manifest.parameters = {{"solver.transfer", "transfer", "", "choice"}};
  for (const read::Axis& axis : sweep.axes) {
    const std::string address = axis.parameters.front().address;
    manifest.screened.push_back({address, {}, {address}, plan::level_shares(axis)});
  }
  manifest.runs = plan::expand(sweep);
  std::vector<store::RunResult> results;
  for (const sweep::Run& run : manifest.runs) {
    const auto x = [&](const char* address) { return std::stod(run.setting(address)); };
    store::RunResult& result = results.emplace_back();
    result.status.state = store::RunState::ok;
    result.frames = {0};
    result.metrics.resize(store::metric_infos().size());
    result.metrics[0] =
        x("material.snow.hardening") + 1000 * x("material.snow.critical_compression") +
        0.01 * x("material.snow.density") + std::log(x("material.snow.critical_stretch")) +
        1e-4 * x("material.snow.youngs_modulus") + x("seed") +
        (run.setting("solver.transfer") == "\"flip\"" ? 0 : 7);
  }
  const double expected[] = {5, 20, 4, std::log(50), 2 * plan::normal_quantile(0.95), 2};
  const std::vector<sheet::Effect> effects = sheet::effects_on(manifest, results, 0);
  ASSERT_EQ(effects.size(), sweep.axes.size());
  for (std::size_t a = 0; a < std::size(expected); ++a) {
    EXPECT_NEAR(effects[a].mean, expected[a], 1e-4) << manifest.screened[a].name;
    EXPECT_NEAR(effects[a].spread, 0, 1e-4) << manifest.screened[a].name;
    EXPECT_EQ(effects[a].steps, 20);
  }
  EXPECT_EQ(effects[6].steps, 0) << "one value has no range";
  EXPECT_GT(effects[7].strength, 0) << "a step between two others than flip changes nothing";
  EXPECT_LE(effects[7].strength, 7);
}

TEST_F(Designs, MoreSamplesKeepTheFirstOnes) {
  for (const char* method : {"sobol", "random", "morris"})
    for (const char* where :
         {"", "where = [\"critical_stretch < 0.3 * critical_compression\"]\n"}) {
      const std::string head = std::string("method = \"") + method + "\"\n" + where;
      const auto few = texts(runs(head + "samples = 32\n" + two_axes));
      auto many = texts(runs(head + "samples = 64\n" + two_axes));
      ASSERT_EQ(many.size(), 2 * few.size()) << method;
      many.resize(few.size());
      EXPECT_EQ(few, many) << method;
    }
}

TEST_F(Designs, AScreeningHasOneMoreRunThanAxesForEachTrajectory) {
  const auto list = runs("method = \"morris\"\nsamples = 6\n" + two_axes);
  ASSERT_EQ(list.size(), 24u);
  for (std::size_t k = 0; k < list.size(); ++k) {
    ASSERT_EQ(list[k].coordinates.size(), 3u);
    int changes = 0;
    if (k % 4 == 0) continue;
    for (std::size_t a = 0; a < 3; ++a)
      changes += list[k].settings[a].value != list[k - 1].settings[a].value;
    EXPECT_EQ(changes, 1) << "run " << k;
  }
}

TEST_F(Designs, WholeNumbersAreDrawnAsOftenAsTheirShareOfTheAxis) {
  const auto counts = [&](const std::string& method, int samples, const std::string& rule) {
    std::map<std::string, int> count;
    for (const sweep::Run& run :
         runs("method = \"" + method + "\"\nsamples = " + std::to_string(samples) +
              "\n[axis]\nseed = { " + rule + " }\n"))
      ++count[run.settings[0].value];
    return count;
  };
  using Counts = std::map<std::string, int>;
  EXPECT_EQ(counts("lhs", 60, "uniform = [1, 3]"), (Counts{{"1", 20}, {"2", 20}, {"3", 20}}));
  EXPECT_EQ(counts("sobol", 64, "uniform = [0.5, 4.5]"),
            (Counts{{"1", 16}, {"2", 16}, {"3", 16}, {"4", 16}}));
  // log(3), log(5 / 3) and log(7 / 5) of log(7).
  Counts logarithmic = counts("lhs", 1000, "log_uniform = [1, 3]");
  EXPECT_NEAR(logarithmic["1"], 564.6, 1);
  EXPECT_NEAR(logarithmic["2"], 262.5, 1);
  EXPECT_NEAR(logarithmic["3"], 172.9, 1);
}

TEST_F(Designs, ConditionsHoldInEveryRun) {
  const std::string strong = "critical_stretch < 0.3 * critical_compression";
  for (const char* method : {"sobol", "random", "morris"}) {
    // Each trajectory of a screening visits two values of each axis that are far apart.
    const bool is_screening = method == std::string("morris");
    const std::string where = "where = [\"" + strong + "\"" +
                              (is_screening ? "" : ", \"solver.transfer != 'mls'\"") + "]\n";
    const auto list =
        runs(std::string("method = \"") + method + "\"\nsamples = 9\n" + where + two_axes);
    EXPECT_EQ(list.size(), is_screening ? 36u : 9u);
    for (const sweep::Run& run : list) {
      EXPECT_LT(std::stod(run.settings[1].value), 0.3 * std::stod(run.settings[0].value));
      if (!is_screening) {
        EXPECT_NE(run.settings[2].value, "\"mls\"");
      }
    }
  }
  const auto grid =
      runs("where = [\"2 * fps >= seed\"]\n[axis]\nfps = [1, 2, 3]\nseed = [1, 4, 6]\n");
  ASSERT_EQ(grid.size(), 6u);
  EXPECT_EQ(grid[1].coordinates, (std::vector<int>{1, 0}));
  EXPECT_EQ(grid[1].index, 1);
}

TEST_F(Designs, ConditionsBySizeNeedNumbers) {
  const std::string axes = "[axis]\nfps = [1, 2]\n\"solver.transfer\" = [\"flip\", \"apic\"]\n";
  const std::string why =
      "solver.transfer has values without a size, such as \"flip\"; use == or !=, with a text in "
      "quotes, or leave values out of the axis";
  for (const char* where :
       {"transfer < 3", "transfer >= fps", "fps > transfer", "2 * transfer == 1"})
    EXPECT_EQ(complaint(std::string("where = [\"") + where + "\"]\n" + axes),
              std::string("3:9 where = \"") + where + "\": " + why);
  EXPECT_EQ(runs("where = [\"transfer != 'apic'\"]\n" + axes).size(), 2u);
}

TEST_F(Designs, ConditionsThatMeanNothingAreExplained) {
  const std::string axes = "[axis]\nfps = [1, 2]\nseed = [1, 2]\n";
  const std::vector<std::pair<const char*, const char*>> cases{
      {"fsp < 2", "3:9 where = \"fsp < 2\": \"fsp\" is not an axis of the sweep; did you mean"},
      {"fps", "3:9 where = \"fps\": it compares nothing; expected two sides"},
      {"fps <", "3:9 where = \"fps <\": a side is empty; expected two sides"},
      {"1 < 2", "3:9 where = \"1 < 2\": it names no axis; expected"},
      {"fps * seed < 2",
       "3:9 where = \"fps * seed < 2\": \"fps * seed\" is not a number times an axis"},
      {"seed < 3*", "3:9 where = \"seed < 3*\": an axis is missing; expected two sides"},
      {"seed < 3 fps", "3:9 where = \"seed < 3 fps\": \"3 fps\" is not an axis, nor a number"},
      {"seed < fps + 1", "3:9 where = \"seed < fps + 1\": \"fps + 1\" is not an axis"},
      {"1 < seed < 3", "3:9 where = \"1 < seed < 3\": it compares twice; write a condition for"},
      {"fps < 'a'", "3:9 where = \"fps < 'a'\": text compares only with == and !="},
      {"fps > 9", "3:9 no run meets the conditions; make them weaker"}};
  for (const auto& [condition, expected] : cases) {
    const std::string found = complaint(std::string("where = [\"") + condition + "\"]\n" + axes);
    EXPECT_TRUE(found.starts_with(expected)) << found << "\n  instead of " << expected;
  }
  EXPECT_TRUE(complaint("method = \"sobol\"\nsamples = 4\nwhere = [\"fps > 3\"]\n" + axes)
                  .starts_with("5:9 only 0 of "));
  EXPECT_TRUE(complaint("method = \"lhs\"\nsamples = 4\nwhere = [\"fps < 3\"]\n" + axes)
                  .starts_with("5:9 where would leave parts of an axis empty"));
}

}  // namespace
}  // namespace neve::app::sweep
