/// Every exit code that can be reached, with a message that helps.

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "sim/kernels/simd.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

using Arguments = std::vector<std::string>;

TEST_F(Cli, NoArgumentsPrintHelpAndFail) {
  const auto result = neve({});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.errors, "render"));
  EXPECT_EQ(neve({"--help"}).exit_code, 0);
  EXPECT_EQ(neve({"help"}).exit_code, 0);
  EXPECT_EQ(neve({"render", "--help"}).exit_code, 0);
  EXPECT_TRUE(contains(neve({"--version"}).output, "neve "));
  EXPECT_TRUE(contains(neve({"version"}).output, "neve "));
}

TEST_F(Cli, UsageErrorsSuggestTheNearestName) {
  const auto subcommand = neve({"rendr"});
  EXPECT_EQ(subcommand.exit_code, 2);
  EXPECT_TRUE(contains(subcommand.errors, "did you mean render?")) << subcommand.errors;
  const auto flag = neve({"render", "scene.toml", "--frame", "3"});
  EXPECT_EQ(flag.exit_code, 2);
  EXPECT_TRUE(contains(flag.errors, "did you mean --frames?")) << flag.errors;
}

TEST_F(Cli, OptionsOfOtherProgramsAreKnown) {
  const auto hint = [&](const Arguments& arguments) { return neve(arguments).errors; };
  EXPECT_TRUE(contains(hint({"render", "scene.toml", "-o", "out"}), "did you mean --out?"));
  EXPECT_TRUE(contains(hint({"render", "scene.toml", "--output=out"}), "did you mean --out?"));
  EXPECT_TRUE(contains(hint({"render", "scene.toml", "-j4"}), "did you mean --threads?"));
  EXPECT_TRUE(contains(hint({"sweep", "scene.toml", "-j", "4"}), "did you mean --jobs?"));
  EXPECT_TRUE(contains(hint({"render", "scene.toml", "--check"}), "did you mean --checkpoint-ev"));
  const std::string number = hint({"render", "scene.toml", "--threads", "x"});
  EXPECT_TRUE(contains(number, "--threads: cannot use \"x\"; expected a whole number")) << number;
  EXPECT_TRUE(contains(hint({"compare", "a.png"}), "see neve compare --help"));
  EXPECT_TRUE(contains(hint({"render", "scene.toml", "--fast=no"}), "--fast: takes no value"));
}

