/// Sweeps whose points have several seeds, from the command to the folder.

#include <algorithm>

#include "tests/cli/run_neve.h"
#include "tests/support/cinema.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

class SweepSeeds : public Cli {
 protected:
  SweepSeeds() { folder.write("scene.toml", tiny_scene); }

  /// Runs that the sweep started.
  int started(std::vector<std::string> further) {
    std::vector<std::string> words{
        "sweep",    "scene.toml", "-p",     "material.snow.hardening=5,20",
        "--frames", "2",          "--size", "160x90",
        "--json",   "--out",      "out/s"};
    words.insert(words.end(), further.begin(), further.end());
    const app::output::ProcessResult made = neve(words);
    EXPECT_EQ(made.exit_code, 0) << made.errors;
    return app::parse_json(made.output).at("started").get<int>();
  }

  std::vector<CsvRow> table(const std::string& file) {
    return parse_csv(read_text(folder / ("out/s/" + file)));
  }
};

TEST_F(SweepSeeds, SeedsContinueASweepWithoutThemAndAnotherNumberOfThemContinuesBoth) {
  EXPECT_EQ(started({}), 2);
  EXPECT_EQ(table("data.csv").size(), 3u);
  EXPECT_FALSE(exists("out/s/points.csv"));
  EXPECT_EQ(started({"--seeds", "2"}), 2) << "the scene's seed is one of them";
  EXPECT_EQ(table("data.csv").size(), 5u);
  ASSERT_EQ(table("points.csv").size(), 3u);
  EXPECT_EQ(cinema_problem(read_text(folder / "out/s/data.csv"), folder / "out/s"), "");
  EXPECT_EQ(started({"--seeds", "3"}), 2);
  EXPECT_EQ(started({"--seeds", "3"}), 0);
  const std::vector<CsvRow> runs = table("data.csv");
  const auto seed = std::find(runs[0].begin(), runs[0].end(), "seed") - runs[0].begin();
  std::string seeds;
  for (std::size_t k = 1; k < runs.size(); ++k) seeds += runs[k][static_cast<std::size_t>(seed)];
  EXPECT_EQ(seeds, "123123");
  EXPECT_EQ(neve({"verify", "out/s"}).exit_code, 0);
  const std::string points = read_text(folder / "out/s/points.csv");
  EXPECT_EQ(neve({"sweep", "collect", "out/s", "--quiet"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "out/s/points.csv"), points);
  EXPECT_EQ(started({}), 0);
  EXPECT_FALSE(exists("out/s/points.csv")) << "a table of other runs would be taken for theirs";
}

TEST_F(SweepSeeds, TheCostOfAllSeedsIsSaidBefore) {
  const app::output::ProcessResult plan = neve(
      {"sweep", "scene.toml", "-p", "material.snow.hardening=5,20", "--seeds", "4", "--dry-run"});
  EXPECT_EQ(plan.exit_code, 0) << plan.errors;
  EXPECT_NE(plan.output.find("8 runs of scene.toml, 4 seeds of each point"), std::string::npos)
      << plan.output;
  EXPECT_NE(plan.output.find("seed = 4"), std::string::npos) << plan.output;
}

TEST_F(SweepSeeds, TheTilesOfAPickSayWhatOtherSeedsDo) {
  folder.write("clicks.txt", "2\n");
  const app::output::ProcessResult made =
      neve({"pick", "scene.toml", "-p", "material.snow.hardening=5,20", "--frames", "1", "--size",
            "160x90", "--seeds", "2", "--clicks", "clicks.txt", "--rounds", "1", "--out", "out/p"});
  EXPECT_EQ(made.exit_code, 0) << made.errors;
  const std::string page = read_text(folder / "out/p/round.html");
  EXPECT_NE(page.find("<small>holds in 2 of 2"), std::string::npos) << page;
  EXPECT_NE(page.find("too close to call"), std::string::npos);
  std::size_t tiles = 0;
  for (std::size_t at = page.find("<figure>"); at != std::string::npos;
       at = page.find("<figure>", at + 1))
    ++tiles;
  EXPECT_EQ(tiles, 9u);
}

}  // namespace
}  // namespace neve::test
