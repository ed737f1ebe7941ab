/// Results of a sweep: metrics, table, sheet and report.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/record/metrics.h"
#include "app/record/run_json.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/sweep/jobs/outcome.h"
#include "app/sweep/sheet/data_csv.h"
#include "app/sweep/sheet/metric_plots.h"
#include "app/sweep/sheet/report.h"
#include "app/sweep/sheet/report_data.h"
#include "app/sweep/sheet/sheet_layout.h"
#include "app/sweep/store/stars.h"
#include "tests/support/cinema.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

/// A cube of particles, two per cell and direction.
void add_cube(const sim::Vec3d& corner, int cells, sim::ParticleArrays& particles) {
  for (int i = 0; i < 2 * cells; ++i)
    for (int j = 0; j < 2 * cells; ++j)
      for (int k = 0; k < 2 * cells; ++k) {
        particles.x.push_back(corner + 0.5 * sim::Vec3d(i + 0.5, j + 0.5, k + 0.5));
        particles.m.push_back(1);
        particles.J_P.push_back(0.9);
      }
}

TEST(Metrics, CountFragmentsThatDoNotTouch) {
  sim::ParticleArrays particles;
  add_cube({0, 0, 0}, 4, particles);
  EXPECT_EQ(app::record::measure(particles, 1).fragments, 1u);
  add_cube({4, 4, 4}, 2, particles);  // touches with a corner
  EXPECT_EQ(app::record::measure(particles, 1).fragments, 1u);
  add_cube({-5, 0, 0}, 4, particles);  // a cell between them
  EXPECT_EQ(app::record::measure(particles, 1).fragments, 2u);
  add_cube({0, 9, 0}, 1, particles);
  const app::record::Metrics metrics = app::record::measure(particles, 1);
  EXPECT_EQ(metrics.fragments, 3u);
  EXPECT_NEAR(metrics.largest_fragment, 72.0 / 137, 1e-12);  // cells of 8 particles each
  EXPECT_NEAR(metrics.mean_J_P, 0.9, 1e-12);
  EXPECT_NEAR(metrics.crumbs, 1.0 / 137, 1e-12);
  EXPECT_EQ(metrics.powder, 0);
  EXPECT_EQ(app::record::measure(particles, 2).fragments,
            2u);  // larger cells bridge the gap of one
  particles.x.emplace_back(20, 0, 0);
  particles.m.push_back(1);
  particles.J_P.push_back(0.9);
  EXPECT_NEAR(app::record::measure(particles, 1).powder, 1.0 / 1097, 1e-12);
}

TEST(Metrics, SnowHasBrokenOnceAHundredthOfItsLargestPieceIsApart) {
  app::record::Metrics first, last;
  EXPECT_FALSE(app::record::has_broken(first, last).has_value()) << "it had no snow at first";
  first.largest_fragment = 0.5;  // one of two bodies
  last.largest_fragment = 0.496;
  EXPECT_EQ(app::record::has_broken(first, last), false);
  last.largest_fragment = 0.494;
  EXPECT_EQ(app::record::has_broken(first, last), true);
  last.largest_fragment = 0;
  EXPECT_FALSE(app::record::has_broken(first, last).has_value()) << "a sink has taken all of it";
  // Snow that an emitter adds breaks nothing; nothing tells what a sink took from what came off.
  first = {}, last = {};
  first.largest_fragment = 1;
  first.particles = 1000;
  last.largest_fragment = 0.7;
  last.particles = 1430;
  EXPECT_EQ(app::record::has_broken(first, last), false);
  last.particles = 1300;
  EXPECT_EQ(app::record::has_broken(first, last), true);
  EXPECT_NEAR(*app::record::held_whole(first, last), 0.91, 1e-12);
  last.largest_fragment = 1;
  last.particles = 600;
  EXPECT_FALSE(app::record::has_broken(first, last).has_value());
  last.largest_fragment = 0.8;
  EXPECT_EQ(app::record::has_broken(first, last), true);
  first.particles = last.particles = 0;  // records of earlier versions
  EXPECT_EQ(app::record::has_broken(first, last), true);
  first.largest_fragment = 0.5;
  last.largest_fragment = 1;  // they cling to each other
  EXPECT_EQ(app::record::has_broken(first, last), false);
}

TEST(Metrics, SpreadAndHeightAreThoseOfABox) {
  sim::ParticleArrays particles;
  for (int k = 0; k < 1000; ++k) {
    particles.x.push_back({std::cos(0.1 * k), 0.01 * k, std::sin(0.1 * k)});
    particles.m.push_back(1);
    particles.J_P.push_back(1);
  }
  const app::record::Metrics metrics = app::record::measure(particles, 0.1);
  // A spiral of radius 1 about a centre that is the axis but for its last turn.
  EXPECT_NEAR(metrics.spread, 1, 0.02);
  EXPECT_NEAR(metrics.height, 9.6, 0.02);  // 96 % of 10
}

