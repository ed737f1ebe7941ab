/// A machine that fails: nothing is lost, nothing is called ok, and the same command continues.

#include <cerrno>
#include <cstring>
#include <string>

#include "tests/support/faulty_cli.h"
#include "tests/support/killed.h"

namespace neve::test {
namespace {

class Faults : public FaultyCli {
 protected:
  std::string state(const std::string& run) {
    return json_of("s/runs/" + run + "/status.json")["state"].get<std::string>();
  }
  std::string fault(const char* operation, int error, const std::string& part, int skip = 0) {
    return std::string(operation) + ":" + std::to_string(error) + ":" + part + ":" +
           std::to_string(skip);
  }
  const std::string sweep = "sweep scene.toml -p seed=1,2,3 --frames 0-2 --out s --jobs 1";
};

TEST_F(Faults, PicturesAndRunJsonReachTheDiskBeforeTheCheckpoint) {
  const auto result = failing("", "render scene.toml --out out --frames 0-2 --checkpoint-every 2");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string calls = read_text(folder / "calls");
  const std::size_t checkpoint = calls.find("rename out/checkpoint/000002-");
  ASSERT_NE(checkpoint, std::string::npos) << calls;
  const std::string out = "fsync " + (folder / "out").string();
  for (const char* name : {"/particles/0000.png\n", "/particles/0001.png\n",
                           "/particles/0002.png\n", "/particles\n", "/run.json\n", "\n"})
    EXPECT_LT(calls.find(out + name), checkpoint) << name << calls;
  EXPECT_NE(calls.find("fsync " + (folder / "out/checkpoint").string() + "\n", checkpoint),
            std::string::npos)
      << calls;
}

/// The next frame is simulated while the state of the last one is still being written.
TEST_F(Faults, ASlowDiskHurtsNoFrameThatIsSimulatedBeside) {
  const auto quick =
      neve({"render", "scene.toml", "--threads", "4", "--no-movie", "--out", "quick"});
  ASSERT_EQ(quick.exit_code, 0) << quick.errors;
  const auto slow =
      failing("rename:0:slow/states/", "render scene.toml --threads 4 --no-movie --out slow");
  ASSERT_EQ(slow.exit_code, 0) << slow.errors;
  const RunFiles expected = files_of(folder / "quick"), found = files_of(folder / "slow");
  EXPECT_TRUE(found.hashes == expected.hashes && found.pictures == expected.pictures);
  EXPECT_EQ(json_of("slow/run.json")["states"]["frames"],
            json_of("quick/run.json")["states"]["frames"]);
}

TEST_F(Faults, AFullDiskStopsASweepAndTheSameCommandContinues) {
  for (const int error : {ENOSPC, EIO, EDQUOT}) {
    const auto stopped = failing(fault("write", error, "runs/0001/particles", 1), sweep);
    EXPECT_EQ(stopped.exit_code, 6) << stopped.errors;
    EXPECT_TRUE(contains(stopped.errors, "the sweep stopped: run ")) << stopped.errors;
    EXPECT_TRUE(contains(stopped.errors, std::strerror(error))) << stopped.errors;
    EXPECT_EQ(state("0001"), "interrupted");
    for (const char* run : {"0000", "0002"})
      EXPECT_TRUE(state(run) == "ok" || state(run) == "pending") << run << " " << state(run);
    const auto more = failing("", sweep);
    EXPECT_EQ(more.exit_code, 0) << more.errors;
    for (const char* run : {"0000", "0001", "0002"}) EXPECT_EQ(state(run), "ok");
    EXPECT_EQ(neve({"verify", "s"}).exit_code, 0);
    std::filesystem::remove_all(folder / "s");
  }
}

TEST_F(Faults, AMovieOnAFullDiskIsNoSuccessAndResumeMakesIt) {
  if (!app::output::find_program("ffmpeg")) GTEST_SKIP() << "no ffmpeg";
  const std::string render = "render scene.toml --out out --frames 0-2 --replace";
  for (const char* operation : {"open", "write", "rename"}) {
    const auto full = failing(fault(operation, ENOSPC, "particles.mp4"), render);
    EXPECT_EQ(full.exit_code, 6) << operation << full.errors;
    EXPECT_FALSE(exists("out/particles.mp4")) << operation;
    EXPECT_EQ(json_of("out/run.json")["warnings"].size(), 1u) << operation;
    EXPECT_EQ(failing("", "render scene.toml --out out --frames 0-2").exit_code, 0);
    EXPECT_TRUE(exists("out/particles.mp4")) << operation;
    EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
  }
}

TEST_F(Faults, EveryWriteOfARunFailsOnceAndTheSameCommandEndsWithTheSameBits) {
  const std::string render =
      "render scene.toml --out out --frames 0-2 --checkpoint-every 1 --resume";
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "whole", "--frames", "0-2"}).exit_code, 0);
  const RunFiles whole = files_of(folder / "whole");
  for (const char* operation : {"write", "rename", "fsync"})
    for (int skip = 0; skip < 100; skip += skip < 3 ? 1 : 5) {
      std::filesystem::remove_all(folder / "out");
      const auto result = failing(fault(operation, skip % 2 ? ENOSPC : EIO, "out/", skip), render);
      if (result.exit_code == 0) {
        EXPECT_EQ(neve({"verify", "out"}).exit_code, 0) << operation << skip << result.errors;
        break;
      }
      EXPECT_EQ(result.exit_code, 6) << operation << skip << result.errors;
      const auto more = failing("", render);
      ASSERT_EQ(more.exit_code, 0) << operation << skip << more.errors;
      const RunFiles found = files_of(folder / "out");
      EXPECT_EQ(found.hashes, whole.hashes);
      EXPECT_TRUE(found.pictures == whole.pictures) << operation << skip;
      EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
    }
}

