/// Sweeps whose runs fork from an existing run, or a picture.

#include "app/record/picture_record.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

class SweepFrom : public Cli {
 protected:
  app::output::ProcessResult sweep(const std::string& source, const std::vector<std::string>& more,
                                   const std::string& out = "f.cdb") {
    std::vector<std::string> words{"sweep", source,   "--from", "0.125s", "--size",
                                   "96x54", "--json", "--out",  out};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }

  void render(const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", "--no-movie", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = neve(words);
    ASSERT_EQ(done.exit_code, 0) << done.errors;
  }

  /// The frames of a branch are those of a whole run that its picture describes.
  void expect_whole(const std::string& run, int last) {
    char name[32];
    std::snprintf(name, sizeof name, "%04d.png", last);
    render({run + "/particles/" + name, "--frames", "0-" + std::to_string(last), "--out", "whole",
            "--replace"});
    const auto whole = hashes("whole");
    for (const auto& [frame, hash] : hashes(run)) EXPECT_EQ(whole.at(frame), hash) << frame;
  }

  static int started(const app::output::ProcessResult& done) {
    return app::parse_json(std::string_view(done.output))["started"];
  }
};

const std::vector<std::string> three{"-p", "material.snow.hardening=4,10,20", "--frames", "6"};

TEST_F(SweepFrom, BranchesOfARunAreThoseOfRenderAndOfWholeRuns) {
  render({"scene.toml", "--frames", "6", "--checkpoint-every", "1", "--out", "a"});
  const auto done = sweep("a", three);
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_TRUE(contains(done.errors, "the runs fork from a at 0.125 s")) << done.errors;
  EXPECT_EQ(hashes("f.cdb/runs/0000").begin()->first, 4);
  render({"a", "--from", "0.125s", "--set", "material.snow.hardening=4", "--frames", "6", "--out",
          "b"});
  EXPECT_EQ(hashes("b"), hashes("f.cdb/runs/0000"));
  expect_whole("f.cdb/runs/0000", 6);
  expect_whole("f.cdb/runs/0002", 6);
  // The value of the scene gives the run itself.
  EXPECT_EQ(hashes("f.cdb/runs/0001").at(6), hashes("a").at(6));
  EXPECT_NE(hashes("f.cdb/runs/0000").at(6), hashes("a").at(6));
}

/// Branches of a sweep know the same start as branches of render.
TEST_F(SweepFrom, BranchesOfARunKnowWhatWasBeforeThem) {
  render({"scene.toml", "--frames", "6", "--out", "a"});
  render({"a", "--from", "0.125s", "--set", "material.snow.hardening=4", "--frames", "6", "--out",
          "b"});
  ASSERT_EQ(sweep("a", three).exit_code, 0);
  const app::Json start = json_of("b/run.json")["start"];
  ASSERT_TRUE(start.contains("before")) << start;
  EXPECT_EQ(json_of("f.cdb/runs/0000/run.json")["start"], start);
}

TEST_F(SweepFrom, APictureAndARunWithoutCheckpointsGiveTheSameBranches) {
  render({"scene.toml", "--frames", "4", "--checkpoint-every", "0", "--out", "a"});
  ASSERT_EQ(sweep("a", three).exit_code, 0);
  const auto done = sweep("a/particles/0003.png", three, "g.cdb");
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  for (const char* run : {"0000", "0001", "0002"})
    EXPECT_EQ(hashes(std::string("g.cdb/runs/") + run), hashes(std::string("f.cdb/runs/") + run));
}