TEST(Metrics, MetricsOfDivergedStatesCountFiniteParticles) {
  sim::ParticleArrays particles;
  EXPECT_EQ(app::record::measure(particles, 1).fragments, 0u);
  add_cube({0, 0, 0}, 1, particles);
  particles.x[0].setConstant(NAN);
  particles.x[1].setConstant(1e300);
  EXPECT_EQ(app::record::measure(particles, 1).fragments, 1u);
}

/// A heap of sand held 90 % of all particles, so that a ball that burst beside it was whole.
TEST(Metrics, SandAndElasticBodiesCountWhereThereIsNoSnow) {
  const std::string snow = R"(
[solver]
cell_size = 0.05
[material.snow]
model = "cam_clay"
[material.sand]
model = "sand"
[[body]]
name = "ball"
shape = { sphere = { center = [2, 0.2, 0], radius = 0.1 } }
)",
                    sand = R"([[body]]
name = "heap"
material = "sand"
shape = { box = { center = [0, 0.25, 0], size = [0.5, 0.5, 0.5] } }
)",
                    alone =
                        "[[collider]]\nname = \"floor\"\nshape = { plane = { point = "
                        "[0, 0, 0], normal = [0, 1, 0] } }\n";
  const auto measured = [](const std::string& text) {
    const app::scene::Scene scene = app::scene::read_scene_text(text, "scene.toml");
    const auto simulation =
        app::setup::make_simulation(scene, app::setup::seed_scene(scene).particles, 1);
    return app::record::measure(simulation.particles(), scene);
  };
  const app::record::Metrics both = measured(snow + sand), ball = measured(snow + alone);
  EXPECT_EQ(both.particles, ball.particles);
  EXPECT_EQ(both.fragments, 1u);
  EXPECT_EQ(both.spread, ball.spread);
  EXPECT_EQ(both.height, ball.height);
  EXPECT_EQ(both.largest_fragment, 1);
  std::string of_sand = snow + sand;
  of_sand.replace(of_sand.find("cam_clay"), 8, "sand");
  EXPECT_GT(measured(of_sand).particles, 5 * ball.particles);
  EXPECT_EQ(measured(of_sand).fragments, 2u);
}

/// Frames that have sand and no snow any more have no such numbers either.
TEST(Metrics, OfNoSnowAreNoNumbersInRunJson) {
  app::record::FrameRecord frame;
  frame.summary.particles = 7;
  const app::Json json = app::record::to_json(frame);
  for (const char* name : {"spread", "height", "mean_J_P", "largest_fragment", "powder", "crumbs"})
    EXPECT_TRUE(json.at(name).is_null()) << name;
  EXPECT_EQ(json.at("fragments"), 0);
  EXPECT_EQ(json.at("measured"), 0);
  EXPECT_FALSE(json.at("max_J_P").is_null()) << "that of the sand";
  const app::record::FrameRecord read = app::record::frame_record(json);
  EXPECT_FALSE(app::record::has_snow(read));
  EXPECT_EQ(to_text(app::record::to_json(read)), to_text(json));
  frame.summary.particles = 0;
  const app::Json none = app::record::to_json(frame);
  for (const char* name : {"spread", "min_J_P", "max_J_P"})
    EXPECT_TRUE(none.at(name).is_null()) << name;
  EXPECT_TRUE(none.at("centre_of_mass").at(0).is_null());
}

app::sweep::store::Manifest manifest_of(const std::vector<int>& sizes) {
  app::sweep::store::Manifest m;
  m.version = "1";
  m.title = "Test </script> & \"quotes\"";
  m.view = "particles";
  m.tile_label = "differences";
  std::vector<std::vector<int>> places{{}};
  for (std::size_t a = 0; a < sizes.size(); ++a) {
    const std::string address = "a.b" + std::to_string(a);
    m.parameters.push_back({address, "b" + std::to_string(a), "Pa", "number"});
    app::sweep::store::AxisLabels axis{"b" + std::to_string(a), {}};
    std::vector<std::vector<int>> longer;
    for (int k = 0; k < sizes[a]; ++k) axis.values.push_back(std::to_string(k));
    for (const auto& place : places)
      for (int k = 0; k < sizes[a]; ++k) {
        longer.push_back(place);
        longer.back().push_back(k);
      }
    places = longer;
    m.axes.push_back(axis);
  }
  for (const auto& place : places) {
    app::sweep::Run run;
    run.index = static_cast<int>(m.runs.size());
    run.folder = app::sweep::store::run_folder_name(run.index);
    run.coordinates = place;
    for (std::size_t a = 0; a < place.size(); ++a)
      run.settings.push_back({"a.b" + std::to_string(a), std::to_string(place[a])});
    m.runs.push_back(run);
  }
  return m;
}

