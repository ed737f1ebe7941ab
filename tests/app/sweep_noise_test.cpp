/// Sweeps with seeds: the statistics of points, and what tiles and tables say of noise.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "app/support/errors.h"
#include "app/sweep/plan/expand.h"
#include "app/sweep/plan/order.h"
#include "app/sweep/sheet/data_csv.h"
#include "app/sweep/sheet/effects.h"
#include "app/sweep/sheet/metric_plots.h"
#include "app/sweep/sheet/seals.h"
#include "app/sweep/sheet/sheet_layout.h"
#include "app/sweep/store/points.h"
#include "app/sweep/store/refine.h"
#include "app/sweep/store/statistics.h"
#include "tests/support/cinema.h"

namespace neve::app::sweep::store {
namespace {

constexpr double rounding = 1e-12;

TEST(Statistics, TailsOfStudentAreTheClosedFormsOfOneAndTwoDegrees) {
  for (const double t : {0.0, 0.1, 0.7, 1.0, 2.5, 12.7062, 300.0}) {
    EXPECT_NEAR(t_tail(t, 1), 1 - 2 / std::numbers::pi * std::atan(t), rounding) << t;
    EXPECT_NEAR(t_tail(t, 2), 1 - t / std::sqrt(2 + t * t), rounding) << t;
    EXPECT_EQ(t_tail(t, 3.7), t_tail(-t, 3.7)) << t;
  }
  // Tables have seven digits.
  EXPECT_NEAR(t_tail(2.570582, 5), 0.05, 1e-7);
  EXPECT_NEAR(t_tail(2.228139, 10), 0.05, 1e-7);
  EXPECT_NEAR(t_tail(1.983972, 100), 0.05, 1e-7);
}

TEST(Statistics, TailsOfFAreTheClosedFormOfTwoDegreesAndTheSquareOfStudent) {
  for (const double f : {0.0, 0.3, 1.0, 4.1028, 50.0}) {
    for (const double within : {1.0, 3.0, 12.0, 200.0}) {
      EXPECT_NEAR(f_tail(f, 2, within), std::pow(1 + 2 * f / within, -0.5 * within), rounding);
      EXPECT_NEAR(f_tail(f, 1, within), t_tail(std::sqrt(f), within), rounding);
    }
  }
  EXPECT_NEAR(f_tail(3.490295, 3, 12), 0.05, 1e-7);  // of a table
  EXPECT_NEAR(f_tail(1e300, 3, 12), 0, rounding);
}

Summary point(double mean, double variance, std::size_t count = 4) {
  return {count, mean, mean, mean, variance};
}

TEST(Statistics, TwoPointsDifferBeyondWelchsInterval) {
  // Equal variances of four values each: t of 6 degrees, 2.446912, times sqrt(2 / 4).
  EXPECT_FALSE(differ(point(0, 1), point(1.730, 1)));
  EXPECT_TRUE(differ(point(0, 1), point(1.731, 1)));
  // Only one point varies: t of 3 degrees, 3.182446, times sqrt(1 / 4).
  EXPECT_FALSE(differ(point(0, 0), point(-1.591, 1)));
  EXPECT_TRUE(differ(point(0, 0), point(-1.592, 1)));
  // Variances of 1 and 9, three and five values: 5.455 degrees, t = 2.507 by interpolating tables.
  const double scale = std::sqrt(1.0 / 3 + 9.0 / 5);
  EXPECT_FALSE(differ(point(0, 1, 3), point(2.4 * scale, 9, 5)));
  EXPECT_TRUE(differ(point(0, 1, 3), point(2.6 * scale, 9, 5)));
}

TEST(Statistics, WithoutNoiseAnyDifferenceAboveRoundingIsOne) {
  EXPECT_TRUE(differ(point(1, 0), point(1.001, 0)));
  EXPECT_FALSE(differ(point(1, 0), point(1 + 1e-12, 0)));
  EXPECT_EQ(vary({point(1, 0), point(1, 0), point(2, 0)}), Verdict::real);
  EXPECT_EQ(vary({point(1, 0), point(1, 0)}), Verdict::noise);
}

TEST(Statistics, OneRunTellsNothing) {
  EXPECT_FALSE(differ(point(0, 0, 1), point(100, 0.01)));
  EXPECT_FALSE(differ(point(0, 0, 0), point(100, 0.01)));
  EXPECT_EQ(vary({point(0, 0, 1), point(1, 0, 1)}), Verdict::unknown);
  EXPECT_EQ(change({{point(0, 0, 1), point(1, 0, 1)}}), Verdict::unknown);
  EXPECT_EQ(vary({point(0, 1), point(0, 0, 0)}), Verdict::unknown) << "no second point";
  EXPECT_EQ(change({}), Verdict::unknown);
  EXPECT_EQ(summary_of({}).count, 0u);
  EXPECT_EQ(summary_of({3}).variance, 0);
}

TEST(Statistics, AMetricVariesByTheTestOfAnAnalysisOfVariance) {
  // A textbook's: F = 9.3 of 2 and 15 degrees.
  const Summary a = summary_of({6, 8, 4, 5, 3, 4}), b = summary_of({8, 12, 9, 11, 6, 8}),
                c = summary_of({13, 9, 11, 8, 7, 12});
  EXPECT_DOUBLE_EQ(a.mean, 5);
  EXPECT_DOUBLE_EQ(a.variance, 3.2);
  EXPECT_EQ(b.min, 6);
  EXPECT_EQ(b.max, 12);
  EXPECT_EQ(vary({a, b, c}), Verdict::real);
  EXPECT_EQ(vary({b, c}), Verdict::noise);  // F = 1.5 of 1 and 10 degrees
  // Three points of four values and variance 1: F = 4 times the variance of their means, 4.256495
  // of 2 and 9 degrees.
  const double edge = std::sqrt(4.256495 / 4);
  EXPECT_EQ(vary({point(-0.999 * edge, 1), point(0, 1), point(0.999 * edge, 1)}), Verdict::noise);
  EXPECT_EQ(vary({point(-1.001 * edge, 1), point(0, 1), point(1.001 * edge, 1)}), Verdict::real);
}

TEST(Statistics, StepsChangeAMetricByTheTestOfTheirMeanSquare) {
  // Two steps of d between points of four values: F = 2 d^2 of 2 and 12 degrees, 3.885294.
  const double edge = std::sqrt(3.885294 / 2);
  const auto steps = [&](double d) {
    return std::vector<std::pair<Summary, Summary>>{{point(0, 1), point(d, 1)},
                                                    {point(5, 1), point(5 - d, 1)}};
  };
  EXPECT_EQ(change(steps(0.999 * edge)), Verdict::noise);
  EXPECT_EQ(change(steps(1.001 * edge)), Verdict::real);
}

TEST(Statistics, PointsTooCloseToCallShareARankAndALetter) {
  // The middle one is as wide as both ends are apart.
  const std::vector<Summary> points{point(0, 0.01), point(1, 1), point(2, 0.01), {}};
  EXPECT_EQ(shared_ranks(points), (std::vector<int>{2, 1, 1, 0}));
  const auto groups = close_groups(points);
  EXPECT_EQ(groups, (std::vector<std::vector<int>>{{1}, {0, 1}, {0}, {}}));
  EXPECT_EQ(group_letters(groups[1]), "ab");
  EXPECT_EQ(group_letters({0, 1, 2, 3}), "a to d");
  EXPECT_EQ(group_letters({0, 1, 2, 3, 27}), "a to d, b2");
  EXPECT_EQ(group_letters({0, 1, 3, 4}), "ab, de") << "it has no c";
  const std::vector<double> shared = shared_means(points, shared_ranks(points));
  EXPECT_EQ(shared[1], 1.5);
  EXPECT_EQ(shared[1], shared[2]);
  EXPECT_EQ(shared[0], 0);
}

TEST(Statistics, TwoPointsShareALetterExactlyWhereTheyAreTooCloseToCall) {
  std::vector<Summary> points;
  for (int k = 0; k < 40; ++k)
    points.push_back(point(std::fmod(k * 7.3, 10), 0.05 + std::fmod(k * 1.7, 3)));
  const auto groups = close_groups(points);
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t b = a + 1; b < points.size(); ++b) {
      const bool is_shared = std::any_of(groups[a].begin(), groups[a].end(), [&](int group) {
        return std::count(groups[b].begin(), groups[b].end(), group) > 0;
      });
      ASSERT_EQ(is_shared, !differ(points[a], points[b])) << a << " and " << b;
    }
}

/// Three points of four seeds, on an axis; spread tells them apart but for the first two, height is
/// noise, and the second breaks in one seed.
struct MadeSweep {
  Manifest manifest;
  std::vector<RunResult> results;
};

MadeSweep sweep_of_seeds() {
  MadeSweep sweep;
  Manifest& m = sweep.manifest;
  m.view = "particles";
  m.title = "Noise";
  m.tile_label = "differences";
  m.seeds = 4;
  m.parameters = {{"m.hardening", "hardening", "", "number"}, {"seed", "seed", "", "integer"}};
  m.axes = {{"hardening", {"5", "10", "20"}, {"m.hardening"}}};
  const double spread[] = {0.50, 0.51, 0.90};
  for (int k = 0; k < 12; ++k) {
    Run& run = m.runs.emplace_back();
    run.index = k;
    run.folder = run_folder_name(k);
    run.coordinates = {k / 4};
    run.settings = {{"m.hardening", std::to_string(5 << (k / 4))},
                    {"seed", std::to_string(1 + k % 4)}};
    RunResult& result = sweep.results.emplace_back();
    result.status.state = RunState::ok;
    result.metrics.resize(metric_infos().size());
    result.metrics[0] = spread[k / 4] + 0.01 * (k % 4);
    result.metrics[1] = 0.1 + 0.02 * ((k * 5) % 4);
    result.has_broken = k == 6;
  }
  return sweep;
}

TEST(Noise, ATileSaysHowOftenTheSnowBreaksAndWhichTilesAreTooCloseToCall) {
  const MadeSweep sweep = sweep_of_seeds();
  const sheet::Seals seals = sheet::seals_of(sweep.manifest, sweep.results, {});
  ASSERT_EQ(seals.of_points.size(), 3u);
  EXPECT_EQ(seals.of_points[0].outcome, "holds in 4 of 4");
  EXPECT_EQ(seals.of_points[1].outcome, "breaks in 1 of 4: not here");
  EXPECT_TRUE(seals.of_points[1].is_undecided);
  EXPECT_EQ(seals.of_points[0].groups, std::vector<int>{1});
  EXPECT_EQ(seals.of_points[1].groups, std::vector<int>{1});
  EXPECT_EQ(seals.of_points[2].groups, std::vector<int>{0});
  EXPECT_EQ(seals.of_points[0].whisker.span.min, 0);
  EXPECT_EQ(seals.of_points[2].whisker.span.max, 1);
  EXPECT_EQ(seals.title, "spread");
  ASSERT_EQ(seals.key.size(), 5u);
  EXPECT_EQ(seals.key[0].text,
            "no letter in common: their spread differs for real, by more than other seeds change "
            "it (95 %)");
  EXPECT_EQ(seals.key[1].text, "a letter in common: too close to call");
  EXPECT_EQ(seals.key[2].text,
            "spread of 4 seeds, from min to max (bar), and their mean (square, number)");
  EXPECT_EQ(seals.key[3].text, "the line goes from 0.5 to 0.93 m on every tile");
  EXPECT_EQ(seals.key[4].mark, sheet::KeyLine::Mark::doubt);
  const std::vector<Point> points = points_of(sweep.manifest, sweep.results);
  EXPECT_FALSE(is_noise(sweep.manifest, points, 0));
  EXPECT_TRUE(is_noise(sweep.manifest, points, 1));
}

/// Copies of two resolutions of snow that breaks.
predict::Prediction prediction_of(double spread) {
  std::vector<predict::Copy> copies(3);
  for (predict::Copy& copy : copies) {
    copy.coarsening = &copy == copies.data() ? 1.5 : 2;
    copy.has_broken = true;
    copy.whole = 0.5;
    std::fill(std::begin(copy.values), std::end(copy.values), 1);
    copy.values[static_cast<int>(predict::Quantity::spread)] = spread;
  }
  return predict::judge(copies);
}

TEST(Noise, ATileSaysWhatIsPredictedAndWhichIntervalsOverlap) {
  MadeSweep sweep = sweep_of_seeds();
  const std::vector<predict::Prediction> predictions{prediction_of(0.5), prediction_of(0.52),
                                                     predict::silent("a copy diverged")};
  const sheet::Seals seals = sheet::seals_of(sweep.manifest, sweep.results, predictions);
  ASSERT_EQ(seals.of_points.size(), 3u);
  EXPECT_EQ(seals.of_points[1].outcome,
            "expected at full resolution: breaks; coarse: breaks in 1 of 4");
  EXPECT_FALSE(seals.of_points[1].is_undecided) << "what counts is the prediction";
  EXPECT_TRUE(seals.of_points[2].is_undecided);
  EXPECT_EQ(seals.of_points[2].whisker.value, "") << "where copies cannot say there is no number";
  EXPECT_TRUE(seals.is_noise) << "0.5 and 0.52 m with 7 % each";
  EXPECT_TRUE(seals.key[0].text.starts_with("all tiles are too close to call: "));
  const sheet::Seals apart = sheet::seals_of(sweep.manifest, sweep.results,
                                             {predictions[0], prediction_of(0.6), predictions[2]});
  // The key explains each mark on the tiles: letters, white, blue and yellow.
  const auto explained = [](const sheet::Seals& of, sheet::KeyLine::Mark mark) {
    const auto found = std::find_if(of.key.begin(), of.key.end(),
                                    [&](const sheet::KeyLine& line) { return line.mark == mark; });
    return found == of.key.end() ? std::string() : found->text;
  };
  using Mark = sheet::KeyLine::Mark;
  EXPECT_NE(explained(apart, Mark::apart), "");
  EXPECT_NE(explained(apart, Mark::together), "");
  EXPECT_EQ(explained(apart, Mark::whisker),
            "expected: spread at full resolution (square, number), and the interval in which four "
            "of five full runs end (bar)");
  EXPECT_EQ(explained(apart, Mark::coarse),
            "coarse: spread of the 4 coarse seeds, from min to max (bar), and their mean (square, "
            "number)");
  EXPECT_NE(explained(apart, Mark::doubt), "");
  EXPECT_EQ(explained(apart, Mark::full), "") << "no tile is at full resolution";
  EXPECT_EQ(apart.of_points[0].groups, std::vector<int>{1});
  EXPECT_EQ(apart.of_points[1].groups, std::vector<int>{0});
  EXPECT_EQ(prediction_line(predictions),
            "at full resolution, by coarse copies of 3 points: breaks 2, cannot say 1");
}

/// A point whose seeds were made at full resolution.
predict::Prediction full_runs(double spread, int runs, int broken) {
  predict::Prediction prediction;
  prediction.is_run = true;
  prediction.runs = runs;
  prediction.broken = broken;
  prediction.verdict = broken == 0      ? predict::Verdict::holds
                       : broken == runs ? predict::Verdict::breaks
                                        : predict::Verdict::undecided;
  prediction.reason = "4 runs at full resolution";
  for (int q = 0; q < predict::quantity_count; ++q)
    prediction.estimates.push_back({static_cast<predict::Quantity>(q), spread, 0.9 * spread,
                                    1.1 * spread, 0.01 * spread * spread});
  return prediction;
}

TEST(Noise, ATileHasTheWhiskerOfCoarseSeedsBesideThatOfFullResolution) {
  const MadeSweep sweep = sweep_of_seeds();
  const sheet::Seals seals =
      sheet::seals_of(sweep.manifest, sweep.results,
                      {full_runs(0.5, 4, 2), predict::silent(""), full_runs(1.5, 4, 4)});
  ASSERT_EQ(seals.of_points.size(), 3u);
  EXPECT_TRUE(seals.of_points[0].outcome.starts_with("full: breaks in 2 of 4; coarse: "))
      << seals.of_points[0].outcome;
  EXPECT_TRUE(seals.of_points[0].is_undecided);
  EXPECT_EQ(seals.of_points[0].whisker.value, "0.5 m");
  EXPECT_NE(seals.of_points[0].coarse.value, "");
  EXPECT_LT(seals.of_points[0].coarse.span.min, seals.of_points[0].coarse.span.max);
  EXPECT_EQ(seals.of_points[1].whisker.value, "") << "not made at full resolution";
  EXPECT_NE(seals.of_points[1].coarse.value, "");
  EXPECT_EQ(seals.of_points[2].whisker.span.max, 1) << "one scale for both";
  EXPECT_LT(seals.of_points[2].coarse.span.max, 1);
  EXPECT_NE(seals.of_points[0].groups, seals.of_points[2].groups) << "Welch's interval";
}

TEST(Noise, RunsAtFullResolutionAreComparedByTheirNoiseAndWithIntervalsByOverlap) {
  const std::vector<Summary> runs =
      summaries_of({full_runs(0.5, 4, 0), full_runs(0.55, 4, 0), full_runs(0.7, 4, 0)},
                   predict::Quantity::spread);
  EXPECT_FALSE(differ(runs[0], runs[1]));
  EXPECT_TRUE(differ(runs[0], runs[2]));
  Summary wide = runs[2];
  wide.is_interval = true;
  wide.min = 0.54;
  EXPECT_FALSE(differ(runs[0], wide)) << "an interval reaches there";
}

TEST(Noise, ALoneRunAtFullResolutionIsOneDraw) {
  const auto lone = [](double spread) {
    predict::Prediction run = full_runs(spread, 1, 0);
    for (predict::Estimate& e : run.estimates) e.low = e.high = e.expected;
    return run;
  };
  const std::vector<Summary> runs =
      summaries_of({lone(0.155), lone(0.162), lone(0.2)}, predict::Quantity::spread);
  EXPECT_EQ(runs[0].mean, 0.155);
  EXPECT_FALSE(differ(runs[0], runs[1])) << "another seed may change as much";
  EXPECT_TRUE(differ(runs[0], runs[2]));
}

TEST(Noise, WhatATileSaysOfNoiseIsBelowItsPicture) {
  sheet::Seals seals;
  EXPECT_EQ(sheet::rows_of(seals, 40), 0);
  seals.of_points.resize(3);
  seals.of_points[1].outcome = "breaks";
  EXPECT_EQ(sheet::rows_of(seals, 40), 1);
  seals.of_points[2] = {"breaks", false, false, {"0.2 m"}, {}, {"0.3 m"}};
  EXPECT_EQ(sheet::rows_of(seals, 40), 3);

  const MadeSweep sweep = sweep_of_seeds();
  const Manifest& manifest = sweep.manifest;
  const sheet::SheetLayout plain = sheet::layout_sheet(manifest, false, 8192),
                           sealed = sheet::layout_sheet(manifest, false, 8192, {seals, ""});
  EXPECT_EQ(plain.seal_height, 0);
  EXPECT_EQ(sealed.seal_height, sheet::rows_height(3, sealed.font_size));
  EXPECT_EQ(sealed.tile_height, plain.tile_height) << "pictures are as large";
  for (const sheet::SheetTile& a : sealed.tiles)
    for (const sheet::SheetTile& b : sealed.tiles) {
      if (a.x != b.x || a.y >= b.y) continue;
      EXPECT_GT(b.y, a.y + sealed.tile_height + sealed.seal_height);
    }
  EXPECT_GT(sealed.height, sealed.tiles.back().y + sealed.tile_height + sealed.seal_height);
}

/// The verdict stands last, and would be what is cut off.
TEST(Noise, WordsOfSmallTilesWrap) {
  sheet::SheetWords words;
  words.seals.of_points.resize(3);
  words.seals.of_points[1].outcome =
      "expected at full resolution: undecided; coarse: breaks in 1 of 4";
  words.heading =
      "frame 4   t = 0.167 s   -   3 points of 4 seeds, 12 runs   -   coarsened 2x, "
      "thresholds for cells of 0.02 m   -   1 of 3 tiles at full resolution";
  MadeSweep sweep = sweep_of_seeds();
  sweep.manifest.tile_width = 160;
  sweep.manifest.tile_height = 100;
  const sheet::SheetLayout plain = sheet::layout_sheet(sweep.manifest, false, 8192),
                           layout = sheet::layout_sheet(sweep.manifest, false, 8192, words);
  const std::size_t letters = sheet::letters_in(layout.tile_width, layout.font_size);
  EXPECT_EQ(sheet::rows_of(words.seals, letters), 4);
  EXPECT_EQ(layout.seal_height, sheet::rows_height(4, layout.font_size));
  render::Frame frame;
  sheet::draw_seal(
      words.seals.of_points[1], words.seals,
      {0, 100, 160, static_cast<float>(layout.seal_height), static_cast<float>(layout.font_size)},
      frame);
  std::string all;
  for (const render::Note& note : frame.notes) {
    EXPECT_LE(note.text.size(), letters) << note.text;
    all += (all.empty() ? "" : " ") + note.text;
  }
  EXPECT_EQ(all, words.seals.of_points[1].outcome);
  EXPECT_GT(layout.tiles.front().y, plain.tiles.front().y) << "a second line of the heading";
}

TEST(Noise, TheLinesOfWhiskersAreEquallyLongOnAllTiles) {
  sheet::Seals seals;
  seals.title = "spread";
  for (const std::vector<int>& groups : {std::vector<int>{0}, {0, 1}, {}}) {
    sheet::Seal& seal = seals.of_points.emplace_back();
    seal.whisker = {"0.2 m", {0.2, 0.5, 0.7}};
    seal.groups = groups;
  }
  std::set<float> lengths;
  for (const sheet::Seal& seal : seals.of_points) {
    render::Frame words;
    sheet::draw_seal(seal, seals, {0, 180, 320, 36, 11}, words);
    float longest = 0;  // but for the patch behind all
    for (std::size_t k = 1; k < words.patches.size(); ++k)
      longest = std::max(longest, words.patches[k].width);
    lengths.insert(longest);
  }
  EXPECT_EQ(lengths.size(), 1u);
}

TEST(Refine, HowWellCoarseRankedIsSaidOfMeans) {
  const MadeSweep sweep = sweep_of_seeds();
  std::vector<std::optional<RunResult>> full(sweep.results.begin(), sweep.results.end());
  full[5].reset();  // one seed that has not ended
  const std::string line = ranking_line(sweep.manifest, sweep.results, full);
  EXPECT_TRUE(line.starts_with("3 points at full resolution: ")) << line;
  EXPECT_NE(line.find("rank correlation of the means of coarse and full: spread 1.00"),
            std::string::npos)
      << line;
  full.assign(full.size(), std::nullopt);
  EXPECT_EQ(ranking_line(sweep.manifest, sweep.results, full), "");
}

TEST(Refine, OpenPointsComeFirstThenTheBestByAMetric) {
  const MadeSweep sweep =
      sweep_of_seeds();  // spreads of about 0.5, 0.5 and 0.9 m; one of four breaks in the second
  const auto chosen = [&](std::size_t count, const std::string& best,
                          const std::vector<predict::Prediction>& predictions) {
    return points_to_refine(sweep.manifest, sweep.results, predictions, count,
                            Best::parse("--best", best));
  };
  using Runs = std::vector<std::size_t>;
  EXPECT_EQ(chosen(1, "spread", {}), Runs{4}) << "its seeds disagree";
  EXPECT_EQ(chosen(2, "spread", {}), (Runs{4, 8}));
  EXPECT_EQ(chosen(2, "spread:least", {}), (Runs{4, 0}));
  EXPECT_EQ(chosen(9, "spread", {}).size(), 3u) << "there are no more";
  predict::Prediction open = prediction_of(0.5);
  open.verdict = predict::Verdict::undecided;
  EXPECT_EQ(chosen(2, "spread", {open, prediction_of(0.5), prediction_of(0.9)}), (Runs{0, 8}))
      << "predictions say more than seeds";
  EXPECT_THROW(Best::parse("--best", "beauty"), UsageError);
  EXPECT_EQ(Best::parse("--best", "height:least").text(), "height:least");
}

TEST(Refine, RankCorrelationIsSpearmans) {
  EXPECT_FALSE(rank_correlation({1, 2}, {1, 2})) << "two points are always in line";
  EXPECT_FALSE(rank_correlation({1, 1, 1}, {1, 2, 3}));
  EXPECT_NEAR(*rank_correlation({1, 2, 30}, {0.1, 5, 6}), 1, rounding);
  EXPECT_NEAR(*rank_correlation({1, 2, 3}, {3, 2, 1}), -1, rounding);
  // 1 - 6 sum d^2 / (n (n^2 - 1)) with d = 0, 1, 1, 0, 0.
  EXPECT_NEAR(*rank_correlation({1, 2, 3, 4, 5}, {1, 3, 2, 4, 5}), 0.9, rounding);
}

TEST(Noise, TablesHavePredictionsWithTheirIntervalsInEachRunOfAPoint) {
  const MadeSweep sweep = sweep_of_seeds();
  const std::vector<predict::Prediction> predictions{prediction_of(0.5), prediction_of(0.6),
                                                     predict::silent("a copy diverged")};
  for (const std::string& csv : {sheet::data_csv(sweep.manifest, sweep.results, predictions),
                                 sheet::points_csv(sweep.manifest, sweep.results, predictions)}) {
    const std::vector<neve::test::CsvRow> rows = neve::test::parse_csv(csv);
    const auto cell = [&](std::size_t row, const std::string& name) {
      const auto found = std::find(rows[0].begin(), rows[0].end(), name);
      return found == rows[0].end() ? "no such column"
                                    : rows[row][static_cast<std::size_t>(found - rows[0].begin())];
    };
    EXPECT_EQ(cell(1, "full_by"), "copies");
    EXPECT_EQ(cell(1, "full_verdict"), "breaks");
    EXPECT_EQ(cell(1, "full_spread"), "0.5");
    EXPECT_EQ(cell(1, "full_spread_high"), "0.535");
    EXPECT_EQ(cell(rows.size() - 1, "full_verdict"), "cannot say");
    EXPECT_EQ(cell(rows.size() - 1, "full_spread"), "");
  }
}

TEST(Noise, ASweepSaysInWordsWhatItsSeedsTell) {
  MadeSweep sweep = sweep_of_seeds();
  const std::vector<std::string> lines = noise_lines(sweep.manifest, sweep.results);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "spread: of 3 pairs of points 2 differ, the others are too close to call");
  EXPECT_EQ(lines[1].find("noise here: height"), 0u) << lines[1];
  EXPECT_EQ(lines[2], "1 of 3 points break with some seeds and hold with others");
  MadeSweep without = sweep;  // a point has no snow left, or its runs did not end
  for (std::size_t k = 4; k < 8; ++k) without.results[k].metrics.assign(metric_infos().size(), {});
  EXPECT_TRUE(noise_lines(without.manifest, without.results)[0].ends_with(
      "the others are too close to call; the runs of 2 more do not tell"))
      << noise_lines(without.manifest, without.results)[0];
  for (std::size_t k = 0; k < 12; ++k) sweep.results[k] = sweep.results[k - k % 4];
  ASSERT_EQ(noise_lines(sweep.manifest, sweep.results).size(), 1u) << "lattices without lumps";
  sweep.manifest.seeds = 1;
  EXPECT_TRUE(noise_lines(sweep.manifest, sweep.results).empty());
}

