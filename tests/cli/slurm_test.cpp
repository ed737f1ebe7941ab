/// Slurm sites that print banners and take only some jobs, as scripts in the place of its programs.

#include <sstream>

#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

/// Arrays have at most 3 tasks. Every third look at the queue finds it empty.
constexpr const char* scontrol = "echo 'MaxArraySize = 3'\n";
constexpr const char* squeue =
    "echo look >> looks; [ $(($(wc -l < looks) % 3)) = 0 ] && rm -f living full\n"
    "echo 'Maintenance on Monday'; cat living 2>/dev/null; exit 0\n";
/// While there is a file `full`, one job a time is taken.
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
  app::output::ProcessResult sweep() {
    return app::output::run_process(
        "/bin/bash",
        {"-c",
         "PATH=\"$PWD/bin:$PATH\" \"$0\" sweep scene.toml -p "
         "material.snow.hardening=1,2,3,4,5,6,7 --frames 0-1 --out out --engine slurm",
         NEVE_BINARY},
        folder.path());
  }
};

TEST_F(SlurmSites, ABannerBeforeTheNumberOfAJobIsPassedOver) {
  const auto done = sweep();
  EXPECT_EQ(done.exit_code, 75) << done.errors;  // the jobs end without making their runs
  EXPECT_TRUE(contains(done.errors, "submitted 7 runs as job 4711, 4712, 4713, 4714"))
      << done.errors;
  const std::string calls = read_text(folder / "calls");
  EXPECT_TRUE(contains(calls, "--dependency=afterany:4711:4712:4713")) << calls;
}

TEST_F(SlurmSites, RunsThatAreRefusedAreSubmittedLaterAndNoneTwice) {
  folder.write("full", "");
  const auto done = sweep();
  EXPECT_EQ(done.exit_code, 75) << done.errors;
  EXPECT_TRUE(contains(done.errors, "QOSMaxSubmitJobPerUserLimit")) << done.errors;
  EXPECT_TRUE(contains(done.errors, "queued are 3 runs as job 4711; 4 more follow")) << done.errors;
  std::istringstream calls(read_text(folder / "calls"));
  std::vector<std::string> offsets;
  for (std::string line; std::getline(calls, line);)
    if (contains(line, "--array")) offsets.push_back(line.substr(line.rfind(' ') + 1));
  EXPECT_EQ(offsets, (std::vector<std::string>{"0", "3", "6"}));
  // What was queued was on disk before the next job was asked for.
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

}  // namespace
}  // namespace neve::test