TEST(SheetLayout, ASheetHasEveryRunOnceAndNoOverlappingTiles) {
  for (const auto& sizes : std::vector<std::vector<int>>{
           {}, {1}, {3}, {20}, {2, 3}, {3, 2, 2}, {2, 2, 2, 2}, {2, 3, 2, 2, 2}, {12, 40}}) {
    const app::sweep::store::Manifest m = manifest_of(sizes);
    const app::sweep::sheet::SheetLayout layout = app::sweep::sheet::layout_sheet(m, true, 8192);
    ASSERT_EQ(layout.tiles.size(), m.runs.size());
    EXPECT_LE(layout.width, 8192);
    EXPECT_LE(layout.height, 8192);
    for (std::size_t a = 0; a < layout.tiles.size(); ++a) {
      const app::sweep::sheet::SheetTile& tile = layout.tiles[a];
      EXPECT_GE(tile.x, 0);
      EXPECT_GE(tile.y, layout.header);
      EXPECT_LE(tile.x + layout.tile_width, layout.width);
      EXPECT_LE(tile.y + layout.tile_height, layout.height);
      for (std::size_t b = 0; b < a; ++b)
        ASSERT_TRUE(std::abs(tile.x - layout.tiles[b].x) >= layout.tile_width ||
                    std::abs(tile.y - layout.tiles[b].y) >= layout.tile_height)
            << sizes.size() << " axes: " << a << " over " << b;
    }
  }
}

TEST(SheetLayout, ASheetOfAnyNumberOfRunsEndsAsPages) {
  constexpr int largest = 2048;
  for (const auto& sizes : std::vector<std::vector<int>>{{2, 3}, {100, 5}}) {
    const app::sweep::store::Manifest m = manifest_of(sizes);
    std::size_t next = 0;
    const auto pages = app::sweep::sheet::layout_pages(m, true, largest);
    for (const app::sweep::sheet::SheetPage& page : pages) {
      EXPECT_EQ(page.first, next);
      next += page.count;
      EXPECT_TRUE(app::sweep::sheet::fits(page.layout, largest)) << page.layout.width;
      ASSERT_EQ(page.layout.tiles.size(), page.count);
      for (std::size_t k = 0; k < page.count; ++k)
        EXPECT_EQ(page.layout.tiles[k].run, page.first + k);
    }
    EXPECT_EQ(next, m.runs.size());
    EXPECT_EQ(pages.size() == 1, sizes[0] == 2);
    EXPECT_EQ(pages.front().layout.has_edges, sizes[0] == 2) << "pages name values on their tiles";
  }
}

/// A tile of a screening names what its run changes of the run before it, which the tiles of a page
/// know by its place in the whole sweep.
TEST(SheetLayout, PagesOfAScreeningNameWhatTheWholeOneDoes) {
  app::sweep::store::Manifest m = manifest_of({});
  const app::sweep::Run first = m.runs[0];
  m.runs.clear();
  m.parameters = {{"a.b", "a parameter", "Pa", "number"}};
  m.screened = {{"b", {}, {"a.b"}, {}}};
  for (int k = 0; k < 400; ++k) {
    app::sweep::Run& run = m.runs.emplace_back(first);
    run.index = k;
    run.coordinates = {k % 2};
    run.settings = {{"a.b", std::string(k % 2 ? "1" : "0")}};
  }
  m.runs.back().settings = {{"a.b", "a text that needs a line of its own"}};
  const auto pages = app::sweep::sheet::layout_pages(m, true, 1024);
  ASSERT_GT(pages.size(), 2u);
  const auto& last = pages.back();
  std::size_t lines = 0;
  for (std::size_t k = last.first; k < m.runs.size(); ++k)
    lines = std::max(lines,
                     app::sweep::sheet::tile_words(m, m.runs[k], false, last.layout.words).size());
  EXPECT_EQ(last.layout.label_height > 0, lines > 1);
  EXPECT_EQ(last.layout.label_height, pages.front().layout.label_height);
}

TEST(SheetLayout, LastAxisGoesAcrossUnlessAskedOtherwise) {
  app::sweep::store::Manifest m = manifest_of({2, 3});
  const auto is_across = [&](std::size_t a, std::size_t b) {
    const app::sweep::sheet::SheetLayout layout = app::sweep::sheet::layout_sheet(m, false, 8192);
    return layout.tiles[a].y == layout.tiles[b].y && layout.tiles[a].x < layout.tiles[b].x;
  };
  EXPECT_TRUE(is_across(0, 1));
  EXPECT_FALSE(is_across(0, 3));
  m.columns = 0;
  EXPECT_FALSE(is_across(0, 1));
  EXPECT_TRUE(is_across(0, 3));
  m.columns = -1;
  m.rows = 1;
  EXPECT_TRUE(is_across(0, 3));
}