TEST(Noise, WithoutTwoEndedSeedsOfAPointNothingIsCalledNoise) {
  MadeSweep sweep = sweep_of_seeds();
  for (std::size_t k = 0; k < 12; ++k)
    if (k % 4 != 0) sweep.results[k].status.state = RunState::pending;
  Manifest& m = sweep.manifest;
  const std::vector<Point> points = points_of(m, sweep.results);
  for (const std::size_t metric : {0, 1}) EXPECT_FALSE(is_noise(m, points, metric));
  EXPECT_EQ(noise_lines(m, sweep.results).front(), unknown_words);
  EXPECT_EQ(sheet::metric_plots_svg(m, sweep.results).find("noise here"), std::string::npos);
  const sheet::Seals seals = sheet::seals_of(m, sweep.results, {});
  EXPECT_FALSE(seals.is_noise);
  EXPECT_EQ(seals.key.front().text, unknown_words);
  EXPECT_TRUE(seals.of_points[0].groups.empty());
  EXPECT_NE(seals.of_points[0].whisker.value, "");
  const std::vector<neve::test::CsvRow> rows =
      neve::test::parse_csv(sheet::points_csv(m, sweep.results));
  for (std::size_t k = 0; k < rows[0].size(); ++k) {
    const std::string& name = rows[0][k];
    if (name == "spread_rank" || name == "spread_groups") {
      EXPECT_EQ(rows[1][k], "") << name;
    }
  }
  // A screening names its strongest effects and leaves the column of noise empty.
  m.axes.clear();
  m.screened = {{"hardening", {}, {"m.hardening"}}, {"friction", {}, {"c.friction"}}};
  for (std::size_t k = 0; k < 12; ++k) m.runs[k].coordinates = {k < 4 ? 0 : 2, k < 8 ? 0 : 2};
  for (const sheet::Effect& effect : sheet::effects_on(m, sweep.results, 0)) {
    EXPECT_FALSE(effect.is_noise);
    EXPECT_TRUE(effect.is_unknown);
  }
  EXPECT_TRUE(sheet::effect_lines(m, sweep.results).front().starts_with("spread (m): friction "));
  EXPECT_NE(sheet::effects_csv(m, sweep.results).find(",\n"), std::string::npos);
}

