/// Slurm sites that print banners and take only some jobs, as scripts in the place of its programs.

#include <sstream>

#include "app/support/errors.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

/// Arrays have at most 3 tasks. Every third look at the queue finds it empty.
constexpr const char* scontrol = "echo 'MaxArraySize = 3'\n";
constexpr const char* squeue =
    "echo look >> looks; [ $(($(wc -l < looks) % 3)) = 0 ] && rm -f living full\n"
    "echo 'Maintenance on Monday'; cat living 2>/dev/null; exit 0\n";
/// An sbatch that takes one job a time while the file `full` exists.
constexpr const char* sbatch =
    "cp out/slurm/jobs.json seen.json 2>/dev/null\n"
    "if [ -e full ] && [ -s living ]; then echo 'QOSMaxSubmitJobPerUserLimit' >&2; exit 1; fi\n"
    "echo \"$@\" >> calls; n=$((4710 + $(wc -l < calls))); echo $n $n >> living\n"
    "echo; echo 'Welcome to the cluster, 3 nodes are free'; echo \"$n;cluster\"; echo\n";

class SlurmSites : public Cli {
 protected:
  SlurmSites() {
    script("scontrol", scontrol);
    script("squeue", squeue);
    script("sbatch", sbatch);
    script("scancel", "");
  }
  void script(const std::string& name, const std::string& text) {
    const std::string file = folder.write("bin/" + name, "#!/bin/bash\n" + text);
    fs::permissions(file, fs::perms::owner_all);
  }
  /// Seven runs; nobody makes them.
  app::output::ProcessResult sweep(const std::string& more = "") {
    return app::output::run_process(
        "/bin/bash",
        {"-c",
         "PATH=\"$PWD/bin:$PATH\" \"$0\" sweep scene.toml -p "
         "material.snow.hardening=1,2,3,4,5,6,7 --frames 0-1 --out out --engine slurm " +
             more,
         NEVE_BINARY},
        folder.path());
  }
};

TEST_F(SlurmSites, ABannerBeforeTheNumberOfAJobIsPassedOver) {
  const auto done = sweep();
  EXPECT_EQ(done.exit_code, app::exit_runs_failed) << "nobody makes them: " << done.errors;
  EXPECT_TRUE(contains(done.errors, "submitted 7 runs as job 4711, 4712, 4713, 4714"))
      << done.errors;
  const std::string calls = read_text(folder / "calls");
  EXPECT_TRUE(contains(calls, "--dependency=afterany:4711:4712:4713")) << calls;
}

TEST_F(SlurmSites, TheJobThatCollectsMakesWhatTheSweepWasAskedFor) {
  sweep("--movie gif --review");
  const std::string collect = read_text(folder / "out/slurm/collect.sh");
  EXPECT_TRUE(contains(collect, " --movie gif") && contains(collect, " --review")) << collect;
}

TEST_F(SlurmSites, RunsThatAreRefusedAreSubmittedLaterAndNoneTwice) {
  folder.write("full", "");
  const auto done = sweep();
  EXPECT_EQ(done.exit_code, app::exit_runs_failed) << done.errors;
  EXPECT_TRUE(contains(done.errors, "QOSMaxSubmitJobPerUserLimit")) << done.errors;
  EXPECT_TRUE(contains(done.errors, "queued: 3 runs as job 4711; 4 more follow")) << done.errors;
  std::istringstream calls(read_text(folder / "calls"));
  std::vector<std::string> offsets;
  for (std::string line; std::getline(calls, line);)
    if (contains(line, "--array")) offsets.push_back(line.substr(line.rfind(' ') + 1));
  EXPECT_EQ(offsets, (std::vector<std::string>{"0", "3", "6"}));
  // The queued job was on disk before the next job was asked for.
  EXPECT_EQ(json_of("seen.json").back()["runs"], app::Json({6}));
}

TEST_F(SlurmSites, JobsOfAnEarlierCallAreNotSubmittedAgain) {
  sweep();
  fs::remove(folder / "calls");
  folder.write("living", "4711 4711\n");
  folder.write("out/slurm/jobs.json",
               R"([{"job": "4711", "runs": [0, 1, 2, 3], "is_beginning": false}])");
  fs::remove(folder / "looks");
  const auto done = sweep();
  EXPECT_TRUE(contains(done.errors, "waiting for the jobs submitted before")) << done.errors;
  EXPECT_TRUE(contains(done.errors, "submitted 3 runs")) << done.errors;
  EXPECT_FALSE(contains(read_text(folder / "calls"), "run.sh 0\n")) << read_text(folder / "calls");
}