TEST(SheetLayout, RowsHaveNameAndValueInOneLineIfBothFit) {
  app::sweep::store::Manifest m = manifest_of({2, 3});
  m.axes[0].name = "rate";
  m.axes[0].values = {"5 kg/s", "10 kg/s"};
  const auto has = [&](const std::string& text) {
    const app::sweep::sheet::SheetLayout layout = app::sweep::sheet::layout_sheet(m, false, 8192);
    return std::any_of(layout.labels.begin(), layout.labels.end(),
                       [&](const render::Note& label) { return label.text == text; });
  };
  EXPECT_TRUE(has("rate = 5 kg/s"));
  m.axes[0].name = "critical_compression, critical_stretch";
  EXPECT_TRUE(has("critical_compression, critical_stretch ="));
  EXPECT_TRUE(has("5 kg/s"));
  EXPECT_TRUE(app::sweep::sheet::layout_sheet(m, false, 8192).has_edges);
  EXPECT_FALSE(app::sweep::sheet::layout_sheet(manifest_of({20}), false, 8192).has_edges);
}

TEST(SheetLayout, FurtherAxesAreSetApart) {
  const app::sweep::store::Manifest m = manifest_of({2, 3, 3});
  const app::sweep::sheet::SheetLayout layout = app::sweep::sheet::layout_sheet(m, false, 8192);
  const auto at = [&](std::size_t k) { return std::pair(layout.tiles[k].x, layout.tiles[k].y); };
  const int inside = at(1).first - at(0).first;
  // Blocks of nine beside or below each other, with more than the usual gap.
  const int across = at(9).first - at(2).first, down = at(9).second - at(6).second;
  EXPECT_TRUE(across > inside || down > at(3).second - at(0).second);
}

std::vector<app::sweep::store::RunResult> results_of(const app::sweep::store::Manifest& m) {
  std::vector<app::sweep::store::RunResult> results(m.runs.size());
  for (std::size_t k = 0; k < results.size(); ++k) {
    app::sweep::store::RunResult& r = results[k];
    r.status.state =
        k % 3 == 1 ? app::sweep::store::RunState::diverged : app::sweep::store::RunState::ok;
    r.status.reason = k % 3 == 1 ? "diverged, \"badly\"" : "";
    r.status.short_reason = "frame 17: acoustic CFL 3.1";
    for (std::size_t i = 0; i < app::sweep::store::metric_infos().size(); ++i)
      r.metrics.push_back(k % 4 == 2 ? std::nullopt
                                     : std::optional(static_cast<double>(k) * (k % 2 ? 0.5 : 1)));
  }
  return results;
}

TEST(DataCsv, TheTableKeepsTheRulesOfCinema) {
  test::TemporaryFolder folder;
  app::sweep::store::Manifest m = manifest_of({2, 3});
  m.parameters.push_back({"body.ball.velocity", "velocity", "m/s", "vector"});
  m.parameters.push_back({"solver.transfer", "transfer", "", "choice"});
  m.parameters.push_back({"seed", "seed", "", "integer"});
  m.parameters.push_back({"title", "title", "", "string"});
  m.parameters.push_back({"FILE.name", "name", "", "string"});
  const char* const titles[] = {"12", "nan", "a, \"b\"", "1e5", "", "x"};
  for (std::size_t k = 0; k < m.runs.size(); ++k) {
    app::sweep::Run& run = m.runs[k];
    run.settings.push_back({"body.ball.velocity", "[0, -5, " + std::to_string(k) + "]"});
    run.settings.push_back({"solver.transfer", k % 2 ? "\"flip\"" : "apic"});
    run.settings.push_back({"seed", std::to_string(k)});
    run.settings.push_back({"title", "\"" + std::string(titles[k]) + "\""});
    run.settings.push_back({"FILE.name", "\"f\""});
    run.label = k % 2 ? "7" : "";
    folder.write("runs/" + run.folder + "/scene.toml", "x");
  }
  std::vector<app::sweep::store::RunResult> results = results_of(m);
  results[0].frames = {0, 3};
  folder.write("runs/0000/particles/0003.png", "x");
  const std::string csv = app::sweep::sheet::data_csv(m, results);
  EXPECT_EQ(test::cinema_problem(csv, folder.path()), "") << csv;
  EXPECT_NE(csv.find("runs/0000/particles/0003.png,runs/0000/scene.toml\n"), std::string::npos);
  // The check itself finds what it is for.
  const auto breaks = [&](const std::string& from, const std::string& to) {
    std::string bad = csv;
    bad.replace(bad.find(from), from.size(), to);
    return !test::cinema_problem(bad, folder.path()).empty();
  };
  EXPECT_TRUE(breaks("-5.0", "-5"));
  EXPECT_TRUE(breaks("0003.png", "0004.png"));
  EXPECT_TRUE(breaks("state", "run"));
  EXPECT_TRUE(breaks("state", "FILE_x"));
}