TEST(Noise, RunsThatFailAreCountedAndNotAveraged) {
  MadeSweep sweep = sweep_of_seeds();
  sweep.results[1].status.state = RunState::diverged;
  sweep.results[1].has_broken.reset();
  sweep.results[1].metrics[0] = 1e9;
  const Point point = points_of(sweep.manifest, sweep.results).front();
  EXPECT_EQ(point.ended, 3u);
  EXPECT_EQ(point.metrics[0].count, 3u);
  EXPECT_LT(point.metrics[0].max, 1);
  EXPECT_EQ(outcome_text(point), "holds in 3 of 3, 1 not ended");
}

TEST(Noise, TablesHaveARowForEachRunAndARowForEachPoint) {
  const MadeSweep sweep = sweep_of_seeds();
  const std::vector<neve::test::CsvRow> runs =
      neve::test::parse_csv(sheet::data_csv(sweep.manifest, sweep.results));
  EXPECT_EQ(runs.size(), 13u);
  const std::vector<neve::test::CsvRow> points =
      neve::test::parse_csv(sheet::points_csv(sweep.manifest, sweep.results));
  ASSERT_EQ(points.size(), 4u);
  const auto cell = [&](std::size_t row, const std::string& name) {
    const auto found = std::find(points[0].begin(), points[0].end(), name);
    return found == points[0].end()
               ? "no column " + name
               : points[row][static_cast<std::size_t>(found - points[0].begin())];
  };
  EXPECT_EQ(cell(2, "m_hardening"), "10.0");
  EXPECT_EQ(cell(1, "seed"), "no column seed");
  EXPECT_EQ(cell(2, "broken"), "1");
  EXPECT_EQ(cell(1, "spread_mean"), "0.515");
  EXPECT_EQ(cell(1, "spread_min"), "0.5");
  EXPECT_EQ(cell(1, "spread_max"), "0.53");
  EXPECT_EQ(cell(1, "spread_rank"), "2");
  EXPECT_EQ(cell(2, "spread_rank"), "2");
  EXPECT_EQ(cell(3, "spread_rank"), "1");
  EXPECT_EQ(cell(3, "spread_groups"), "a");
  Manifest plain = sweep.manifest;
  plain.seeds = 1;
  EXPECT_EQ(sheet::points_csv(plain, sweep.results), "");
}