TEST_F(SweepFrom, ChangesMadeBeforeAreTakenAlongAndLaterOnesAreNot) {
  render({"scene.toml", "--frames", "6", "--checkpoint-every", "1", "--out", "a"});
  render({"a", "--from", "0.05s", "--set", "solver.gravity=[4, -9.81, 0]", "--frames", "6",
          "--checkpoint-every", "1", "--out", "b"});
  render({"b", "--from", "0.2s", "--set", "material.snow.hardening=30", "--frames", "6", "--out",
          "c"});
  ASSERT_EQ(sweep("c", three).exit_code, 0);
  expect_whole("f.cdb/runs/0000", 6);
  const auto record =
      app::record::read_picture_record(folder / "f.cdb/runs/0000/particles/0006.png");
  ASSERT_EQ(record.changes.size(), 2u);
  EXPECT_EQ(record.changes[0].address, "solver.gravity");
  EXPECT_EQ(record.changes[1].value, "4");
  EXPECT_EQ(hashes("f.cdb/runs/0001").at(6), hashes("b").at(6)) << "without the later change";
}

TEST_F(SweepFrom, SetIsMadeWithTheAxesInAllRuns) {
  render({"scene.toml", "--frames", "6", "--out", "a"});
  auto words = three;
  words.insert(words.end(), {"--set", "solver.gravity=[4, -9.81, 0]"});
  ASSERT_EQ(sweep("a", words).exit_code, 0);
  render({"a", "--from", "0.125s", "--set", "material.snow.hardening=20", "--set",
          "solver.gravity=[4, -9.81, 0]", "--frames", "6", "--out", "b"});
  EXPECT_EQ(hashes("b"), hashes("f.cdb/runs/0002"));
  // The report says how.
  EXPECT_TRUE(contains(read_text(folder / "f.cdb/report.html"), "solver.gravity"));
}

TEST_F(SweepFrom, TheSweepContinuesWithoutTheRunThatItLeft) {
  render({"scene.toml", "--frames", "4", "--out", "a"});
  EXPECT_EQ(started(sweep("a", three)), 3);
  EXPECT_EQ(started(sweep("a", three)), 0);
  EXPECT_EQ(started(sweep("a", {"-p", "material.snow.hardening=4,10,20,30", "--frames", "6"})), 1);
  std::filesystem::remove_all(folder / "a");
  std::filesystem::remove_all(folder / "f.cdb/runs/0001/particles");
  ASSERT_EQ(neve({"sweep", "run", "f.cdb", "--index", "1"}).exit_code, 0);
  std::filesystem::remove_all(folder / "f.cdb/beginning/checkpoint");
  std::filesystem::remove_all(folder / "f.cdb/runs/0001/particles");
  const auto lost = neve({"sweep", "run", "f.cdb", "--index", "1"});
  EXPECT_EQ(lost.exit_code, 6);
  EXPECT_TRUE(contains(lost.errors, "repeat the same neve sweep --from, which takes it from a"))
      << lost.errors;
}

TEST_F(SweepFrom, MistakesAreSaidBeforeAnyRun) {
  render({"scene.toml", "--frames", "4", "--out", "a"});
  const auto refused = [&](const std::vector<std::string>& words, const char* why) {
    std::vector<std::string> all{"sweep"};
    all.insert(all.end(), words.begin(), words.end());
    const auto done = neve(all);
    EXPECT_EQ(done.exit_code, 2) << done.errors;
    EXPECT_TRUE(contains(done.errors, why)) << done.errors;
  };
  refused({"a", "--from", "0.125s", "-p", "solver.cell_size=0.04,0.05"},
          "--from: solver.cell_size cannot change while a simulation runs; parameters that can: "
          "solver.threshold_cell, solver.kernel");
  refused({"a", "-p", "material.snow.hardening=4,5"}, "add --from TIME");
  refused({"scene.toml", "--from", "0.125s", "-p", "material.snow.hardening=4,5"},
          "for a scene or a sweep file, give --fork 0.125s");
  refused({"a", "--from", "0.1s", "--fork", "0.1s", "-p", "material.snow.hardening=4,5"},
          "cannot be combined with --from");
  refused({"a", "--from", "9s", "-p", "material.snow.hardening=4,5"}, "at or after frame 4");
  refused({"a", "--from", "0.1s", "--coarsen", "2", "-p", "material.snow.hardening=4,5"},
          "--coarsen");
  refused({"a", "--from", "0.1s"}, "no parameter varies");
  EXPECT_FALSE(exists("out"));
}

}  // namespace
}  // namespace neve::test
