/// Output of a sweep: database, sheets, and a report for a browser.

#include <algorithm>

#include "app/output/read_picture.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"
#include "tests/support/cinema.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

const std::string sweep_text = std::string(R"(
[sweep]
title = "Hardening & <speed>"
scene = "scene.toml"
frames = "0-2"
[set]
"view.particles.particles.color_by" = "speed"
[axis]
"body.ball.velocity" = [[0, -1, 0], [0, -3, 0]]
"material.snow.hardening" = [5, 10, 20]
)") + exploding_run + R"([sheet]
tile = [160, 90]
)";

class SweepResults : public Cli {
 protected:
  SweepResults() {
    folder.write("study.toml", sweep_text);
    made = neve({"sweep", "study.toml", "--quiet"});
  }

  std::string text(const std::string& file) {
    return read_text(folder / ("out/study.cdb/" + file));
  }

  app::output::ProcessResult made;
};

TEST_F(SweepResults, SweepResultsAreACinemaDatabaseWithSheetsAndCanBeMadeAgain) {
  EXPECT_EQ(made.exit_code, 7) << made.errors;
  const std::string csv = text("data.csv");
  EXPECT_EQ(cinema_problem(csv, folder / "out/study.cdb"), "") << csv;
  const std::vector<CsvRow> rows = parse_csv(csv);
  ASSERT_EQ(rows.size(), 8u);
  const auto column = std::find(rows[0].begin(), rows[0].end(), "state") - rows[0].begin();
  EXPECT_EQ(rows[1][static_cast<std::size_t>(column)], "ok");
  EXPECT_EQ(rows[7][static_cast<std::size_t>(column)], "diverged");
  for (const char* file : {"sheet/0000.png", "sheet/0002.png", "strips.png", "plots.svg",
                           "report.html", "sweep.toml", "look.toml"})
    EXPECT_TRUE(exists("out/study.cdb/" + std::string(file))) << file;
  EXPECT_EQ(exists("out/study.cdb/sheet.mp4"), app::output::find_program("ffmpeg").has_value());

  const std::string sheet = text("sheet.png");
  EXPECT_EQ(sheet, text("sheet/0002.png"));
  for (const char* file : {"sheet.png", "data.csv", "report.html"})
    std::filesystem::remove(folder / ("out/study.cdb/" + std::string(file)));
  ASSERT_EQ(neve({"sweep", "collect", "out/study.cdb"}).exit_code, 0);
  EXPECT_EQ(text("sheet.png"), sheet);
  EXPECT_EQ(text("data.csv"), csv);
}

TEST_F(SweepResults, ResultsNameTheMissingRuns) {
  std::filesystem::remove_all(folder / "out/study.cdb/runs/0004");
  std::filesystem::remove(folder / "out/study.cdb/runs/0002/particles/0002.png");
  folder.write("out/study.cdb/runs/0003/run.json", "{ broken");
  const auto collected = neve({"sweep", "collect", "out/study.cdb"});
  EXPECT_EQ(collected.exit_code, 9) << "a run called ok is not whole";
  EXPECT_TRUE(contains(collected.errors, "run 2: particles/0002.png is missing; and 1 more runs"))
      << collected.errors;
  EXPECT_TRUE(contains(text("report.html"), "1 not finished"));
  EXPECT_EQ(neve({"sweep", "collect", "out"}).exit_code, 6);
  folder.write("out/study.cdb/manifest.json", "{}");
  EXPECT_EQ(neve({"sweep", "collect", "out/study.cdb"}).exit_code, 3);
}

/// Pixels of a picture that are lighter than a tile without a picture.
std::size_t lettered(const std::filesystem::path& file) {
  const render::Image image = app::output::read_picture(file);
  std::size_t count = 0;
  for (std::size_t k = 0; k < image.pixels.size(); k += static_cast<std::size_t>(image.channels))
    count += image.pixels[k] > 150;
  return count;
}

