/// neve new and neve schema: a first scene, and JSON Schema that other programs read.

#include <regex>
#include <sstream>

#include "tests/support/faulty_cli.h"
#include "tests/support/needs.h"
#include "tests/support/python.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

class New : public FaultyCli {
 protected:
  /// Every scene and sweep that neve ships.
  static std::vector<std::string> shipped() {
    std::vector<std::string> files;
    for (const char* part : {"scenes", "scenes/sweeps"})
      for (const auto& entry : fs::directory_iterator(fs::path(NEVE_SOURCE_DIR) / part))
        if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
    return files;
  }

  /// One line for each file, from python3-jsonschema.
  std::string verdicts(const fs::path& python, const std::vector<std::string>& files) {
    for (const char* kind : {"scene", "sweep"}) {
      const auto schema = neve({"schema", kind});
      EXPECT_EQ(schema.exit_code, 0) << schema.errors;
      folder.write(kind + std::string(".json"), schema.output);
    }
    std::vector<std::string> arguments{"scene.json", "sweep.json"};
    arguments.insert(arguments.end(), files.begin(), files.end());
    const auto result = run_script(python, "read_schema.py", arguments, folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.output;
  }
};

TEST_F(New, SchemaAcceptsEveryShippedSceneAndSweep) {
  const auto python = python_with("jsonschema");
  if (!python) SKIP_OR_FAIL("no jsonschema in Python; install python3-jsonschema");
  ASSERT_EQ(neve({"new", "first"}).exit_code, 0);
  // Every parameter, written out.
  ASSERT_EQ(
      neve({"render", "first.toml", "--frames", "0", "--coarsen", "3", "--no-movie"}).exit_code, 0);
  folder.write("resolved.toml", json_of("out/first/run.json")["scene"].get<std::string>());
  std::vector<std::string> files = shipped();
  EXPECT_GT(files.size(), 20u);
  for (const char* file : {"first.toml", "resolved.toml", "scene.toml"}) files.emplace_back(file);
  std::string expected;
  for (const std::string& file : files) expected += "ok " + file + "\n";
  EXPECT_EQ(verdicts(*python, files), expected);
}

TEST_F(New, SchemaRefusesWhatNeveRefuses) {
  const auto python = python_with("jsonschema");
  if (!python) SKIP_OR_FAIL("no jsonschema in Python; install python3-jsonschema");
  const std::string ball = "[[body]]\nshape = { sphere = { radius = 0.1 } }\n";
  const std::pair<const char*, std::string> wrong[] = {
      {"solver", "[solver]\ncell_sise = 0.02\n" + ball},
      {"body.0.shape.sphere", "[[body]]\nshape = { sphere = { center = [0, 1, 0] } }\n"},
      {"body.0.shape",
       "[[body]]\nshape = { sphere = { radius = 1 }, box = { size = [1, 1, 1] } }\n"},
      {"body.0.shape", "[[body]]\nshape = { plane = { normal = [0, 1, 0] } }\n"},
      {"body.0", "[[body]]\nvelocity = [0, -1, 0]\n"},
      {"material.snow.poisson_ratio", "[material.snow]\npoisson_ratio = 0.5\n" + ball},
      {"solver.transfer", "[solver]\ntransfer = \"pic\"\n" + ball},
      {"frames", "frames = 2.5\n" + ball},
      {"body.0.velocity", ball + "velocity = [0, 1]\n"},
      {"limits.memory", "[limits]\nmemory = \"lots\"\n" + ball},
      {"body.0.name", ball + "name = \"a b\"\n"},
      {"collider.0.keyframes.0", ball + "[[collider]]\nshape = { sphere = { radius = 1 } }\n"
                                        "keyframes = [{ tame = 1 }]\n"},
      {"view.0.layers.0", ball + "[[view]]\nlayers = [\"surface\"]\n"},
      {"output.size", ball + "[output]\nsize = [100]\n"},
      {"set.solver.cell_size",
       "[sweep]\nscene = \"scene.toml\"\n[set]\n\"solver.cell_size\" = -1\n"
       "[axis]\nfps = [1, 2]\n"},
      {"axis.solver.cell_sise",
       "[sweep]\nscene = \"scene.toml\"\n[axis]\n\"solver.cell_sise\" = [1, 2]\n"},
      {"axis.solver.dt",
       "[sweep]\nscene = \"scene.toml\"\n[axis]\n"
       "\"solver.dt\" = { linspace = [1e-4, 1e-3] }\n"},
      {"sweep.method", "[sweep]\nscene = \"scene.toml\"\nmethod = \"all\"\n[axis]\nfps = [1, 2]\n"},
      {"sweep", "[sweep]\n[axis]\nfps = [1, 2]\n"},
  };
  std::vector<std::string> files;
  for (const auto& [where, text] : wrong) {
    files.push_back("wrong_" + std::to_string(files.size()) + ".toml");
    folder.write(files.back(), text);
    const bool is_sweep = text.starts_with("[sweep]");
    const auto result = neve({is_sweep ? "sweep" : "check", files.back(), "--dry-run"});
    const auto plain = neve({is_sweep ? "sweep" : "check", files.back()});
    EXPECT_EQ((is_sweep ? result : plain).exit_code, 3) << text << plain.errors;
  }
  std::istringstream lines(verdicts(*python, files));
  std::string all = lines.str();
  for (std::size_t k = 0; k < files.size(); ++k)
    EXPECT_TRUE(contains(all, "wrong " + files[k] + ": " + wrong[k].first + ": "))
        << wrong[k].second << all;
}

/// Lines "key = value" have a comment above them, with the unit where there is one.
TEST_F(New, FirstSceneExplainsEveryLineAndRenders) {
  const auto made = neve({"new", "avalanche"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_TRUE(contains(made.output, "neve check avalanche.toml")) << made.output;
  const std::string text = read_text(folder / "avalanche.toml");
  EXPECT_TRUE(text.starts_with("#:schema scene.schema.json\n"));
  EXPECT_TRUE(contains(text, "title = \"avalanche\""));
  EXPECT_TRUE(contains(text, "# Spacing h of the grid. Unit: m; "));
  std::istringstream lines(text);
  std::string line, above;
  int keys = 0;
  for (; std::getline(lines, line); above = line) {
    EXPECT_LE(line.size(), 110u) << line;
    if (!std::regex_search(line, std::regex("^([a-z_]+ = |\\[)")) || line.starts_with("[[body"))
      continue;
    ++keys;
    const bool is_second = line.starts_with("shape = { box");
    EXPECT_TRUE(above.starts_with("# ") || is_second || above.starts_with("[output"))
        << above << "\n"
        << line;
  }
  EXPECT_GT(keys, 20);
  EXPECT_EQ(json_of("scene.schema.json"), app::parse_json(neve({"schema"}).output));
  const auto rendered = neve({"render", "avalanche.toml", "--frames", "2", "--coarsen", "2",
                              "--size", "64x36", "--no-movie"});
  EXPECT_EQ(rendered.exit_code, 0) << rendered.errors;
  EXPECT_FALSE(contains(rendered.errors, "warning")) << rendered.errors;
}

TEST_F(New, NothingIsOverwritten) {
  folder.write("mine.toml", "# mine\n");
  folder.write("scene.schema.json", "{}");
  const auto again = neve({"new", "mine"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_TRUE(contains(again.errors, "mine.toml already exists")) << again.errors;
  EXPECT_EQ(read_text(folder / "mine.toml"), "# mine\n");
  ASSERT_EQ(neve({"new", "other.toml", "--json"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "scene.schema.json"), "{}");
  fs::create_symlink("nowhere.toml", folder / "link.toml");
  EXPECT_EQ(neve({"new", "link"}).exit_code, 2);
  EXPECT_FALSE(exists("nowhere.toml"));
  const auto nowhere = neve({"new", "missing/scene"});
  EXPECT_EQ(nowhere.exit_code, 6);
  EXPECT_TRUE(contains(nowhere.errors, "mkdir -p missing")) << nowhere.errors;
  for (const char* bad : {"a b", "", "..", "x\ny", "dir/"})
    EXPECT_EQ(neve({"new", bad}).exit_code, 2);
  const auto schema = neve({"schema", "scenes"});
  EXPECT_EQ(schema.exit_code, 2);
  EXPECT_TRUE(contains(schema.errors, "did you mean scene?")) << schema.errors;
}

/// The schema is written before the scene: without the scene the same command makes the rest.
TEST_F(New, OneThatFailsAnywhereIsRepeatedByTheSameCommand) {
  ASSERT_EQ(neve({"new", "fresh"}).exit_code, 0);
  const std::string scene = read_text(folder / "fresh.toml"),
                    schema = read_text(folder / "scene.schema.json");
  int failed = 0;
  for (const char* operation : {"open", "write", "short", "fsync", "rename", "close", "truncate"})
    for (int skip = 0; skip < 12; ++skip) {
      fs::remove(folder / "fresh.toml");
      fs::remove(folder / "scene.schema.json");
      const std::string place = std::string(operation) + " " + std::to_string(skip);
      const auto result =
          failing(std::string(operation) + ":28:/:" + std::to_string(skip) + ":1", "new fresh");
      failed += result.exit_code != 0;
      EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 6) << place << result.errors;
      if (result.exit_code == 0 || exists("fresh.toml")) {
        EXPECT_EQ(read_text(folder / "fresh.toml"), scene) << place;
      } else {
        EXPECT_EQ(neve({"new", "fresh"}).exit_code, 0) << place;
      }
      EXPECT_EQ(read_text(folder / "scene.schema.json"), schema) << place;
    }
  EXPECT_GT(failed, 5);
}

TEST_F(New, OneThatIsInterruptedLeavesWholeFiles) {
  ASSERT_EQ(neve({"new", "whole"}).exit_code, 0);
  const std::string schema = read_text(folder / "scene.schema.json");
  for (int k = 0; k < 20; ++k) {
    fs::remove(folder / "fresh.toml");
    fs::remove(folder / "scene.schema.json");
    app::output::run_process("/bin/bash",
                             {"-c",
                              "timeout -s INT 0.0" + std::string(k < 10 ? "0" : "") +
                                  std::to_string(k) + " \"$0\" new fresh",
                              NEVE_BINARY},
                             folder.path());
    if (exists("scene.schema.json")) {
      EXPECT_EQ(read_text(folder / "scene.schema.json"), schema) << k;
    }
    if (!exists("fresh.toml")) {
      EXPECT_EQ(neve({"new", "fresh"}).exit_code, 0) << k;
    }
    EXPECT_TRUE(read_text(folder / "fresh.toml").starts_with("#:schema")) << k;
    for (const auto& entry : fs::directory_iterator(folder.path()))
      EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path() << k;
  }
}

}  // namespace
}  // namespace neve::test
