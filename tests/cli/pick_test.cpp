/// `neve pick`: replayed clicks, continued searches, mistakes, and disks that fail.

#include <fmt/core.h>

#include <cerrno>
#include <string>
#include <utility>
#include <vector>

#include "app/support/errors.h"
#include "tests/cli/run_neve.h"
#include "tests/support/faulty_cli.h"

namespace neve::test {
namespace {

class PickCli : public Cli {
 protected:
  app::output::ProcessResult pick(const std::string& clicks, const std::string& out,
                                  std::vector<std::string> more = {}) {
    folder.write("list.txt", clicks);
    std::vector<std::string> arguments = {"pick",
                                          "scene.toml",
                                          "--clicks",
                                          "list.txt",
                                          "--out",
                                          out,
                                          "--frames",
                                          "2",
                                          "--size",
                                          "64x36",
                                          "--json",
                                          "-p",
                                          "material.snow.hardening=2,20",
                                          "-p",
                                          "material.snow.youngs_modulus=2e4,1e6"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return neve(arguments);
  }
};

TEST_F(PickCli, ADryRunSaysWhatTheRoundsCostAndWritesNothing) {
  const std::vector<std::string> dry{"--dry-run", "--coarsen", "2",        "--seeds",
                                     "2",         "--refine",  "--rounds", "3"};
  const auto planned = pick("1\n", "a", dry);
  ASSERT_EQ(planned.exit_code, 0) << planned.errors;
  EXPECT_FALSE(exists("a"));
  const app::Json plan = app::parse_json(std::string_view(planned.output));
  EXPECT_EQ(plan["runs"].size(), 18u);
  EXPECT_EQ(plan["rounds"], 3);
  EXPECT_EQ(plan["runs_in_all"], 54);
  EXPECT_EQ(plan["refinement"]["runs"], 2);
  EXPECT_GE(plan["seconds_in_all"].get<double>(), 3 * plan["seconds"].get<double>());
  // With --dry-run a search that has an answer tells its next round.
  ASSERT_EQ(pick("1\n", "b", {"--rounds", "2"}).exit_code, 0);
  const auto next = neve({"pick", "scene.toml", "--out", "b", "--frames", "2", "--size", "64x36",
                          "--rounds", "3", "-p", "material.snow.hardening=2,20", "-p",
                          "material.snow.youngs_modulus=2e4,1e6", "--dry-run"});
  ASSERT_EQ(next.exit_code, 0) << next.errors;
  EXPECT_TRUE(contains(next.output, "9 runs of scene.toml")) << next.output;
  EXPECT_TRUE(contains(next.output, "this is the next of 2 rounds: 18 runs, about")) << next.output;
  EXPECT_FALSE(exists("b/round_2.toml"));
  const auto over = pick("1\n", "b", {"--rounds", "1", "--dry-run"});
  EXPECT_EQ(over.exit_code, 0);
  EXPECT_TRUE(contains(over.errors, "all 1 rounds are answered")) << over.errors;
}

TEST_F(PickCli, ReplayedClicksGiveTheSamePickToTheBit) {
  const auto first = pick("# a comment\n3\n2 7\n", "a");
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  ASSERT_EQ(pick("3\n2 7\n", "b").exit_code, 0);
  for (const char* file : {"/picked.toml", "/picked_sweep.toml", "/learned.txt", "/map.svg",
                           "/clicks.txt", "/round_2.toml", "/sheet.png", "/round.html"})
    EXPECT_EQ(read_text(folder / ("a" + std::string(file))),
              read_text(folder / ("b" + std::string(file))))
        << file;
  const app::Json result = app::parse_json(std::string_view(first.output));
  EXPECT_EQ(result["rounds"], 2);
  EXPECT_TRUE(
      contains(read_text(folder / "a/picked.toml"),
               "hardening = " + result["values"]["material.snow.hardening"].get<std::string>()));
  // Both can be used as they are.
  EXPECT_EQ(neve({"render", "a/picked.toml", "--dry-run"}).exit_code, 0);
  EXPECT_EQ(neve({"sweep", "a/picked_sweep.toml", "--dry-run"}).exit_code, 0);
}

TEST_F(PickCli, ThePickKeepsTheCommentsOfItsScene) {
  folder.write("scene.toml", "# of the shot in the street\n" + std::string(tiny_scene));
  const auto made = pick("3\n", "a");
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  const std::string picked = read_text(folder / "a/picked.toml");
  EXPECT_TRUE(contains(picked, "# of the shot in the street")) << picked;
  EXPECT_TRUE(contains(picked, "# Picked with neve pick from scene.toml."));
  EXPECT_FALSE(contains(picked, "poisson_ratio")) << "what the scene does not say, it leaves out";
  EXPECT_EQ(neve({"render", "a/picked.toml", "--dry-run"}).exit_code, 0);
}

TEST_F(PickCli, ThePickIsShownCoarseAndAtFullResolution) {
  const auto made = pick("5\n", "a", {"--coarsen", "1.5", "--refine"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_EQ(app::parse_json(std::string_view(made.output))["pair"], "a/picked_pair.cdb/sheet.png");
  const app::Json manifest = json_of("a/picked_pair.cdb/manifest.json");
  ASSERT_EQ(manifest.at("runs").size(), 2u);
  EXPECT_EQ(manifest.at("runs")[0].at("label"), "coarsened 1.5x");
  neve({"render", "a/picked.toml", "--frames", "2", "--size", "64x36", "--out", "full",
        "--no-movie"});
  neve({"render", "a/picked.toml", "--frames", "2", "--size", "64x36", "--out", "coarse",
        "--coarsen", "1.5", "--no-movie"});
  EXPECT_EQ(hashes("a/picked_pair.cdb/runs/0000"), hashes("coarse")) << "as the tiles were";
  EXPECT_EQ(hashes("a/picked_pair.cdb/runs/0001"), hashes("full"));
  EXPECT_EQ(pick("5\n", "b", {"--refine"}).exit_code, app::exit_usage);
}

TEST_F(PickCli, ThePickIsShownWithAllOfItsSeeds) {
  const auto made = pick("5\n", "a", {"--coarsen", "1.5", "--refine", "--seeds", "2"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  const app::Json manifest = json_of("a/picked_pair.cdb/manifest.json");
  EXPECT_EQ(manifest.at("seeds"), 2);
  ASSERT_EQ(manifest.at("runs").size(), 4u);
  EXPECT_EQ(manifest.at("runs")[2].at("label"), "full resolution");
  neve({"render", "a/picked.toml", "--frames", "2", "--size", "64x36", "--out", "full", "--set",
        "seed=2", "--no-movie"});
  EXPECT_EQ(hashes("a/picked_pair.cdb/runs/0003"), hashes("full"));
  EXPECT_TRUE(exists("a/picked_pair.cdb/points.csv"));
  // The same command continues what was killed in between.
  std::filesystem::remove_all(folder / "a/picked_pair.cdb/runs/0003");
  ASSERT_EQ(pick("5\n", "a", {"--coarsen", "1.5", "--refine", "--seeds", "2"}).exit_code, 0);
  EXPECT_EQ(hashes("a/picked_pair.cdb/runs/0003"), hashes("full"));
}

TEST_F(PickCli, ThePickIsTheTileThatWasClickedLast) {
  const auto result = pick("5\n", "a");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const app::Json values = app::parse_json(std::string_view(result.output))["values"];
  const std::string round = read_text(folder / "a/round_1.toml");
  const std::string run = round.substr(round.find("label = \"5\""), 200);
  EXPECT_TRUE(contains(run, "= " + values["material.snow.hardening"].get<std::string>() + "\n"));
}

/// The favourite of the first round is shown again: 17 runs for 18 tiles.
TEST_F(PickCli, ItContinuesWithTheExistingRuns) {
  ASSERT_EQ(pick("4\n", "a").exit_code, 0);
  ASSERT_EQ(pick("4\n1\n", "a").exit_code, 0);
  ASSERT_EQ(pick("4\n1\n", "b").exit_code, 0);
  EXPECT_EQ(read_text(folder / "a/picked.toml"), read_text(folder / "b/picked.toml"));
  EXPECT_TRUE(exists("a/runs/0016"));
  EXPECT_FALSE(exists("a/runs/0017"));
  const auto other = pick("5\n", "a");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(contains(other.output + other.errors, "has other clicks from round 1 on"));
  const auto seeded = pick("4\n", "a", {"--seed", "2"});
  EXPECT_EQ(seeded.exit_code, 2);
  EXPECT_TRUE(contains(seeded.output + seeded.errors, "has another search"));
  const auto fewer = pick("4\n", "a", {"--rounds", "1"});
  EXPECT_EQ(fewer.exit_code, 2);
  EXPECT_TRUE(contains(fewer.output + fewer.errors,
                       "has the answers of 2 rounds, more than 1; give --rounds 2"))
      << fewer.errors;
}

TEST_F(PickCli, ClicksOnOtherSnowAreNotTakenOver) {
  ASSERT_EQ(pick("4\n", "a").exit_code, 0);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--set", "seed=3"}, {"--fast"}}) {
    const auto other = pick("4\n", "a", more);
    EXPECT_EQ(other.exit_code, 2) << more[0];
    EXPECT_TRUE(contains(other.output + other.errors, "has another search")) << other.errors;
  }
  const auto earlier = neve({"pick", "scene.toml", "--clicks", "list.txt", "--out", "a", "--frames",
                             "1", "--size", "64x36", "-p", "material.snow.hardening=2,20", "-p",
                             "material.snow.youngs_modulus=2e4,1e6"});
  EXPECT_EQ(earlier.exit_code, 2);
  EXPECT_TRUE(contains(earlier.errors, "has another search")) << earlier.errors;
  const std::string scene = read_text(folder / "scene.toml");
  folder.write("scene.toml", "# the same snow\n" + scene);
  EXPECT_EQ(pick("4\n", "a").exit_code, 0);
  folder.write("scene.toml", scene + "\n[material.snow]\ndensity = 300\n");
  const auto changed = pick("4\n", "a");
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_TRUE(contains(changed.output + changed.errors, "this one is: scene.toml ("))
      << changed.output << changed.errors;
  folder.write("scene.toml", scene);
  folder.write("a/round_1.toml", read_text(folder / "a/round_1.toml") + "\n");
  const auto tiles = pick("4\n", "a");
  EXPECT_EQ(tiles.exit_code, 2);
  EXPECT_TRUE(contains(tiles.output + tiles.errors, "has other tiles than this program chooses"));
}

TEST_F(PickCli, ClicksOnAnotherMeshAreNotTakenOver) {
  const auto mesh_with_side = [&](const std::string& s) {
    std::string text;
    for (const char* corner :
         {"- 0 -", "- 0 +", "- # -", "- # +", "+ 0 -", "+ 0 +", "+ # -", "+ # +"}) {
      text += "v ";
      for (const char* c = corner; *c; ++c)
        text += *c == '+' || *c == '#' ? s : *c == '-' ? "-" + s : std::string(1, *c);
      text += "\n";
    }
    folder.write("cube.obj", text +
                                 "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\n"
                                 "f 2 6 8 4\n");
  };
  mesh_with_side("0.1");
  folder.write("scene.toml",
               "frames = 2\n[solver]\ncell_size = 0.04\n[[body]]\n"
               "shape = { mesh = { file = \"cube.obj\" } }\n[output]\nsize = [64, 36]\n");
  const auto first = pick("4\n", "a");
  ASSERT_EQ(first.exit_code, 0) << first.output << first.errors;
  mesh_with_side("0.08");
  const auto changed = pick("4\n", "a");
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_TRUE(contains(changed.output + changed.errors, "has another search")) << changed.errors;
}

/// The favourite of a search may be a place that no tile has; the pick is a tile.
TEST_F(PickCli, WhatWasLearnedIsToldOfThePick) {
  const auto made = pick("3\n2 7\n", "a");
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  const app::Json result = app::parse_json(std::string_view(made.output));
  int told = 0;
  for (const auto& [name, value] : {std::pair{"hardening", "material.snow.hardening"},
                                    {"youngs_modulus", "material.snow.youngs_modulus"}})
    for (const app::Json& line : result["learned"]) {
      const std::string text = line.get<std::string>(),
                        picked = result["values"][value].get<std::string>();
      if (!text.starts_with(name) || contains(text, "no preference")) continue;
      ++told;
      EXPECT_TRUE(contains(text, fmt::format("{:.3g}", std::stod(picked)))) << text << picked;
    }
  EXPECT_GT(told, 0);
}

TEST_F(PickCli, WithoutATerminalItSaysHowToUseIt) {
  const auto result = neve({"pick", "scene.toml", "-p", "material.snow.hardening=2,20"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.errors, "--clicks FILE")) << result.errors;
  EXPECT_FALSE(exists("out"));
}

TEST_F(PickCli, MistakesAreToldBeforeAnythingIsMade) {
  folder.write("bad.txt", "3\n\n10\n");
  const std::vector<std::string> start = {"pick", "scene.toml", "--clicks", "bad.txt", "-p"};
  const auto message = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = start;
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_FALSE(exists("out"));
    return result.errors;
  };
  EXPECT_TRUE(contains(message({"material.snow.hardening=2,20"}), "bad.txt:3"));
  EXPECT_TRUE(contains(message({"material.snow.hardening=2"}), "has only one value"));
  EXPECT_TRUE(contains(message({"solver.transfer=apic,flip"}), "expected two numbers"));
  EXPECT_TRUE(contains(message({"material.snow.hardenin=2,20"}), "hardening"));
  EXPECT_TRUE(contains(message({"material.snow.hardening=2,20", "--rounds", "0"}), "--rounds"));
}

class PickOnAFullDisk : public FaultyCli {
 protected:
  /// Returns the command for a search on a screen that a script works.
  std::string command(const std::string& script) {
    folder.write("script.json", script);
    return "pick scene.toml --out a --frames 2 --size 64x36 --replay script.json "
           "-p material.snow.hardening=2,20";
  }
  static std::string full_disk(const std::string& part, const std::string& more = "") {
    return "write:" + std::to_string(ENOSPC) + ":" + part + ":0" + more;
  }
};

TEST_F(PickOnAFullDisk, AnAnswerThatCannotBeWrittenIsGivenAgain) {
  const auto result = failing(full_disk("clicks.txt", ":1"), command(R"([
    {"wait_for": "label Round 1 of 8"}, {"click": "tile 4"},
    {"wait_for": "label This round failed"}, {"wait": 3}, {"click": "Try again"},
    {"wait_for": "label Round 2 of 8"}, {"key": "q"}, {"wait_for": "label Picked"}, {"key": "q"}])"));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(read_text(folder / "a/clicks.txt"), "\n4\n"));
}

TEST_F(PickOnAFullDisk, ARoundThatCannotBeMadeEndsWithItsReasonAndContinuesLater) {
  const auto stopped = failing(full_disk("runs/0001/particles"), command(R"([
    {"wait_for": "label This round failed"}, {"wait": 3}, {"click": "Stop"}])"));
  EXPECT_EQ(stopped.exit_code, 6) << stopped.errors;
  EXPECT_TRUE(contains(stopped.errors, "No space left")) << stopped.errors;
  const auto more = failing("", command(R"([
    {"wait_for": "label Round 1 of 8"}, {"key": "2"}, {"wait_for": "label Round 2 of 8"},
    {"key": "q"}, {"wait_for": "label Picked"}, {"key": "q"}])"));
  EXPECT_EQ(more.exit_code, 0) << more.errors;
}

}  // namespace
}  // namespace neve::test
