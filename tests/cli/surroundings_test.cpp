/// Scenes from standard input, variables of the environment, folders that are no run, quiet
/// answers.

#include <thread>

#include "app/output/folder_lock.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

class Surroundings : public Cli {
 protected:
  app::output::ProcessResult shell(const std::string& line) {
    return app::output::run_process("/bin/bash", {"-c", line, NEVE_BINARY}, folder.path());
  }
};

TEST_F(Surroundings, ASceneIsReadFromStandardInputAndItsFolderHasAName) {
  folder.write("ball.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  folder.write("mesh.toml",
               "[[view]]\nname = \"particles\"\n[[body]]\nshape = { sphere = { center = [0, 2, 0], "
               "radius = 0.1 } }\n"
               "[[collider]]\nshape = { mesh = { file = \"ball.obj\" } }\n");
  EXPECT_EQ(shell("cat scene.toml | \"$0\" render - --frames 0-1 -q --no-movie").exit_code, 0);
  EXPECT_TRUE(exists("out/stdin/run.json"));
  EXPECT_EQ(shell("\"$0\" render <(cat scene.toml) --frames 0-1 -q --no-movie").exit_code, 0);
  EXPECT_TRUE(exists("out/pipe/run.json"));
  EXPECT_EQ(json_of("out/pipe/run.json")["frames"][1]["state_hash"],
            json_of("out/stdin/run.json")["frames"][1]["state_hash"]);
  // Files of such a scene are looked for in the current folder.
  const auto mesh = shell("\"$0\" check - < mesh.toml");
  EXPECT_EQ(mesh.exit_code, 0) << mesh.errors;
  // These commands read it twice.
  EXPECT_EQ(shell("cat scene.toml | \"$0\" render - --fast --dry-run").exit_code, 0);
  const auto sweep = shell("cat scene.toml | \"$0\" sweep - -p seed=1,2 --frames 0-1 -q");
  EXPECT_EQ(sweep.exit_code, 0) << sweep.errors;
  EXPECT_TRUE(exists("out/stdin.cdb/data.csv"));
  const auto wrong = shell("echo frames = x | \"$0\" check -");
  EXPECT_TRUE(contains(wrong.errors, "/dev/stdin:1:10: error: ")) << wrong.errors;
}

TEST_F(Surroundings, MisspeltVariablesAreToldAndThoseOfOthersAreNot) {
  const auto run = [&](const std::string& variables, const std::string& flags = "") {
    return shell(variables + " \"$0\" render scene.toml --dry-run " + flags).errors;
  };
  EXPECT_TRUE(contains(run("NEVE_MAXMEMORY=1GB"), "did you mean NEVE_MAX_MEMORY?"));
  EXPECT_TRUE(contains(run("NEVE_THREADS=4"),
                       "NEVE_THREADS in the environment is not read; use --threads"));
  EXPECT_EQ(run("NEVE_OUT=o NEVE_PROJECT=/x NEVE_REQUIRE_ALL=1 NEVE_USD=/x NEVE_PARAVIEW=/x"), "");
  EXPECT_EQ(app::parse_json(std::string_view(run("NEVE_OUTT=o", "--progress json")))["event"],
            "warning");
}

TEST_F(Surroundings, ManyMoreThreadsThanCoresAreWorthAWarning) {
  const std::string cores = std::to_string(std::thread::hardware_concurrency());
  const auto many = neve({"render", "scene.toml", "--dry-run", "--threads", "1024"});
  EXPECT_EQ(many.exit_code, 0);
  EXPECT_TRUE(contains(many.errors, "--threads 1024: this machine has ")) << many.errors;
  EXPECT_EQ(neve({"render", "scene.toml", "--dry-run", "--threads", cores}).errors, "");
}

TEST_F(Surroundings, QuietChecksSayOnlyWhatIsWrong) {
  EXPECT_EQ(neve({"check", "scene.toml", "--quiet"}).output, "");
  const auto soft =
      neve({"check", "scene.toml", "-q", "--set", "material.snow.youngs_modulus=140"});
  EXPECT_TRUE(soft.output.starts_with("warning: ")) << soft.output;
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "0-1", "--no-movie"}).exit_code, 0);
  EXPECT_EQ(neve({"verify", "out/scene", "-q"}).output, "");
  std::filesystem::remove(folder / "out/scene/particles/0001.png");
  const auto flawed = neve({"verify", "out/scene", "-q"});
  EXPECT_EQ(flawed.exit_code, 9);
  EXPECT_EQ(flawed.output, "out/scene/particles/0001.png is missing\n");
}

TEST_F(Surroundings, InfoOfARunHasItsStepsAndTime) {
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "0-2", "--no-movie"}).exit_code, 0);
  int steps = 0;
  const app::Json run = json_of("out/scene/run.json");
  for (const app::Json& frame : run["frames"]) steps += frame["steps"].get<int>();
  const std::string told = neve({"info", "out/scene"}).output;
  EXPECT_TRUE(contains(told, "steps       " + std::to_string(steps) + "\n")) << told;
  EXPECT_TRUE(contains(told, " s of simulation, ")) << told;
}

TEST_F(Surroundings, ARunThatLostItsRecordIsNoFolderOfSomethingElse) {
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "0-1", "--no-movie"}).exit_code, 0);
  const auto above = neve({"verify", "out"});
  EXPECT_EQ(above.exit_code, 6);
  EXPECT_TRUE(contains(above.errors, "one is out/scene")) << above.errors;
  std::filesystem::remove(folder / "out/scene/run.json");
  const auto lost = neve({"verify", "out/scene"});
  EXPECT_EQ(lost.exit_code, 9);
  EXPECT_TRUE(contains(lost.output, "out/scene/run.json is missing")) << lost.output;
}