TEST_F(Cli, ASheetWithoutAnyPictureSaysWhyThereIsNone) {
  const auto sweep = [&](const char* limit, const char* out) {
    return neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5,10", "--set",
                 std::string("limits.particles=") + limit, "--size", "480x270", "--frames", "0-1",
                 "--out", out, "--quiet"});
  };
  EXPECT_EQ(sweep("10", "none").exit_code, 7);
  for (const char* file : {"sheet.png", "sheet/0000.png", "report.html"})
    EXPECT_TRUE(exists(std::string("none/") + file)) << file;
  EXPECT_FALSE(exists("none/strips.png")) << "moments of nothing";
  // "no picture", the state and its reason, on both tiles, besides the head and the edge.
  EXPECT_GT(lettered(folder / "none/sheet.png"), 2500u);
}

/// Pixels of the orange that names a failure.
std::size_t alarmed(const std::filesystem::path& sheet) {
  const render::Image image = app::output::read_picture(sheet);
  std::size_t count = 0;
  for (std::size_t k = 0; k < image.pixels.size(); k += static_cast<std::size_t>(image.channels))
    count += image.pixels[k] > 230 && image.pixels[k + 1] > 110 && image.pixels[k + 1] < 160 &&
             image.pixels[k + 2] < 110;
  return count;
}

TEST_F(Cli, ASheetOfRunsThatAllDivergedInOneFrameSaysSoOnTheLastPicture) {
  const auto result =
      neve({"sweep", "scene.toml", "-p", "solver.dt=2e-3,2.1e-3", "--set",
            "solver.time_step=\"fixed\"", "--set", "material.snow.youngs_modulus=5e7", "--set",
            "material.snow.model=\"corotated\"", "--set", "body.ball.velocity=[0, -8, 0]", "--size",
            "480x270", "--frames", "0-4", "--out", "burst", "--quiet"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_TRUE(exists("burst/sheet.png"));
  EXPECT_GT(alarmed(folder / "burst/sheet.png"), 200u) << "\"diverged\", on both tiles";
}

/// A browser without a window, if there is one.
std::optional<std::filesystem::path> browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    if (const auto program = app::output::find_program(name)) return program;
  return std::nullopt;
}

TEST_F(SweepResults, SweepResultsAreShownByABrowserThatMayNotReachAnything) {
  const auto program = browser();
  if (!program) SKIP_OR_FAIL("no chromium in PATH (Debian: chromium)");
  const std::string page = "file://" + (folder / "out/study.cdb/report.html").string();
  const std::vector<std::string> quiet{"--headless",
                                       "--no-sandbox",
                                       "--disable-gpu",
                                       "--user-data-dir=" + (folder / "profile").string(),
                                       "--host-resolver-rules=MAP * ~NOTFOUND",
                                       "--virtual-time-budget=5000"};
  std::vector<std::string> words = quiet;
  words.insert(words.end(), {"--dump-dom", page});
  const app::output::ProcessResult dom = app::output::run_process(*program, words, folder.path());
  ASSERT_EQ(dom.exit_code, 0) << dom.errors;
  // The script ran to its end and filled table and axes.
  EXPECT_TRUE(contains(dom.output, "data-ready=\"yes\"")) << dom.output.substr(0, 2000);
  const auto count = [&](const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = dom.output.find(what, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("id=\"run-"), 7u);
  EXPECT_GE(count("<path d="), 7u);
  EXPECT_EQ(count("<a href=\"#run-"), 7u);

  words = quiet;
  words.insert(words.end(), {"--window-size=1400,1800", "--hide-scrollbars",
                             "--screenshot=" + (folder / "shot.png").string(), page});
  ASSERT_EQ(app::output::run_process(*program, words, folder.path()).exit_code, 0);
  const std::string bytes = read_text(folder / "shot.png");
  const render::Image shot =
      render::decode_png({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  EXPECT_EQ(shot.width, 1400);
  // The sheet's dark paper is on the page, and so is the page's white.
  std::size_t dark = 0, white = 0;
  for (std::size_t k = 0; k + 2 < shot.pixels.size();
       k += static_cast<std::size_t>(shot.channels)) {
    dark += shot.pixels[k] == 30 && shot.pixels[k + 1] == 33;
    white += shot.pixels[k] == 255;
  }
  EXPECT_GT(dark, 10000u);
  EXPECT_GT(white, 100000u);
}

}  // namespace
}  // namespace neve::test