TEST_F(SlurmSites, RunsThatNoJobBeganAreToldWithTheLogAndAreNoInterrupt) {
  const auto done = sweep();
  EXPECT_EQ(done.exit_code, app::exit_runs_failed) << done.errors;
  EXPECT_TRUE(contains(done.errors,
                       "runs 0-6: their jobs ended before they began; see out/slurm/4711_0.log, "
                       "or sacct -j 4711_0; the same command submits them again"))
      << done.errors;
  EXPECT_TRUE(contains(done.errors, "0 runs ok, 7 failed")) << done.errors;
  EXPECT_FALSE(contains(done.errors, "interrupted")) << done.errors;
}

TEST_F(SlurmSites, WhatTheUserWaitsForIsWaitedForBesideTheRuns) {
  sweep("--sbatch=--dependency=afterok:77 --sbatch=-d --sbatch=afterok:78");
  std::istringstream calls(read_text(folder / "calls"));
  std::string line;
  while (std::getline(calls, line) && contains(line, "--array")) {
    EXPECT_TRUE(contains(line, " --dependency=afterok:77,afterok:78 ")) << line;
    EXPECT_FALSE(contains(line, " -d ")) << line;
  }
  EXPECT_TRUE(contains(line, " --dependency=afterany:4711:4712:4713,afterok:77,afterok:78 "))
      << "sbatch heeds the last alone: " << line;
}

TEST_F(SlurmSites, AQueueThatFailsToAnswerOnceIsAskedAgain) {
  script("squeue",
         std::string("[ -e failed ] || { touch failed; echo 'cannot contact' >&2; exit 1; }\n") +
             squeue);
  const auto done = sweep();
  EXPECT_EQ(done.exit_code, app::exit_runs_failed) << "it waited for their end: " << done.errors;
  EXPECT_TRUE(contains(done.errors,
                       "squeue failed: cannot contact; the jobs continue, and Slurm is "
                       "asked again for 10 minutes"))
      << done.errors;
}