TEST_F(Faults, AfterAPowerCutTheSameCommandEndsWithTheSameBits) {
  EXPECT_EQ(cut_power(20, 1), 20);
}

TEST_F(Faults, AStatusThatCannotBeWrittenStopsASweepAndTheSameCommandContinues) {
  const auto stopped = failing(fault("write", ENOSPC, "runs/0001/.status", 1), sweep);
  EXPECT_EQ(stopped.exit_code, 6) << stopped.errors;
  EXPECT_EQ(failing("", sweep).exit_code, 0);
  EXPECT_EQ(neve({"verify", "s"}).exit_code, 0);
}

TEST_F(Faults, ARunThatCannotBeLockedIsNotSkipped) {
  for (const int error : {ENOLCK, EIO}) {
    const auto stopped = failing(fault("flock", error, "runs/0001/"), sweep);
    EXPECT_EQ(stopped.exit_code, 6) << stopped.errors;
    EXPECT_TRUE(contains(stopped.errors, "cannot lock the folder")) << stopped.errors;
    EXPECT_NE(state("0001"), "failed");
  }
  const auto opened = failing(fault("open", EMFILE, "runs/0001/.sweep.lock"), sweep);
  EXPECT_EQ(opened.exit_code, 6) << opened.errors;
  EXPECT_EQ(failing("", sweep).exit_code, 0);
}

TEST_F(Faults, ARunInProgressElsewhereIsNotCalledFinished) {
  ASSERT_EQ(neve({"sweep", "scene.toml", "-p", "seed=1,2", "--frames", "0-2", "--out", "s",
                  "--emit", "commands"})
                .exit_code,
            0);
  const auto busy = app::output::run_process(
      "/bin/bash",
      {"-c",
       "exec 9>s/runs/0001/.sweep.lock; flock 9; \"$0\" sweep run s --index 1 9>&-; echo $?;"
       "\"$0\" sweep scene.toml -p seed=1,2 --frames 0-2 --out s 9>&-; echo $?",
       NEVE_BINARY},
      folder.path());
  EXPECT_EQ(busy.output, "6\n75\n") << busy.errors;
  EXPECT_TRUE(contains(busy.errors, "run 1 is in progress")) << busy.errors;
}

TEST_F(Faults, TwoSweepsInOneFolderAreOneSweep) {
  const pid_t first =
      start_program({NEVE_BINARY, "sweep", folder / "scene.toml", "-p", "solver.max_dt=1e-6,1.1e-6",
                     "--out", folder / "s", "--quiet"});
  ASSERT_TRUE(wait_for_file(folder / "s/runs/0001/particles/0000.png"));
  const auto second = neve({"sweep", "scene.toml", "-p", "solver.max_dt=1e-6", "--out", "s"});
  EXPECT_EQ(second.exit_code, 6);
  EXPECT_TRUE(contains(second.errors, "is in use by neve sweep, process " + std::to_string(first)))
      << second.errors;
  ::kill(first, SIGTERM);
  EXPECT_EQ(wait_for(first), 75);
  EXPECT_EQ(json_of("s/manifest.json")["runs"].size(), 2u);
}

/// No process takes these runs into its care: what was killed while it planned them is removed by
/// the next one that plans.
TEST_F(Faults, ASweepThatOnlyPlansRemovesWhatAnotherHadNotFinished) {
  const std::vector<std::string> plan{"sweep", "scene.toml", "-p", "seed=1,2", "--frames",
                                      "0-1",   "--out",      "s",  "--emit",   "commands"};
  ASSERT_EQ(neve(plan).exit_code, 0);
  std::filesystem::remove(folder / "s/runs/0000/scene.toml");
  std::filesystem::remove(folder / "s/runs/0001/status.json");
  leave_unfinished({folder / "s/runs/0000", folder / "s/runs/0001"});
  ASSERT_EQ(neve(plan).exit_code, 0);
  expect_nothing_unfinished(folder.path(), "a second plan");
}