TEST(Noise, PlotsNameTheMetricsThatAreNoise) {
  const MadeSweep sweep = sweep_of_seeds();
  const std::string svg = sheet::metric_plots_svg(sweep.manifest, sweep.results);
  EXPECT_NE(svg.find("height: noise here"), std::string::npos);
  EXPECT_EQ(svg.find("spread: noise here"), std::string::npos);
  EXPECT_NE(svg.find("point 0: mean 0.515, 0.5 to 0.53 in 4 runs"), std::string::npos);
  EXPECT_EQ(svg.find(">seed<"), std::string::npos);
}

TEST(Noise, AScreeningSaysWhichEffectsAreWithinIt) {
  MadeSweep sweep = sweep_of_seeds();
  Manifest& m = sweep.manifest;
  m.axes.clear();
  m.screened = {{"hardening", {}, {"m.hardening"}}, {"friction", {}, {"c.friction"}}};
  // One trajectory: hardening changes the spread by noise, friction by more.
  for (std::size_t k = 0; k < 12; ++k) {
    m.runs[k].coordinates = {k < 4 ? 0 : 2, k < 8 ? 0 : 2};
    sweep.results[k].metrics[2] = double((k * 7) % 5);
  }
  const std::vector<sheet::Effect> effects = sheet::effects_on(m, sweep.results, 0);
  ASSERT_EQ(effects.size(), 2u);
  EXPECT_EQ(effects[0].steps, 1);
  EXPECT_TRUE(effects[0].is_noise);
  EXPECT_FALSE(effects[1].is_noise);
  EXPECT_NEAR(effects[1].mean, 0.39 * 1.5, 1e-9);  // for the whole range, of two thirds
  const std::string csv = sheet::effects_csv(m, sweep.results);
  EXPECT_NE(csv.find("within_noise"), std::string::npos);
  const std::vector<std::string> lines = sheet::effect_lines(m, sweep.results);
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines[0], "spread (m): friction 0.585");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1], "fragments: all effects are within noise");
}

TEST(Noise, FirstSeedsOfAllPointsStartBeforeSecondOnes) {
  const std::vector<std::vector<int>> coordinates{{0}, {0}, {1}, {1}, {2}, {2}};
  EXPECT_EQ(plan::coarse_first(coordinates, {3}, {0, 1, 0, 1, 0, 1}),
            (std::vector<std::size_t>{0, 4, 2, 1, 5, 3}));
}

TEST(Noise, EachPointHasTheSeedsFromTheScenesOn) {
  sweep::Run point;
  point.settings = {{"m.hardening", "5"}};
  const std::vector<sweep::Run> runs = plan::with_seeds({point, point}, 7, 3);
  ASSERT_EQ(runs.size(), 6u);
  EXPECT_EQ(runs[0].setting("seed"), "7");
  EXPECT_EQ(runs[5].setting("seed"), "9");
  EXPECT_EQ(runs[5].index, 5);
  EXPECT_EQ(runs[5].setting("m.hardening"), "5");
}

}  // namespace
}  // namespace neve::app::sweep::store