TEST(DataCsv, TheTableHasEveryColumnOnceIfAnAxisHasTheNameOfAMetric) {
  app::sweep::store::Manifest m = manifest_of({2});
  m.parameters = {{"frames", "frames", "", "integer"}, {"steps", "steps", "", "integer"}};
  const std::vector<test::CsvRow> rows =
      test::parse_csv(app::sweep::sheet::data_csv(m, results_of(m)));
  for (const char* name : {"frames", "frames_done", "steps", "steps_done"})
    EXPECT_EQ(std::count(rows[0].begin(), rows[0].end(), name), 1) << name;
}

TEST(DataCsv, RowsOfDivergedRunsHaveCostsAndNoMetrics) {
  const app::sweep::store::Manifest m = manifest_of({2});
  const std::vector<test::CsvRow> rows =
      test::parse_csv(app::sweep::sheet::data_csv(m, results_of(m)));
  const auto cell = [&](std::size_t row, const char* name) {
    const auto at = std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin();
    return rows[row].at(static_cast<std::size_t>(at));
  };
  EXPECT_EQ(cell(1, "spread"), "0.0");
  EXPECT_EQ(cell(2, "state"), "diverged");
  EXPECT_EQ(cell(2, "spread"), "");
  EXPECT_EQ(cell(2, "steps"), "1");  // 0.5, rounded
  EXPECT_EQ(cell(2, "seconds"), "0.5");
}

TEST(RunResults, ResultsCountTheStepsUntilARunDiverged) {
  const test::TemporaryFolder folder;
  app::sweep::store::Manifest m = manifest_of({1});
  m.runs[0].key = "k";
  app::record::FrameRecord frame;
  frame.advance.steps = 5;
  Json run = {{"frames", Json::array({app::record::to_json(frame)})},
              {"divergence", {{"step", 17}}}};
  folder.write("runs/0000/run.json", to_text(run));
  app::sweep::store::RunStatus status;
  status.state = app::sweep::store::RunState::diverged;
  status.key = "k";
  app::sweep::store::write_status(folder.path() / "runs/0000", status);
  const auto steps = [&] {
    const app::sweep::store::RunResult result =
        app::sweep::store::read_result(folder.path(), m.runs[0], m.view);
    for (std::size_t k = 0; k < app::sweep::store::metric_infos().size(); ++k)
      if (app::sweep::store::metric_infos()[k].name == std::string("steps"))
        return result.metrics[k];
    return std::optional<double>();
  };
  EXPECT_EQ(steps(), 17);
  run.erase("divergence");
  folder.write("runs/0000/run.json", to_text(run));
  EXPECT_EQ(steps(), 5);
}

TEST(RunResults, WhereNoSnowIsLeftItHasNoShape) {
  const test::TemporaryFolder folder;
  app::sweep::store::Manifest m = manifest_of({1});
  m.runs[0].key = "k";
  app::record::FrameRecord frame;
  frame.summary.min_J_P = frame.summary.max_J_P = 1;
  app::sweep::store::RunStatus status;
  status.state = app::sweep::store::RunState::ok;
  status.key = "k";
  for (const std::size_t particles : {1u, 0u}) {
    frame.summary.particles = frame.metrics.particles = particles;
    folder.write("runs/0000/run.json",
                 to_text(Json{{"frames", Json::array({app::record::to_json(frame)})}}));
    app::sweep::store::write_status(folder.path() / "runs/0000", status);
    const auto result = app::sweep::store::read_result(folder.path(), m.runs[0], m.view);
    for (std::size_t k = 0; k < app::sweep::store::metric_infos().size(); ++k) {
      const std::string name = app::sweep::store::metric_infos()[k].name;
      const bool is_of_snow = name == "spread" || name == "height" || name == "largest_fragment" ||
                              name == "powder" || name == "crumbs" || name.ends_with("J_P");
      if (is_of_snow) {
        EXPECT_EQ(app::sweep::store::told_metric(m.runs[0], result, k).has_value(), particles > 0)
            << name;
      }
      if (name == "fragments") {
        EXPECT_EQ(result.metrics[k], 0);
      }
    }
  }
}

TEST(RunResults, FramesOfKilledRunsHaveTheirPictures) {
  const test::TemporaryFolder folder;
  app::sweep::store::Manifest m = manifest_of({1});
  m.view = "particles";
  m.runs[0].key = "k";
  m.runs[0].frames = {0, 2};
  Json frames = Json::array();
  for (const int number : {0, 1, 2}) {
    app::record::FrameRecord frame;
    frame.frame = number;
    frames.push_back(app::record::to_json(frame));
    if (number < 2)
      folder.write("runs/0000/particles/000" + std::to_string(number) + ".png", "a picture");
  }
  folder.write("runs/0000/run.json", to_text(Json{{"frames", frames}}));
  app::sweep::store::RunStatus status;
  status.state = app::sweep::store::RunState::crashed;
  status.key = "k";
  app::sweep::store::write_status(folder.path() / "runs/0000", status);
  EXPECT_EQ(app::sweep::store::read_result(folder.path(), m.runs[0], m.view).frames,
            (std::vector<int>{0, 1}));
  // A run that is to be drawn otherwise has pictures of the drawing before, which do not count.
  status.state = app::sweep::store::RunState::pending;
  app::sweep::store::write_status(folder.path() / "runs/0000", status);
  EXPECT_TRUE(app::sweep::store::read_result(folder.path(), m.runs[0], m.view).frames.empty());
}