/// A site that makes what it is given: sbatch keeps jobs, each look at the queue makes one whose
/// dependencies have ended, the youngest first, and says which in the file `order`. A task that
/// ends with 75 is made again. A script before_job can spoil what jobs find.
constexpr const char* sbatch_of_site = R"(mkdir -p jobs
n=$((4711 + $(ls jobs | wc -l))); array=; after=
while [[ $1 == --* ]]; do
  case $1 in --array=*) array=${1#--array=};; --dependency=afterany:*) after=${1#*afterany:};; esac
  shift
done
printf '%s\n' "$array" "$after" "$*" > jobs/$n
echo $n
)";
constexpr const char* squeue_of_site = R"(mkdir -p ended
make_job() {
  [ -e before_job ] && . ./before_job
  tasks=none
  [ -n "$1" ] && tasks=$(for part in ${1//,/ }; do seq ${part%-*} ${part#*-}; done)
  for task in $tasks; do
    code=75; tries=0
    while [ $code = 75 ] && [ $tries -lt 3 ]; do
      SLURM_ARRAY_TASK_ID=$task bash $2 > log 2>&1 < /dev/null; code=$?; tries=$((tries + 1))
      echo "$(basename ${2%% *}) $task $code" >> order
    done
  done
}
for n in $(ls -r jobs); do
  [ -e ended/$n ] && continue
  { read -r array; read -r after; read -r script; } < jobs/$n
  for other in ${after//:/ }; do [ -e ended/$other ] || continue 2; done
  make_job "${array%\%*}" "$script"
  touch ended/$n
  break
done
for n in $(ls jobs); do [ -e ended/$n ] || echo $n $n; done
)";

class SlurmForks : public SlurmSites {
 protected:
  SlurmForks() {
    script("scontrol", "echo 'MaxArraySize = 2'\n");
    script("sbatch", sbatch_of_site);
    script("squeue", squeue_of_site);
  }

  /// Two points of three seeds.
  app::output::ProcessResult forks(const std::string& out, const std::string& more, int seeds = 3) {
    return app::output::run_process(
        "/bin/bash",
        {"-c",
         "PATH=\"$PWD/bin:$PATH\" exec \"$0\" sweep scene.toml -p material.snow.hardening=4,20 "
         "--fork 0.125s --frames 6 --size 96x54 --movie none --out " +
             out + " --seeds " + std::to_string(seeds) + " " + more,
         NEVE_BINARY},
        folder.path());
  }

  /// Two runs that last for minutes.
  app::output::ProcessResult long_runs() {
    return app::output::run_process(
        "/bin/bash",
        {"-c",
         "PATH=\"$PWD/bin:$PATH\" exec \"$0\" sweep scene.toml -p seed=1,2 --set frames=100000 "
         "--out out --movie none --engine slurm",
         NEVE_BINARY},
        folder.path());
  }

  /// "beginning.sh 0 0", a task and its exit code a line.
  std::vector<std::string> tasks_made() {
    std::istringstream lines(read_text(folder / "order"));
    std::vector<std::string> made;
    for (std::string line; std::getline(lines, line);) made.push_back(line);
    return made;
  }
};

TEST_F(SlurmForks, EachSeedHasABeginningOfItsOwnBeforeAnyRun) {
  const auto local = forks("local", "");
  ASSERT_EQ(local.exit_code, 0) << local.errors;
  const auto array = forks("array", "--engine slurm");
  EXPECT_EQ(array.exit_code, 0) << array.errors;
  EXPECT_TRUE(contains(array.errors, "6 runs ok")) << array.errors;
  const std::vector<std::string> made = tasks_made();
  ASSERT_EQ(made.size(), 3u + 6u + 1u) << read_text(folder / "order");
  for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(made[k].starts_with("beginning.sh ")) << made[k];
  EXPECT_TRUE(made.back().starts_with("collect.sh ")) << made.back();
  for (const char* beginning : {"beginning", "beginning_2", "beginning_3"})
    EXPECT_EQ(json_of(std::string("array/") + beginning + "/status.json")["attempts"], 1);
  for (int run = 0; run < 6; ++run) {
    const std::string place = "/runs/000" + std::to_string(run);
    EXPECT_EQ(hashes("array" + place), hashes("local" + place)) << run;
  }
  EXPECT_EQ(read_text(folder / "array/sheet.png"), read_text(folder / "local/sheet.png"));
}

TEST_F(SlurmForks, FurtherSeedsWaitForTheirOwnBeginningsOnly) {
  ASSERT_EQ(forks("array", "--engine slurm").exit_code, 0);
  fs::remove(folder / "order");
  const auto more = forks("array", "--engine slurm", 4);
  EXPECT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_EQ(tasks_made(), (std::vector<std::string>{"beginning.sh 1 0", "run.sh 1 0", "run.sh 1 0",
                                                    "collect.sh none 0"}))
      << "the fourth seed is task 1 of the second array";
}

TEST_F(SlurmForks, RunsOfABeginningThatFailsAreFailedAndTheOthersAreMade) {
  folder.write("before_job", "echo 'no scene' > array/beginning_2/scene.toml\n");
  const auto done = forks("array", "--engine slurm");
  EXPECT_EQ(done.exit_code, app::exit_runs_failed) << done.errors;
  EXPECT_TRUE(contains(done.errors, "4 runs ok, 2 failed")) << done.errors;
  EXPECT_TRUE(contains(read_text(folder / "array/data.csv"),
                       ",failed,\"the common beginning with seed 2 ended as failed: "))
      << read_text(folder / "array/data.csv");
  const auto again = forks("array", "--engine slurm --retry-failed");
  EXPECT_EQ(again.exit_code, app::exit_runs_failed) << again.errors;
  EXPECT_EQ(json_of("array/beginning_2/status.json")["attempts"], 2)
      << "its job tries it again, and not each run once more";
}

TEST_F(SlurmForks, RunsOfAForkWaitForTheirBeginningAndForWhatTheUserNames) {
  script("sbatch", sbatch);
  script("squeue", squeue);
  const auto done = forks("out", "--engine slurm --sbatch=--dependency=afterok:77", 2);
  ASSERT_TRUE(exists("calls")) << done.errors;
  EXPECT_TRUE(contains(read_text(folder / "calls"), " --dependency=afterok:77,afterany:4711 "))
      << read_text(folder / "calls");
}

TEST_F(SlurmForks, ARunWhoseTaskIsKilledHasCrashedAndNamesItsLog) {
  // Task 0 is killed while it makes its run, task 1 before.
  folder.write("before_job", R"(bash() {
  case $* in *collect.sh*) command bash $*; return;; esac
  [ $SLURM_ARRAY_TASK_ID = 1 ] && return 1
  setsid "$BASH" $* & p=$!
  until grep -q '"running"' out/runs/0000/status.json 2>/dev/null; do sleep 0.05; done
  kill -9 -- -$p; wait $p; return 1
}
)");
  const auto done = long_runs();
  EXPECT_EQ(done.exit_code, app::exit_runs_failed) << done.errors;
  EXPECT_TRUE(contains(done.errors, "run 0: its job ended before it was made; see")) << done.errors;
  EXPECT_TRUE(contains(done.errors, "run 1: its job ended before it began; see")) << done.errors;
  const app::Json status = json_of("out/runs/0000/status.json");
  EXPECT_EQ(status["state"], "crashed");
  EXPECT_EQ(status["reason"], "its job ended; see slurm/4711_0.log");
  EXPECT_TRUE(contains(read_text(folder / "out/data.csv"), "crashed"));
  EXPECT_FALSE(contains(read_text(folder / "out/data.csv"), "running"));
}