TEST_F(Surroundings, UnitsThatAreWrongAreToldBeforeARunToo) {
  const auto soft = neve({"render", "scene.toml", "--frames", "0", "--no-movie", "--set",
                          "material.snow.youngs_modulus=0.14"});
  EXPECT_EQ(soft.exit_code, 0);
  EXPECT_TRUE(contains(soft.errors, "in MPa it would be 1.4e+05 Pa")) << soft.errors;
  const auto large = neve({"check", "scene.toml", "--set", "body.ball.shape.sphere.radius=15"});
  EXPECT_TRUE(contains(large.output, "lengths in metres make it smaller")) << large.output;
  EXPECT_FALSE(contains(large.output, "--coarsen")) << large.output;
}

TEST_F(Surroundings, ALogIsNeverWrittenIntoAScene) {
  const std::string before = read_text(folder.path() / "scene.toml");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"render", "--log", "scene.toml"},
        {"render", "none.toml", "--log=scene.toml"},
        {"sweep", "scene.toml", "-p", "seed=1,2", "--log", "scene.toml"}}) {
    const auto answer = neve(command);
    EXPECT_EQ(answer.exit_code, 2);
    EXPECT_TRUE(contains(answer.errors, "\"scene.toml\" is not a log")) << answer.errors;
  }
  EXPECT_EQ(read_text(folder.path() / "scene.toml"), before);
}

TEST_F(Surroundings, ARunThatAnotherProcessWritesIsNotToBeResumed) {
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "1", "--no-movie"}).exit_code, 0);
  app::Json run = json_of("out/scene/run.json");
  run["status"] = "running";
  folder.write("out/scene/run.json", run.dump());
  const auto left = neve({"verify", "out/scene"});
  EXPECT_TRUE(contains(left.output, "with --resume, to make the rest")) << left.output;
  const app::output::FolderLock lock(folder.path() / "out/scene", "neve render");
  const auto used = neve({"verify", "out/scene"});
  EXPECT_EQ(used.exit_code, 9);
  EXPECT_TRUE(contains(used.output, "in use by neve render, process ")) << used.output;
  EXPECT_FALSE(contains(used.output, "--resume")) << used.output;
}

TEST_F(Surroundings, AFolderThatCannotBeWrittenNamesTheWayToAnother) {
  for (const char* command :
       {"\"$0\" render scene.toml --out /proc/x", "NEVE_OUT=/proc/x \"$0\" render scene.toml",
        "\"$0\" sweep scene.toml -p seed=1,2 --out /proc/x"}) {
    const auto answer = shell(command);
    EXPECT_EQ(answer.exit_code, 6);
    EXPECT_TRUE(contains(answer.errors, "choose another folder with --out or NEVE_OUT"))
        << answer.errors;
  }
}

/// The advice names no option that the command does not have.
TEST_F(Surroundings, AFolderThatCannotBeWrittenNamesTheWayThatTheCommandHas) {
  ASSERT_EQ(shell("\"$0\" render scene.toml --out a --frames 0-1 --no-movie --quiet").exit_code, 0);
  for (const auto& [command, advice] :
       {std::pair{"\"$0\" new /proc/mine", "; choose another folder, as in neve new FOLDER/NAME"},
        std::pair{"\"$0\" manual /proc/x", "; choose another folder, as in neve manual DIR"},
        std::pair{"\"$0\" compare a a --out /proc/x", "; name another place with --out"},
        std::pair{"\"$0\" dump scene.toml --out /proc/x/f.vtp",
                  "; name another file with --out"}}) {
    const auto answer = shell(command);
    EXPECT_EQ(answer.exit_code, 6) << command;
    EXPECT_TRUE(answer.errors.ends_with(std::string(advice) + "\n")) << answer.errors;
  }
  ASSERT_EQ(shell("\"$0\" sweep scene.toml -p seed=1,2 --frames 0-1 --out s.cdb --quiet").exit_code,
            0);
  std::filesystem::remove(folder / "s.cdb/data.csv");
  std::filesystem::create_directory(folder / "s.cdb/data.csv");
  const auto collected = shell("\"$0\" sweep collect s.cdb --quiet");
  EXPECT_EQ(collected.exit_code, 6);
  EXPECT_TRUE(contains(collected.errors,
                       "; move it away, or copy the sweep to a folder that may be written"))
      << collected.errors;
}

TEST_F(Surroundings, AnEmptyNameIsNotTheExample) {
  const auto answer = shell("\"$0\" render \"$UNSET\" --dry-run");
  EXPECT_EQ(answer.exit_code, 2) << answer.output;
  EXPECT_TRUE(contains(answer.errors, "SCENE: is empty; is a variable of the shell not set?"))
      << answer.errors;
  // A word is no file.
  const auto word = shell("\"$0\" params \"$UNSET\"");
  EXPECT_TRUE(contains(word.errors, "WORD: is empty") && !contains(word.errors, "file"))
      << word.errors;
}

TEST_F(Surroundings, PointsThatAreDrawnTwiceAreCounted) {
  folder.write(
      "morris.toml",
      "[sweep]\nscene = \"scene.toml\"\nmethod = \"morris\"\nsamples = 4\nframes = \"0-1\"\n"
      "[axis]\n\"material.snow.hardening\" = [5, 10]\n"
      "\"material.snow.density\" = [300, 400]\n");
  const auto planned = neve({"sweep", "morris.toml", "--dry-run"});
  EXPECT_TRUE(contains(planned.errors,
                       "8 of the 12 points are drawn more than once: 4 runs make all of them"))
      << planned.errors;
}

}  // namespace
}  // namespace neve::test