/// Copies go with any seed of their point, and runs at full resolution were chosen by themselves.
TEST(RunResults, VariantsOfSomeRunsAreTheirCopiesAndAllFullRuns) {
  app::sweep::store::Manifest m = manifest_of({6});
  m.seeds = 2;
  for (const std::size_t of : {0u, 2u, 5u}) {
    app::sweep::store::Variant& variant = m.variants.emplace_back();
    variant.of = of;
    variant.coarsening = of == 5 ? 1 : 2;
    variant.run.index = m.last_index();
  }
  EXPECT_EQ(m.with_variants({1}), (std::vector<int>{1, 6, 8}));
}

TEST(RunText, ARunIsNamedWithItsFolderIfTheNumbersDiffer) {
  app::sweep::Run run;
  run.index = 1;
  run.folder = "0001";
  EXPECT_EQ(app::sweep::store::run_text(run), "run 1");
  run.folder = "0010";
  EXPECT_EQ(app::sweep::store::run_text(run), "run 1 (runs/0010)");
}

TEST(DataCsv, TablesForComparisonHaveNoTimes) {
  const app::sweep::store::Manifest m = manifest_of({2});
  std::vector<app::sweep::store::RunResult> results = results_of(m);
  const std::string without = app::sweep::sheet::data_csv(m, results, {}, false);
  results[0].metrics.back() = 1e6;
  EXPECT_EQ(app::sweep::sheet::data_csv(m, results, {}, false), without);
  EXPECT_NE(app::sweep::sheet::data_csv(m, results), without);
}

TEST(SweepReport, SweepReportIsOneFileThatNamesNothingOutside) {
  const app::sweep::store::Manifest m = manifest_of({2, 3});
  const std::vector<app::sweep::store::RunResult> results = results_of(m);
  const std::string html = app::sweep::sheet::report_html(
      "out/a b.cdb", m, results, app::sweep::sheet::layout_sheet(m, false, 8192), {1, 2, 3});
  std::string rest = html;
  // The name of a namespace is an address that nobody opens.
  for (const std::string name : {"http://www.w3.org/2000/svg"})
    for (std::size_t at; (at = rest.find(name)) != std::string::npos;) rest.erase(at, name.size());
  EXPECT_EQ(rest.find("http"), std::string::npos);
  EXPECT_EQ(rest.find("src=\"/"), std::string::npos);
  EXPECT_NE(html.find("data:image/png;base64,AQID"), std::string::npos);
  EXPECT_NE(html.find("neve render 'out/a b.cdb/runs/0003/scene.toml' --frames 0-0"),
            std::string::npos);
  // Words of the user end nothing early.
  EXPECT_NE(html.find("Test &lt;/script&gt; &amp; &quot;quotes&quot;"), std::string::npos);
  std::size_t scripts = 0;
  for (std::size_t at = 0; (at = html.find("</script>", at)) != std::string::npos; ++at) ++scripts;
  EXPECT_EQ(scripts, 3u) << "the sweep, its stars, the program";
}

TEST(SweepReport, SweepReportKeepsParametersAsTheyWereWritten) {
  app::sweep::store::Manifest m = manifest_of({2});
  m.runs[0].settings[0].value = "0.123456789";
  m.runs[1].settings[0].value = "1.40e5";
  const std::string html = app::sweep::sheet::report_html(
      "out", m, results_of(m), app::sweep::sheet::layout_sheet(m, false, 8192), {});
  EXPECT_NE(html.find("\"texts\":{\"1\":\"0.123456789\"}"), std::string::npos);
  EXPECT_NE(html.find("\"texts\":{\"1\":\"1.40e5\"}"), std::string::npos);
}

/// Runs that are interrupted or in progress, which are no failures, have none either.
TEST(SweepReport, SweepReportHasNoMetricsOfRunsThatDidNotEnd) {
  const app::sweep::store::Manifest m = manifest_of({2});
  std::vector<app::sweep::store::RunResult> results(2);
  for (app::sweep::store::RunResult& result : results)
    result.metrics.assign(app::sweep::store::metric_infos().size(), 0.123456);
  results[0].status.state = app::sweep::store::RunState::ok;
  results[1].status.state = app::sweep::store::RunState::interrupted;
  const Json rows = app::sweep::sheet::report_data("out", m, results, {})["rows"];
  std::vector<std::ptrdiff_t> told;
  for (const Json& row : rows)
    told.push_back(std::count(row["cells"].begin(), row["cells"].end(), Json(0.123456)));
  EXPECT_GT(told[0], 10);
  EXPECT_EQ(told[1], 2) << "steps and seconds";
}