TEST_F(Cli, HelpIsThatOfTheCommand) {
  const auto render = neve({"help", "render"});
  EXPECT_EQ(render.exit_code, 0) << render.errors;
  EXPECT_EQ(render.output, neve({"render", "--help"}).output);
  EXPECT_TRUE(contains(neve({"help", "sweep", "run"}).output, "--index"));
  const auto wrong = neve({"help", "rendr"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(contains(wrong.errors, "did you mean render?")) << wrong.errors;
}

TEST_F(Cli, ParamsAreFoundByAPartOfTheirAddress) {
  const auto found = neve({"params", "camera.fov", "--json"});
  ASSERT_EQ(found.exit_code, 0) << found.errors;
  for (const app::Json& info : app::parse_json(std::string_view(found.output)))
    EXPECT_TRUE(contains(info["address"].get<std::string>(), "camera.fov"));
  const auto none = neve({"params", "hardning"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_TRUE(contains(none.errors, "did you mean hardening?")) << none.errors;
}

TEST_F(Cli, ParamsAreFoundByTheirUnit) {
  const auto found = neve({"params", "Pa"});
  EXPECT_EQ(found.exit_code, 0) << found.errors;
  EXPECT_TRUE(contains(found.output, "material.NAME.youngs_modulus")) << found.output;
  EXPECT_FALSE(contains(found.output, "solver.cell_size")) << found.output;
  EXPECT_EQ(neve({"params", "kg"}).exit_code, 0);
}

TEST_F(Cli, AFlagWithOneDashIsNamedWhole) {
  // -q is a flag, and -s is none.
  for (const std::string flag : {"-size", "-quality"}) {
    const auto refused = neve({"render", "scene.toml", flag, "64x64"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(contains(refused.errors, "unknown option " + flag + "; did you mean -" + flag))
        << refused.errors;
  }
  EXPECT_TRUE(contains(neve({"render", "scene.toml", "-qx"}).errors, "unknown option -x"));
  // A frame before the first of the shot.
  folder.write("-001.png", "");
  const auto file = neve({"info", "-001.png"});
  EXPECT_TRUE(contains(file.errors, "the file of this name is ./-001.png")) << file.errors;
}

TEST_F(Cli, NamesOfSubcommandsAreArgumentsOfOthers) {
  const auto params = neve({"params", "view"});
  EXPECT_EQ(params.exit_code, 0) << params.errors;
  EXPECT_TRUE(contains(params.output, "view.NAME.size")) << params.output;
  EXPECT_FALSE(contains(params.output, "solver.")) << params.output;
  const auto render = neve({"render", "scene", "view"});
  EXPECT_EQ(render.exit_code, 2);
  EXPECT_TRUE(contains(render.errors, "unexpected argument \"view\"")) << render.errors;
  const auto sweep = neve({"sweep", "run", "list.toml", "--index", "0", "params"});
  EXPECT_EQ(sweep.exit_code, 2);
  EXPECT_TRUE(contains(sweep.errors, "unexpected argument \"params\"")) << sweep.errors;
}

TEST_F(Cli, AScenesFileIsFoundByItsName) {
  EXPECT_EQ(neve({"render", "scene", "--dry-run"}).exit_code, 0);
  const auto wrong = neve({"render", "scnee.toml"});
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_TRUE(contains(wrong.errors, "did you mean scene.toml?")) << wrong.errors;
}

/// neve dump ... | head
TEST_F(Cli, OutputMayBeCutByHead) {
  for (const std::string arguments : {"params", "dump scene.toml --quiet"}) {
    const auto result = app::output::run_process(
        "/bin/bash",
        {"-c", "set -o pipefail; (sleep 0.2; " NEVE_BINARY " " + arguments + ") | true"},
        folder.path());
    EXPECT_EQ(result.exit_code, 0) << arguments;
    EXPECT_EQ(result.errors, "") << arguments;
  }
}

TEST_F(Cli, ComparedFilesHaveToBeThere) {
  const auto result = neve({"compare", "scene.toml", "nofolder"});
  EXPECT_EQ(result.exit_code, 6);
  EXPECT_TRUE(contains(result.errors, "nofolder: error: does not exist")) << result.errors;
}

TEST_F(Cli, UsageErrorsExitWithTwo) {
  for (const Arguments& arguments :
       std::vector<Arguments>{{"render", "scene.toml", "extra"},
                              {"render", "scene.toml", "--frames", "5-2"},
                              {"render", "scene.toml", "--frames", ""},
                              {"render", "scene.toml", "--out", ""},
                              {"render", "scene.toml", "--shader-dir", "nowhere"},
                              {"render", "scene.toml", "--size", "12"},
                              {"render", "scene.toml", "--threads", "many"},
                              {"render", "scene.toml", "--threads", "-1"},
                              {"render", "scene.toml", "--backend", "vulkan"},
                              {"render", "scene.toml", "--quality", "best"},
                              {"render", "scene.toml", "--coarsen", "0"},
                              {"render", "scene.toml", "--coarsen", "-2"},
                              {"render", "scene.toml", "--coarsen", "nan"},
                              {"render", "scene.toml", "--coarsen", "inf"},
                              {"render", "scene.toml", "--coarsen", ""},
                              {"render", "scene.toml", "--coarsen", "1e300"},
                              {"render", "scene.toml", "--coarsen", "half"},
                              {"render", "scene.toml", "--view", "nothing"},
                              {"render", "scene.toml", "--set", "material.snow.hardening"},
                              {"render", "scene.toml", "--set", "material.snow.hardness=3"},
                              {"render", "scene.toml", "--quiet", "--verbose"},
                              {"compare", "scene.toml"},
                              {"info"}}) {
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments.back() << ": " << result.errors;
    EXPECT_TRUE(result.errors.starts_with("neve: error: ")) << result.errors;
  }
}

TEST_F(Cli, UnknownInstructionSetsExitWithTwo) {
  const char* before = std::getenv("NEVE_SIMD");
  const std::string saved = before ? before : "";
  const std::string here = sim::kernels::name(sim::kernels::chosen_simd_level());
  ::setenv("NEVE_SIMD", "foo", 1);
  const auto result = neve({"render", "scene.toml"});
  const auto as_json = neve({"render", "scene.toml", "--json"});
  ::setenv("NEVE_SIMD", here.c_str(), 1);
  const auto known = neve({"render", "scene.toml", "--frames", "0", "--quiet"});
  if (before)
    ::setenv("NEVE_SIMD", saved.c_str(), 1);
  else
    ::unsetenv("NEVE_SIMD");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.errors, "neve: error: NEVE_SIMD=foo ")) << result.errors;
  EXPECT_TRUE(contains(result.errors, here)) << result.errors;
  EXPECT_EQ(as_json.exit_code, 2);
  EXPECT_EQ(app::parse_json(std::string_view(as_json.output))["where"], "NEVE_SIMD");
  EXPECT_EQ(known.exit_code, 0) << known.errors;
}

TEST_F(Cli, BrokenScenesExitWithThreeAndAPlace) {
  folder.write("bad.toml", "frames = 4\n[[body]]\nshap = 1\n");
  const auto result = neve({"render", "bad.toml"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.errors, "bad.toml:3:1: error: ")) << result.errors;
}

TEST_F(Cli, FilesThatAreNoPicturesOfOursExitWithThree) {
  folder.write("garbage.png", "\x89PNG\r\n\x1a\n" + std::string(100, 'x'));
  folder.write("text.png", "hello");
  folder.write("empty.png", "");
  for (const char* file : {"garbage.png", "text.png", "empty.png"}) {
    EXPECT_EQ(neve({"info", file}).exit_code, 3) << file;
    EXPECT_EQ(neve({"render", file}).exit_code, 3) << file;
    EXPECT_EQ(neve({"compare", file, file}).exit_code, 3) << file;
  }
}

TEST_F(Cli, ErrorsAreJsonToo) {
  folder.write("bad.toml", "frames = 4\n[[body]]\nshap = 1\n");
  const auto result = neve({"render", "bad.toml", "--json"});
  EXPECT_EQ(result.exit_code, 3);
  const app::Json json = app::parse_json(std::string_view(result.output));
  EXPECT_TRUE(contains(json["where"].get<std::string>(), "bad.toml:3:1"));
  EXPECT_TRUE(json.contains("error") && json.contains("hint"));
}

/// A second document after the first is no JSON.
TEST_F(Cli, AnAnswerAndTheErrorAfterItAreOneDocument) {
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "a", "--frames", "0", "--no-movie"}).exit_code,
            0);
  const auto compared =
      neve({"render", "scene.toml", "--out", "b", "--frames", "0", "--no-movie", "--json", "--set",
            "light.intensity=0.1", "--reference", "a/particles/0000.png"});
  EXPECT_EQ(compared.exit_code, 9) << compared.errors;
  const app::Json answer = app::parse_json(std::string_view(compared.output));
  EXPECT_EQ(answer["exit_code"], 9);
  EXPECT_EQ(answer["frames"], 1);
  EXPECT_TRUE(contains(answer["error"], "the picture differs from a/particles/0000.png")) << answer;
  const auto planned =
      neve({"render", "scene.toml", "--dry-run", "--json", "--set", "limits.particles=10"});
  EXPECT_EQ(planned.exit_code, 8);
  EXPECT_EQ(app::parse_json(std::string_view(planned.output))["exit_code"], 8);
}

TEST_F(Cli, NoBackendExitsWithFour) {
  ::unsetenv("DISPLAY");
  ::unsetenv("WAYLAND_DISPLAY");
  const auto result = neve({"render", "scene.toml", "--backend", "window"});
  EXPECT_EQ(result.exit_code, 4) << result.errors;
  EXPECT_TRUE(contains(result.errors, "window")) << result.errors;
  EXPECT_FALSE(exists("out")) << "an earlier run must survive this";
}

TEST_F(Cli, DivergenceExitsWithFiveAndAReport) {
  folder.write("explode.toml", exploding_scene);
  const auto result = neve({"render", "explode.toml"});
  ASSERT_EQ(result.exit_code, 5) << result.errors;
  EXPECT_TRUE(contains(result.errors, "diverged at step")) << result.errors;
  EXPECT_TRUE(exists("out/explode/diverged_particles.png"));
  const app::Json incident = json_of("out/explode/incident.json");
  EXPECT_TRUE(incident.contains("rule") && incident.contains("dt_that_holds"));
  EXPECT_EQ(incident["cause"], "time_step") << incident["sentence"];
  EXPECT_TRUE(contains(result.errors, "Cause: ")) << result.errors;
  EXPECT_TRUE(contains(result.errors, "solver.dt = ")) << result.errors;
  EXPECT_FALSE(incident["last_steps"].empty());
  EXPECT_TRUE(exists("out/explode/diverged_culprit_slice.png"));
  const app::Json run = json_of("out/explode/run.json");
  EXPECT_EQ(run["status"], "diverged");
  EXPECT_EQ(run["divergence"]["cause"], incident["cause"]);
  for (const app::Json& frame : run["frames"])
    EXPECT_LT(frame["time"].get<double>(), incident["time"].get<double>());
}

TEST_F(Cli, ARunMayGoBackAndTryHalfTheStep) {
  const std::vector<std::string> changes = {
      "--set", "solver.time_step=fixed",     "--set", "solver.dt=2.4e-3",
      "--set", "material.snow.hardening=30", "--set", "body.ball.velocity=[0,-4,0]"};
  std::vector<std::string> arguments = {"render", "scene.toml"};
  arguments.insert(arguments.end(), changes.begin(), changes.end());
  ASSERT_EQ(neve(arguments).exit_code, 5);
  arguments.insert(arguments.end(), {"--replace", "--set", "solver.on_divergence=retry"});
  const auto result = neve(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(result.errors, "with dt times 0.5")) << result.errors;
  const app::Json run = json_of("out/scene/run.json");
  EXPECT_EQ(run["status"], "ok");
  ASSERT_FALSE(run["retries"].empty());
  EXPECT_EQ(run["retries"][0]["dt_scale"], 0.5);
  // One of a later frame is of the run, too, whatever is drawn of the earlier ones.
  app::Json longer = run;
  longer["retries"].push_back(longer["retries"].back());
  folder.write("out/scene/run.json", longer.dump());
  const auto again = neve({"render", "out/scene", "--view", "smoke", "--frames", "0-1"});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(json_of("out/scene/run.json")["retries"], longer["retries"]);
  // The files of the diverged run are gone.
  EXPECT_FALSE(exists("out/scene/incident.json"));
  EXPECT_FALSE(exists("out/scene/diverged_culprit_slice.png"));
}

TEST_F(Cli, OutputThatCannotBeWrittenExitsWithSix) {
  folder.write("file", "x");
  const auto result = neve({"render", "scene.toml", "--out", "file/under"});
  EXPECT_EQ(result.exit_code, 6);
  EXPECT_TRUE(contains(result.errors, "file/under")) << result.errors;
  EXPECT_EQ(neve({"info", "missing.png"}).exit_code, 6);
  EXPECT_EQ(neve({"render", "scene.toml", "--reference", "missing.png"}).exit_code, 6);
}

TEST_F(Cli, AFullDiskExitsWithSixAndLeavesNoHalfPicture) {
  const std::string limited = "ulimit -f 2; exec \"$0\" render scene.toml --quiet";
  const auto shell = app::output::find_program("bash");
  ASSERT_TRUE(shell);
  const auto result = app::output::run_process(*shell, {"-c", limited, NEVE_BINARY}, folder.path());
  EXPECT_EQ(result.exit_code, 6) << result.errors;
  EXPECT_TRUE(contains(result.errors, "bytes")) << result.errors;
  EXPECT_FALSE(exists("out/scene/particles/0000.png"));
}

TEST_F(Cli, LimitsAreRefusedWithEightBeforeAnythingIsMade) {
  for (const char* change : {"limits.particles=10", "limits.memory=\"1MiB\"", "limits.pixels=100",
                             "output.size=[100000,100000]"}) {
    const auto result = neve({"render", "scene.toml", "--set", change});
    EXPECT_EQ(result.exit_code, 8) << change << ": " << result.errors;
    EXPECT_TRUE(contains(result.errors, "raise it with --set limits.")) << result.errors;
    EXPECT_FALSE(exists("out"));
  }
  // No limit could be raised that far.
  const auto absurd = neve({"render", "scene.toml", "--set", "solver.cell_size=1e-6"});
  EXPECT_EQ(absurd.exit_code, 8);
  EXPECT_TRUE(contains(absurd.errors, "; solver.cell_size = 0.001 keeps it")) << absurd.errors;
  EXPECT_FALSE(contains(absurd.errors, "raise it")) << absurd.errors;
  EXPECT_EQ(neve({"render", "scene.toml", "--size", "100000x100000"}).exit_code, 8);
  EXPECT_EQ(neve({"render", "scene.toml", "--size", "100000x100000", "--dry-run"}).exit_code, 8);
}

TEST_F(Cli, TooLittleAddressSpaceIsRefusedBeforeADriverCrashes) {
  const auto result = app::output::run_process(
      "/bin/sh", {"-c", "ulimit -v 400000; exec '" NEVE_BINARY "' render scene.toml"},
      folder.path());
  EXPECT_EQ(result.exit_code, 8) << result.errors;
  EXPECT_TRUE(contains(result.errors, "ulimit -v")) << result.errors;
}

TEST_F(Cli, ChecksThatFailExitWithNine) {
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "a"}).exit_code, 0);
  ASSERT_EQ(
      neve({"render", "scene.toml", "--out", "b", "--set", "body.ball.velocity=[1,0,0]"}).exit_code,
      0);
  EXPECT_EQ(neve({"compare", "a/particles/0000.png", "a/particles/0004.png"}).exit_code, 9);
  EXPECT_EQ(neve({"compare", "a/particles/0000.png", "a/particles/0000.png"}).exit_code, 0);
  EXPECT_EQ(neve({"compare", "a", "b"}).exit_code, 9);
  EXPECT_EQ(neve({"compare", "a", "a/particles/0000.png"}).exit_code, 2);
  const auto pictures = neve({"compare", "a/particles/", "b/particles"});
  EXPECT_EQ(pictures.exit_code, 2);
  EXPECT_TRUE(contains(pictures.errors, "a/particles/ is not the folder of a run"))
      << pictures.errors;
  EXPECT_TRUE(contains(pictures.errors, "a is one; neve compare takes")) << pictures.errors;
  const auto result = neve({"render", "scene.toml", "--reference", "a/particles/0000.png"});
  EXPECT_EQ(result.exit_code, 9);
  EXPECT_TRUE(exists("out/scene/difference.png")) << result.errors;
  EXPECT_TRUE(exists("out/scene/particles/0004.png"));
}

// Snow that is somewhere else: a small part of the picture, and all of some 8x8 pixels.
TEST_F(Cli, AReferenceIsHeldToTheWorstPartOfThePicture) {
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "a", "--frames", "0"}).exit_code, 0);
  const auto compared = [&](const std::string& mean, const std::string& local) {
    std::vector<std::string> arguments{
        "render", "scene.toml", "--reference",  "a/particles/0000.png", "--reference-threshold",
        mean,     "--out",      "again" + local};
    if (!local.empty()) {
      arguments.push_back("--reference-local-threshold");
      arguments.push_back(local);
    }
    return neve(arguments);
  };
  const auto elsewhere = compared("255", "");
  EXPECT_EQ(elsewhere.exit_code, 9);
  EXPECT_TRUE(contains(elsewhere.errors, "of 8x8 pixels ")) << elsewhere.errors;
  EXPECT_EQ(compared("255", "255").exit_code, 0);
  EXPECT_EQ(compared("255", "-1").exit_code, 2);
}

}  // namespace
}  // namespace neve::test