TEST_F(SlurmForks, AnInterruptedRunWhoseNextJobDoesNotBeginItIsNotInterruptedAgain) {
  folder.write("before_job", R"(bash() {
  case $* in *collect.sh*) command bash $*; return;; esac
  [ -e told$SLURM_ARRAY_TASK_ID ] && return 1
  touch told$SLURM_ARRAY_TASK_ID
  "$BASH" $* & p=$!
  until [ -e out/runs/000$SLURM_ARRAY_TASK_ID/particles/0000.png ]; do sleep 0.05; done
  kill $p; wait $p
}
)");
  EXPECT_EQ(long_runs().exit_code, app::exit_resumable);
  EXPECT_EQ(json_of("out/runs/0001/status.json")["state"], "interrupted");
  const auto again = long_runs();
  EXPECT_EQ(again.exit_code, app::exit_runs_failed) << again.errors;
  EXPECT_TRUE(contains(again.errors, "runs 0-1: their jobs ended before they began"))
      << again.errors;
  EXPECT_EQ(json_of("out/runs/0001/status.json")["state"], "interrupted");
}

TEST_F(SlurmForks, RunsWhoseBeginningIsInterruptedWaitForTheNextTime) {
  folder.write("before_job", R"(bash() {
  case $* in *collect.sh*) command bash $*; return;; esac
  "$BASH" $* & p=$!
  until grep -q '"running"' out/beginning*/status.json 2>/dev/null; do sleep 0.05; done
  kill $p; wait $p; return 1
}
)");
  const auto done = forks("out", "--set solver.max_dt=1e-6 --engine slurm", 2);
  EXPECT_EQ(done.exit_code, app::exit_resumable) << done.errors;
}

TEST_F(SlurmForks, AFirstSubmissionThatRetriesTriesABeginningOnce) {
  folder.write("before_job", "echo 'no scene' > array/beginning_2/scene.toml\n");
  const auto done = forks("array", "--engine slurm --retry-failed");
  EXPECT_EQ(done.exit_code, app::exit_runs_failed) << done.errors;
  EXPECT_EQ(json_of("array/beginning_2/status.json")["attempts"], 1);
  // A run that is asked for by hand is repeated, and its beginning with it, once.
  fs::remove(folder / "before_job");
  const std::vector<std::string> run{"sweep", "run", "array", "--index", "1", "--retry-failed"};
  EXPECT_EQ(neve(run).exit_code, app::exit_runs_failed) << "its scene is still none";
  EXPECT_EQ(json_of("array/beginning_2/status.json")["attempts"], 2);
}

}  // namespace
}  // namespace neve::test
