/// The same sweep through a real Slurm and on this machine alone.

#include <algorithm>

#include "tests/cli/run_neve.h"
#include "tests/support/cinema.h"
#include "tests/support/needs.h"
#include "tests/support/slurm.h"

namespace neve::test {
namespace {

/// Seven runs, more than the site's arrays take; one explodes, one cannot start.
const std::string sweep_text = std::string(R"(
[sweep]
scene = "scene.toml"
frames = "0-2"
method = "list"
[sheet]
tile = [160, 90]
[[run]]
seed = 1
[[run]]
seed = 2
[[run]]
seed = 3
)") + exploding_run + R"([[run]]
label = "refused"
"limits.particles" = 10
[[run]]
seed = 4
[[run]]
seed = 5
)";

/// The table without the columns that differ from one time to the next.
std::string without_times(const std::string& csv) {
  const std::vector<CsvRow> rows = parse_csv(csv);
  std::string text;
  for (const CsvRow& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      if (rows[0][c] != "seconds") text += row[c] + (c + 1 < row.size() ? "," : "\n");
  return text;
}

TEST_F(Cli, SlurmMakesTheSameTableAsThisMachine) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can start Slurm's daemons";
  if (const std::string missing = Slurm::missing(); !missing.empty()) SKIP_OR_FAIL(missing);
  const Slurm slurm;
  if (!slurm.is_up()) SKIP_OR_FAIL("Slurm is installed and does not start");
  folder.write("study.toml", sweep_text);
  const auto local = neve({"sweep", "study.toml", "--out", "local"});
  EXPECT_EQ(local.exit_code, 7) << local.errors;
  const auto array = neve({"sweep", "study.toml", "--out", "array", "--engine", "slurm"});
  EXPECT_EQ(array.exit_code, 7) << array.errors;
  EXPECT_TRUE(contains(array.errors, "submitted 7 runs as job ") && contains(array.errors, ", "))
      << "one array would be over the limit: " << array.errors;
  EXPECT_EQ(without_times(read_text(folder / "array/data.csv")),
            without_times(read_text(folder / "local/data.csv")));
  EXPECT_EQ(read_text(folder / "array/sheet.png"), read_text(folder / "local/sheet.png"));
  // The collector was a job of its own.
  EXPECT_TRUE(exists("array/slurm/collect.log"));
  // Nothing is missing: nothing is submitted.
  const auto again = neve({"sweep", "study.toml", "--out", "array", "--engine", "slurm", "--json"});
  EXPECT_EQ(app::parse_json(std::string_view(again.output))["started"], 0);
}

TEST_F(Cli, CancelledSlurmSweepsContinue) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can start Slurm's daemons";
  if (const std::string missing = Slurm::missing(); !missing.empty()) SKIP_OR_FAIL(missing);
  const Slurm slurm;
  if (!slurm.is_up()) SKIP_OR_FAIL("Slurm is installed and does not start");
  folder.write("long.toml",
               "[sweep]\nscene = \"scene.toml\"\n[axis]\n\"solver.max_dt\" = [1e-6, 1.1e-6]\n");
  const std::string script =
      "\"$0\" sweep long.toml --engine slurm --out array & pid=$!\n"
      "for i in $(seq 600); do [ -e array/runs/0000/particles/0000.png ] && break; sleep 0.1; "
      "done\n"
      "kill -INT $pid; wait $pid; echo code $?\n"
      "for i in $(seq 100); do [ -z \"$(squeue -h)\" ] && break; sleep 0.2; done; squeue -h\n";
  const auto result =
      app::output::run_process("/bin/bash", {"-c", script, NEVE_BINARY}, folder.path());
  EXPECT_EQ(result.output, "code 75\n") << result.errors;
  EXPECT_EQ(json_of("array/runs/0000/status.json")["state"], "interrupted");
  EXPECT_TRUE(exists("array/runs/0000/checkpoint"));
}

TEST_F(Cli, ForkedRunsOnSlurmWaitForTheirBeginning) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can start Slurm's daemons";
  if (const std::string missing = Slurm::missing(); !missing.empty()) SKIP_OR_FAIL(missing);
  const Slurm slurm;
  if (!slurm.is_up()) SKIP_OR_FAIL("Slurm is installed and does not start");
  const auto sweep = [&](const char* out, const std::vector<std::string>& more) {
    std::vector<std::string> words{"sweep",   "scene.toml", "-p",    "material.snow.hardening=4,10",
                                   "--fork",  "0.1s",       "--out", out,
                                   "--seeds", "2"};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = neve(words);
    EXPECT_EQ(done.exit_code, 0) << done.errors;
  };
  sweep("local", {});
  sweep("array", {"--engine", "slurm"});
  for (const char* made : {"beginning", "beginning_2"})
    EXPECT_EQ(json_of(std::string("array/") + made + "/status.json")["attempts"], 1);
  EXPECT_EQ(without_times(read_text(folder / "array/data.csv")),
            without_times(read_text(folder / "local/data.csv")));
}

/// The first block of a language on the page of farms.
std::string block_of_farms(const std::string& language) {
  const std::string page = read_text(NEVE_SOURCE_DIR "/docs/farms.md"),
                    start = "```" + language + "\n";
  const std::size_t from = page.find(start) + start.size();
  return page.substr(from, page.find("```", from) - from);
}

TEST_F(Cli, TheScriptOfThePageOfFarmsRunsAndResumes) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can start Slurm's daemons";
  if (const std::string missing = Slurm::missing(); !missing.empty()) SKIP_OR_FAIL(missing);
  const Slurm slurm;
  if (!slurm.is_up()) SKIP_OR_FAIL("Slurm is installed and does not start");
  const std::string script = block_of_farms("bash");
  ASSERT_TRUE(contains(script, "srun neve render scene.toml"));
  folder.write("job.sh", script);
  std::filesystem::create_directories(folder / "bin");
  std::filesystem::create_symlink(NEVE_BINARY, folder / "bin/neve");
  const auto submit = [&] {
    return app::output::run_process(
        "/bin/bash",
        {"-c",
         "PATH=\"$PWD/bin:$PATH\" sbatch --wait job.sh; code=$?; cat slurm-*.out >&2; "
         "exit $code"},
        folder.path());
  };
  const auto first = submit();
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_EQ(json_of("snow/run.json")["frames"].size(), 5u);
  EXPECT_TRUE(exists("snow.log"));
  const std::string picture = read_text(folder / "snow/particles/0003.png");
  std::filesystem::remove(folder / "snow/particles/0003.png");
  const auto again = submit();
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(read_text(folder / "snow/particles/0003.png"), picture);
}

}  // namespace
}  // namespace neve::test