/// A sweep whose axis has these values, made by a program that gives keys of this kind.
app::sweep::store::Manifest sweep_over(const std::vector<std::string>& values,
                                       const std::string& kind) {
  app::sweep::store::Manifest m = manifest_of({static_cast<int>(values.size())});
  for (std::size_t k = 0; k < values.size(); ++k) {
    m.runs[k].settings[0].value = values[k];
    m.runs[k].key = kind + values[k];
  }
  m.varied = {"a.b0"};
  return m;
}

TEST(Stars, StarsStayWithTheirRunWhenTheSweepHasOthers) {
  using namespace app::sweep::store;
  const test::TemporaryFolder folder;
  const Manifest before = sweep_over({"0.3", "0.6", "0.9"}, "x");
  write_marks(folder.path(), before, {{{1, {true, "wet"}}, {2, {true, ""}}}, {}});
  for (const std::string kind : {"x", "another build "}) {
    // The sweep grows: run 1 becomes run 2. The mark of a run that it has no more is named.
    const Manifest after = sweep_over({"0.3", "0.45", "0.6"}, kind);
    const KeptMarks kept = read_marks(folder.path(), after);
    ASSERT_EQ(kept.marks.size(), 1u);
    EXPECT_EQ(kept.marks.begin()->first, 2);
    EXPECT_EQ(kept.marks.at(2).note, "wet");
    ASSERT_EQ(kept.lost.size(), 1u);
    EXPECT_NE(lost_lines(kept.lost)[0].find("a.b0 = 0.9"), std::string::npos);
    write_marks(folder.path(), after, kept);
  }
  const KeptMarks back = read_marks(folder.path(), before);
  EXPECT_TRUE(back.lost.empty());
  EXPECT_EQ(back.marks.at(1).note, "wet");
  EXPECT_TRUE(back.marks.at(2).has_star);
  write_marks(folder.path(), before, back);
  // It gets seeds: the first of each point is the run that it was.
  Manifest seeded = sweep_over({"0.3", "0.3", "0.6", "0.6"}, "x");
  seeded.seeds = 2;
  seeded.parameters.push_back({"seed", "seed", "", "integer"});
  for (std::size_t k = 0; k < seeded.runs.size(); ++k) {
    seeded.runs[k].settings.push_back({"seed", std::to_string(k % 2)});
    if (k % 2 == 1) seeded.runs[k].key += " of another seed";
  }
  EXPECT_EQ(read_marks(folder.path(), seeded).marks.at(2).note, "wet");
}

TEST(Stars, AListOfThePageTakesAwayWhatWasTakenAwayThere) {
  using namespace app::sweep::store;
  const test::TemporaryFolder folder;
  const Manifest sweep = sweep_over({"0.3", "0.6"}, "x");
  KeptMarks kept{{{0, {true, "wet"}}, {1, {true, ""}}}, {}};
  const std::string list = folder.write(
      "list.json",
      R"({"format": "neve stars 1", "runs": [{"run": 0, "star": false, "note": ""}]})");
  add_marks(read_marks_file(list, sweep), kept);
  ASSERT_EQ(kept.marks.size(), 1u);
  EXPECT_TRUE(kept.marks.contains(1));
}

TEST(Stars, ListsWithoutSettingsAreReadByNumber) {
  using namespace app::sweep::store;
  const test::TemporaryFolder folder;
  folder.write("stars.json", R"({"format": "neve stars 1", "runs": [
{"run": 1, "star": true, "note": "wet"}, {"run": 7, "star": true, "note": ""}]})");
  const KeptMarks kept = read_marks(folder.path(), sweep_over({"0.3", "0.6"}, "x"));
  EXPECT_EQ(kept.marks.at(1).note, "wet");
  ASSERT_EQ(kept.lost.size(), 1u) << "the sweep has shrunk";
  EXPECT_EQ(kept.lost[0].run, 7);
}

TEST(RunWarnings, RunsOfDifferentInstructionsAreNoOneTable) {
  std::vector<app::sweep::store::RunResult> results(3);
  for (app::sweep::store::RunResult& result : results) {
    result.frames = {0};
    result.simd = "avx2";
    result.sources = "1";
  }
  EXPECT_TRUE(app::sweep::store::mixture_lines(results).empty());
  results[1].simd = "baseline";
  results[2].sources = "2";
  const std::vector<std::string> lines = app::sweep::store::mixture_lines(results);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NE(lines[0].find("(2 avx2, 1 baseline)"), std::string::npos) << lines[0];
  EXPECT_NE(lines[1].find("2 programs"), std::string::npos) << lines[1];
}