TEST_F(Faults, ARunThatCrashedIsRepeatedFromItsCheckpoint) {
  // Steps so short that it is killed long before its end.
  std::vector<std::string> words{
      "sweep", folder / "scene.toml", "-p", "solver.max_dt=4e-5", "--frames", "0-17",
      "--out", folder / "s"};
  std::vector<std::string> command{NEVE_BINARY};
  command.insert(command.end(), words.begin(), words.end());
  const pid_t sweep_process = start_program(command);
  const std::filesystem::path run = folder / "s/runs/0000";
  ASSERT_TRUE(wait_for_file(run / "particles/0011.png"));
  ::kill(json_of("s/runs/0000/status.json")["pid"].get<int>(), SIGSEGV);
  EXPECT_EQ(wait_for(sweep_process), 7);
  ASSERT_EQ(state("0000"), "crashed");
  const auto written = std::filesystem::last_write_time(run / "particles/0005.png");
  words.emplace_back("--retry-failed=crashed");
  const auto retried = neve(words);
  EXPECT_EQ(retried.exit_code, 0) << retried.errors;
  EXPECT_EQ(json_of("s/runs/0000/status.json")["attempts"], 2);
  EXPECT_EQ(std::filesystem::last_write_time(run / "particles/0005.png"), written)
      << "frames before the checkpoint are made again";
  ASSERT_EQ(neve({"render", "scene.toml", "--set", "solver.max_dt=4e-5", "--frames", "0-17",
                  "--no-movie", "--out", "whole"})
                .exit_code,
            0);
  EXPECT_EQ(json_of("s/runs/0000/run.json")["frames"].back()["state_hash"],
            json_of("whole/run.json")["frames"].back()["state_hash"]);
}

TEST_F(Faults, FailedRunsAreRepeatedByTheirState) {
  folder.write("sweep.toml", std::string("[sweep]\nscene = \"scene.toml\"\nframes = \"0-2\"\n") +
                                 exploding_run + "[[run]]\nlabel = \"calm\"\n");
  const auto made = neve({"sweep", "sweep.toml", "--out", "s"});
  ASSERT_EQ(made.exit_code, 7) << made.errors;
  const auto attempts = [&] { return json_of("s/runs/0000/status.json")["attempts"].get<int>(); };
  EXPECT_EQ(attempts(), 1);
  EXPECT_EQ(neve({"sweep", "sweep.toml", "--out", "s", "--retry-failed=timeout,crashed"}).exit_code,
            7);
  EXPECT_EQ(attempts(), 1);
  EXPECT_EQ(neve({"sweep", "--retry-failed=diverged", "sweep.toml", "--out", "s"}).exit_code, 7);
  EXPECT_EQ(attempts(), 2);
  EXPECT_EQ(neve({"sweep", "--retry-failed", "sweep.toml", "--out", "s"}).exit_code, 7);
  EXPECT_EQ(attempts(), 3);
  const auto wrong = neve({"sweep", "sweep.toml", "--out", "s", "--retry-failed=pending"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(contains(wrong.errors, "timeout")) << wrong.errors;
}

/// A file that cannot be read is not a missing one: nothing is collected without it, and nothing
/// that it lists stays behind.
TEST_F(Faults, AFileThatCannotBeReadEndsTheCommandAndIsNotTakenForMissing) {
  ASSERT_EQ(failing("", sweep).exit_code, 0);
  for (const char* file : {"status.json", "run.json", "particles/0001.png"}) {
    const auto result =
        failing(fault("read", EIO, std::string("runs/0001/") + file), "sweep collect s");
    // A picture of a run is named as its flaw.
    EXPECT_TRUE(result.exit_code == 6 || result.exit_code == 9) << file << result.errors;
    EXPECT_TRUE(contains(result.errors, std::string(file) + ": cannot read: Input/output error"))
        << result.errors;
    EXPECT_EQ(failing("", "sweep collect s").exit_code, 0) << file;
  }
  ASSERT_EQ(failing("", "render scene.toml --out out --frames 0-3 --no-movie").exit_code, 0);
  const std::string shorter =
      "render scene.toml --out out --frames 0-1 --no-movie --replace --set seed=2";
  for (const std::string& one :
       {fault("read", EIO, "out/run.json"), fault("remove", EIO, "out/particles/0003.png")}) {
    const auto result = failing(one, shorter);
    EXPECT_EQ(result.exit_code, 6) << one << result.errors;
    EXPECT_TRUE(exists("out/particles/0003.png"));
  }
  // Days of a run are not made again for a checkpoint that could not be read once.
  const std::string longer = "render scene.toml --out out --frames 0-4 --no-movie --resume";
  EXPECT_EQ(failing(fault("read", EIO, "out/checkpoint/"), longer).exit_code, 6);
  EXPECT_EQ(failing("", shorter).exit_code, 0);
  EXPECT_FALSE(exists("out/particles/0003.png"));
  EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
}

/// The second of two that collect waits.
TEST_F(Faults, OneCollectsAtATime) {
  ASSERT_EQ(failing("", sweep).exit_code, 0);
  const auto result = app::output::run_process(
      "/bin/bash",
      {"-c",
       "exec 9>s/.collect.lock; flock 9; \"$0\" sweep collect s 2>said 9>&- & sleep 1; "
       "cat said; exec 9>&-; wait $!; echo $?",
       NEVE_BINARY},
      folder.path());
  EXPECT_TRUE(contains(result.output, "waits for another process")) << result.output;
  EXPECT_TRUE(result.output.ends_with("\n0\n")) << result.output << read_text(folder / "said");
}

}  // namespace
}  // namespace neve::test
