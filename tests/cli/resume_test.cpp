/// Checkpoints: nothing is lost, and what follows is the same to the bit.

#include <algorithm>

#include "app/output/checkpoint.h"
#include "tests/support/resume.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

class Resume : public Cli {
 protected:
  app::output::ProcessResult render(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"render", "scene.toml", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }
  void expect_same(const std::string& a, const std::string& b) {
    const RunFiles x = files_of(folder / a), y = files_of(folder / b);
    EXPECT_EQ(x.hashes, y.hashes);
    ASSERT_EQ(x.pictures.size(), y.pictures.size());
    for (const auto& [name, bytes] : x.pictures) EXPECT_TRUE(y.pictures.at(name) == bytes) << name;
  }
  std::vector<fs::path> checkpoints(const std::string& out) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder / out / "checkpoint"))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
  }
};

TEST_F(Resume, AFinishedRunIsExtended) {
  ASSERT_EQ(render("whole").exit_code, 0);
  ASSERT_EQ(render("parts", {"--frames", "0-2"}).exit_code, 0);
  const auto more = render("parts", {"--frames", "0-4", "--resume"});
  ASSERT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_TRUE(contains(more.errors, "resumed after frame 2")) << more.errors;
  expect_same("whole", "parts");
  // The command has nothing left to do.
  EXPECT_EQ(render("parts", {"--frames", "0-4", "--resume"}).exit_code, 0);
  expect_same("whole", "parts");
}

TEST_F(Resume, KilledAtAnyInstantItEndsWithTheSameBits) {
  ASSERT_EQ(render("whole").exit_code, 0);
  EXPECT_EQ(kill_and_resume(folder / "scene.toml", folder / "parts", {6, 0.5, 1}), 6);
  EXPECT_EQ(kill_and_resume(folder / "scene.toml", folder / "parts", {2, 0.5, 2, SIGTERM}), 2);
  const auto last = render("parts", {"--resume", "--checkpoint-every", "1"});
  ASSERT_EQ(last.exit_code, 0) << last.errors;
  expect_same("whole", "parts");
}

TEST_F(Resume, ADamagedCheckpointIsNamedAndTheOlderOneTaken) {
  ASSERT_EQ(render("whole").exit_code, 0);
  ASSERT_EQ(render("parts", {"--frames", "0-3", "--checkpoint-every", "1"}).exit_code, 0);
  const auto files = checkpoints("parts");
  ASSERT_EQ(files.size(), 2u);
  std::vector<std::uint8_t> bytes = app::output::read_file(files.back());
  bytes[bytes.size() / 2] ^= 1;
  app::output::write_file(files.back(), bytes);
  const auto more = render("parts", {"--resume"});
  ASSERT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_TRUE(contains(more.errors, "checksum")) << more.errors;
  EXPECT_TRUE(contains(more.errors, "resumed after frame 2")) << more.errors;
  expect_same("whole", "parts");
}

/// A run of an older program continues, but nobody takes it for one of this program.
TEST_F(Resume, ACheckpointOfOtherSourcesIsNamed) {
  ASSERT_EQ(render("out", {"--frames", "0-2"}).exit_code, 0);
  app::output::Checkpoint checkpoint = *app::output::find_checkpoint(folder / "out").checkpoint;
  checkpoint.sources = "0123456789abcdef";
  // Earlier versions wrote no forces and no bodies either.
  for (app::Json& row : checkpoint.progress["history"])
    for (const int column : {7, 6}) row.erase(column);
  app::output::write_checkpoint(folder / "out", checkpoint);
  const auto more = render("out", {"--resume"});
  ASSERT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_TRUE(contains(more.errors, "a program with other sources")) << more.errors;
  const auto again = render("out", {"--resume"});
  EXPECT_FALSE(contains(again.errors, "other sources")) << again.errors;
  // The run keeps it in mind.
  const app::Json warnings = json_of("out/run.json")["warnings"];
  ASSERT_EQ(warnings.size(), 1u) << warnings;
  EXPECT_TRUE(contains(warnings[0], "a program with other sources"));
  // No program makes its states again from the start, so nothing is added beside them.
  const auto beside = render("out", {"--frames", "0-6"});
  EXPECT_EQ(beside.exit_code, 2);
  EXPECT_TRUE(contains(beside.errors, "different instructions or programs have made its parts"))
      << beside.errors;
}