TEST(MetricPlots, PlotsHaveAPointForEachRunWithTheMetric) {
  const app::sweep::store::Manifest m = manifest_of({4});
  const std::string svg = app::sweep::sheet::metric_plots_svg(m, results_of(m));
  const auto count = [&](const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = svg.find(what, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("<circle"), 3 * app::sweep::store::metric_infos().size());
  EXPECT_EQ(count("fill=\"none\""), app::sweep::store::metric_infos().size()) << "rings";
  EXPECT_EQ(
      app::sweep::sheet::metric_plots_svg(
          m,
          std::vector<app::sweep::store::RunResult>(
              4, {{},
                  {},
                  std::vector<std::optional<double>>(app::sweep::store::metric_infos().size())})),
      "");
}

TEST(RunWarnings, WarningsAreReadFromRunJsonAndCountedInTableAndReport) {
  const test::TemporaryFolder folder;
  app::sweep::store::Manifest m = manifest_of({3});
  for (app::sweep::Run& run : m.runs) {
    run.key = "k";
    app::sweep::store::RunStatus status;
    status.state = app::sweep::store::RunState::ok;
    status.key = "k";
    const auto run_folder = folder.path() / "runs" / run.folder;
    std::filesystem::create_directories(run_folder);
    app::sweep::store::write_status(run_folder, status);
  }
  folder.write("runs/0000/run.json", R"({"frames": [], "warnings": ["CFL < 4", "odd"]})");
  folder.write("runs/0001/run.json", R"({"frames": []})");  // of an older version
  folder.write("runs/0002/run.json", R"({"frames": [], "warnings": 3})");
  const std::vector<app::sweep::store::RunResult> results =
      app::sweep::store::read_results(folder.path(), m);
  EXPECT_EQ(results[0].warnings, (std::vector<std::string>{"CFL < 4", "odd"}));
  EXPECT_TRUE(results[1].warnings.empty());
  EXPECT_TRUE(results[2].warnings.empty());
  EXPECT_EQ(app::sweep::store::warning_lines(m, results),
            (std::vector<std::string>{"run 0: CFL < 4; odd"}));
  const std::vector<test::CsvRow> rows = test::parse_csv(app::sweep::sheet::data_csv(m, results));
  const auto column = static_cast<std::size_t>(
      std::find(rows[0].begin(), rows[0].end(), "warnings") - rows[0].begin());
  ASSERT_LT(column, rows[0].size());
  EXPECT_EQ(rows[1][column], "2");
  EXPECT_EQ(rows[2][column], "0");
  const std::string html = app::sweep::sheet::report_html(
      "out", m, results, app::sweep::sheet::layout_sheet(m, false, 8192), {});
  // The "<" is escaped by script_json.
  EXPECT_NE(html.find("\"warnings\":[\"CFL \\u003c 4\",\"odd\"]"), std::string::npos);
}

TEST(RunWarnings, WarningsNameFiveRunsAndCountTheOthers) {
  const app::sweep::store::Manifest m = manifest_of({8});
  std::vector<app::sweep::store::RunResult> results = results_of(m);
  EXPECT_TRUE(app::sweep::store::warning_lines(m, results).empty());
  for (app::sweep::store::RunResult& result : results) result.warnings = {"x"};
  const std::vector<std::string> lines = app::sweep::store::warning_lines(m, results);
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[4], "run 4: x");
  EXPECT_EQ(lines[5], "and 3 more runs with warnings, see report.html");
  EXPECT_EQ(app::sweep::store::warning_count_text(1), "1 warning");
}

TEST(MetricPlots, DivergedRunsDoNotScaleTheAxes) {
  const app::sweep::store::Manifest m = manifest_of({4});
  std::vector<app::sweep::store::RunResult> results = results_of(m);
  const std::string svg = app::sweep::sheet::metric_plots_svg(m, results);
  // The second run diverged: wherever above the others it was, its ring is at the edge.
  for (std::optional<double>& value : results[1].metrics) value = 1e6;
  const std::string far = app::sweep::sheet::metric_plots_svg(m, results);
  for (std::optional<double>& value : results[1].metrics) value = 1e9;
  const auto without_tooltips = [](std::string text) {
    for (std::size_t at; (at = text.find("<title>")) != std::string::npos;)
      text.erase(at, text.find("</title>", at) + 8 - at);
    return text;
  };
  EXPECT_EQ(without_tooltips(app::sweep::sheet::metric_plots_svg(m, results)),
            without_tooltips(far));
  EXPECT_NE(without_tooltips(svg), without_tooltips(far));
}

TEST(TileText, ATileNamesTheFailureOfItsRun) {
  app::sweep::store::RunStatus status;
  status.state = app::sweep::store::RunState::diverged;
  status.short_reason = "frame 17: acoustic CFL 3.1";
  EXPECT_EQ(app::sweep::jobs::tile_text(status), "DIVERGED frame 17: acoustic CFL 3.1");
  status.state = app::sweep::store::RunState::out_of_memory;
  status.short_reason.clear();
  EXPECT_EQ(app::sweep::jobs::tile_text(status), "OUT OF MEMORY");
}

}  // namespace
}  // namespace neve::app