/// Builds from other sources may lay a state out in another way: its first bytes say so.
TEST_F(Resume, AStateThatAnotherBuildWroteInItsOwnWayIsPassedOverOrRefused) {
  ASSERT_EQ(render("out", {"--frames", "0-2"}).exit_code, 0);
  const auto hash_at = [&] {
    const auto dump = neve({"dump", "out", "--at", "0.1", "--json"});
    EXPECT_EQ(dump.exit_code, 0) << dump.errors;
    return app::parse_json(std::string_view(dump.output)).value("state_hash", "");
  };
  const std::string before = hash_at();
  app::output::Checkpoint checkpoint = *app::output::find_checkpoint(folder / "out").checkpoint;
  checkpoint.state[7] ^= 1;
  app::output::write_checkpoint(folder / "out", checkpoint);
  std::filesystem::remove_all(folder / "out/states");
  EXPECT_EQ(hash_at(), before) << "simulated from the start";
  const auto more = render("out", {"--resume"});
  EXPECT_EQ(more.exit_code, 2) << more.errors;
  EXPECT_TRUE(contains(more.errors, "another build of neve has begun the run in out"))
      << more.errors;
  EXPECT_TRUE(contains(more.errors, "--replace instead of --resume")) << more.errors;
}

TEST_F(Resume, AnotherSceneIsRefusedAndNothingIsTouched) {
  ASSERT_EQ(render("out", {"--frames", "0-2"}).exit_code, 0);
  const RunFiles before = files_of(folder / "out");
  const auto other = render("out", {"--resume", "--set", "material.snow.hardening=5"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(contains(other.errors, "--resume")) << other.errors;
  EXPECT_TRUE(contains(other.errors, "material.snow.hardening was 10")) << other.errors;
  EXPECT_TRUE(contains(other.errors, " and is 5")) << other.errors;
  EXPECT_EQ(files_of(folder / "out").pictures, before.pictures);
  // Without --resume the run is replaced where that is asked for, checkpoints too.
  ASSERT_EQ(render("out", {"--frames", "0-1", "--checkpoint-every", "0", "--replace", "--set",
                           "material.snow.hardening=5"})
                .exit_code,
            0);
  EXPECT_FALSE(exists("out/checkpoint"));
}

/// Checkpoints know the first drawing of a run: what was drawn since was replaced by it.
TEST_F(Resume, ARunThatWasDrawnAgainContinuesInItsNewDrawingOrIsRefused) {
  ASSERT_EQ(render("whole", {"--quality", "final", "--no-movie"}).exit_code, 0);
  ASSERT_EQ(render("a", {"--frames", "0-2", "--no-movie"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "a", "--quality", "final", "--replace", "--no-movie"}).exit_code, 0);
  const RunFiles before = files_of(folder / "a");
  const auto refused = render("a", {"--resume", "--no-movie"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.errors, "a has particles of this run, drawn otherwise"))
      << refused.errors;
  EXPECT_FALSE(contains(refused.errors, "not the file that the run wrote")) << refused.errors;
  EXPECT_TRUE(files_of(folder / "a").pictures == before.pictures);
  // Its folder says how it is drawn.
  const auto more = neve({"render", "a", "--resume", "--no-movie"});
  EXPECT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_FALSE(contains(more.errors, "made again")) << more.errors;
  expect_same("whole", "a");
}

TEST_F(Resume, ARunThatGotPassesLaterContinuesWithThem) {
  ASSERT_EQ(render("whole", {"--passes", "depth", "--no-movie"}).exit_code, 0);
  ASSERT_EQ(render("a", {"--frames", "0-2", "--no-movie"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "a", "--passes", "depth", "--replace", "--no-movie"}).exit_code, 0);
  const auto more = neve({"render", "a", "--resume", "--no-movie"});
  ASSERT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_FALSE(contains(more.errors, "made again")) << more.errors;
  EXPECT_TRUE(exists("a/particles/0004.exr"));
  expect_same("whole", "a");
}

TEST_F(Resume, ARunWithoutACheckpointStartsAtTheBeginning) {
  const auto result = render("out", {"--resume", "--frames", "0-1"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.errors, "starts at its first frame")) << result.errors;
  EXPECT_EQ(render("out", {"--checkpoint-every", "-1"}).exit_code, 2);
}

/// A run whose early picture was made again went from the newest state, past what was missing.
TEST_F(Resume, PicturesThatAreMissingAfterTheCheckpointAreMadeToo) {
  ASSERT_EQ(render("whole").exit_code, 0);
  ASSERT_EQ(render("parts", {"--checkpoint-every", "2"}).exit_code, 0);
  const auto files = checkpoints("parts");
  ASSERT_EQ(files.size(), 2u);
  fs::remove(files.back());
  fs::remove(folder / "parts/particles/0001.png");
  fs::remove(folder / "parts/particles/0003.png");
  const auto more = render("parts", {"--resume"});
  ASSERT_EQ(more.exit_code, 0) << more.errors;
  expect_same("whole", "parts");
  EXPECT_EQ(neve({"verify", "parts"}).exit_code, 0);
}

}  // namespace
}  // namespace neve::test
