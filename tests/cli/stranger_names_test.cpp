/// Names and texts of strangers are data, whatever is written: TOML, JSON, SVG, tables, shells,
/// terminals.

#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

class StrangerNames : public Cli {
 protected:
  static bool is_clean(const std::string& output) {
    return output.find_first_of("\x1b\x07") == std::string::npos && !contains(output, "\xc2\x9b");
  }
};

TEST_F(StrangerNames, NoTextOfAFileReachesATerminal) {
  const std::string odd = "\x1b]0;owned\x07\xc2\x9b";
  folder.write("sweep.toml",
               "[sweep]\nscene = \"scene.toml\"\nmethod = \"list\"\n[[run]]\nlabel = "
               "\"\\u001b]0;owned\\u0007\\u009b\"\nseed = 1\n[[run]]\nseed = 2\n");
  fs::copy_file(folder / "scene.toml", folder / (odd + ".toml"));
  folder.write("forged/run.json", R"({"status": "\u001b]0;owned\u0007\u009b", "frames": [],
                                      "views": [], "files": {"\u001b]0;x\u009b": "0"}})");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"sweep", "sweep.toml", "--dry-run"},
        {"sweep", "sweep.toml", "--dry-run", "--json"},
        {"check", odd + ".toml"},
        {"check", odd + ".toml", "--json"},
        {"render", odd + ".toml", "--dry-run"},
        {"render", odd + ".toml", "--dry-run", "--json"},
        {"verify", "forged"},
        {"verify", "forged", "--json"},
        {"info", "forged"},
        {"info", "forged", "--json"}}) {
    const auto result = neve(words);
    EXPECT_TRUE(is_clean(result.output)) << words[0] << ": " << result.output;
    EXPECT_TRUE(is_clean(result.errors)) << words[0] << ": " << result.errors;
    if (words.back() == "--json") {
      EXPECT_NO_THROW(app::parse_json(std::string_view(result.output))) << result.output;
    }
  }
  const auto logged =
      neve({"render", odd + ".toml", "--frames", "0", "--out", odd, "--log", "log"});
  EXPECT_EQ(logged.exit_code, 0) << logged.errors;
  EXPECT_TRUE(is_clean(read_text(folder / "log"))) << read_text(folder / "log");
}

TEST_F(StrangerNames, ProjectsInFoldersThatAreNoUtf8AreRefusedAtTheStart) {
  const std::string odd = "caf\xe9";
  folder.write(odd + "/m.obj",
               "v 0 0 0\nv .2 0 0\nv 0 .2 0\nv 0 0 .2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  folder.write(odd + "/m.toml",
               "frames = 0\nsolver.cell_size = 0.02\n[[body]]\nshape = { mesh = { file = "
               "\"m.obj\" } }\n");
  const auto refused = neve({"render", odd + "/m.toml", "--out", "m"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_TRUE(contains(refused.errors, "UTF-8")) << refused.errors;
  fs::copy_file(folder / "scene.toml", folder / (odd + "/plain.toml"));
  EXPECT_EQ(neve({"render", odd + "/plain.toml", "--frames", "0", "--out", "p"}).exit_code, 0)
      << "a scene without files is read anywhere";
}

TEST_F(StrangerNames, DrawingsOfSweepsAreXmlAndTablesAreNoFormulas) {
  folder.write("sweep.toml",
               "[sweep]\nscene = \"scene.toml\"\nmethod = \"list\"\nframes = \"0-2\"\n[[run]]\n"
               "label = \"=1+1\"\nseed = 1\n[[run]]\nlabel = \"a\\u0001\\u001bb\"\nseed = 2\n");
  const auto swept = neve({"sweep", "sweep.toml", "--out", "s", "--movie", "none", "--quiet"});
  ASSERT_EQ(swept.exit_code, 0) << swept.errors;
  const std::string plots = read_text(folder / "s/plots.svg");
  EXPECT_FALSE(plots.empty());
  for (const char c : plots) ASSERT_TRUE(c < 0 || c >= ' ' || c == '\n') << int(c);
  EXPECT_TRUE(contains(read_text(folder / "s/data.csv"), "0,'=1+1',"))
      << read_text(folder / "s/data.csv");
}

TEST_F(StrangerNames, FoldersThatBeginLikeAnOptionHaveCommandsThatWork) {
  const auto swept = neve({"sweep", "scene.toml", "-p", "seed=1,2", "--frames", "0", "--out=-z",
                           "--movie", "none", "--quiet"});
  ASSERT_EQ(swept.exit_code, 0) << swept.errors;
  EXPECT_TRUE(contains(read_text(folder / "-z/report.html"), "neve view ./-z/runs/0000"));
  EXPECT_FALSE(contains(read_text(folder / "-z/report.html"), "neve view -z"));
}

TEST_F(StrangerNames, MessagesSayWhatIsWrong) {
  folder.write("long.json", "[" + std::string((1 << 20) + 9, ' ') + "]");
  const auto replay = neve({"view", "scene.toml", "--replay", "long.json"});
  EXPECT_EQ(replay.exit_code, 3);
  EXPECT_TRUE(contains(replay.errors, "larger than 1 MiB")) << replay.errors;
  folder.write("twice.toml",
               "[sweep]\nscene = \"scene.toml\"\n[axis]\n\"material.snow.hardening\" = [5, 7]\n"
               "\"material.snow.hardening\" = [5, 7]\n");
  const auto twice = neve({"sweep", "twice.toml", "--dry-run"});
  EXPECT_EQ(twice.exit_code, 3);
  EXPECT_TRUE(contains(twice.errors, "error: this key is given twice")) << twice.errors;
}

/// Numbers of a person's file under a name that a format writes itself are lost in it.
TEST_F(StrangerNames, CarriedColumnsShareNoNameWithOneOfAFormat) {
  folder.write("p.csv",
               "x,y,z,time,pscale,nx,a_b,a-b\n0,0.1,0,1,1,1,1,1\n0.05,0.1,0,2,2,2,2,2\n"
               "0,0.15,0,3,3,3,3,3\n0,0.1,0.05,4,4,4,4,4\n");
  folder.write("p.toml",
               "frames = 0\nsolver.cell_size = 0.05\n[[body]]\nshape = { points = { file = "
               "\"p.csv\", spacing = 0.05 } }\n");
  const auto code = [&](const std::string& format, const std::string& columns) {
    return neve({"export", "p.toml", "--format", format, "--attributes", "v," + columns, "--frames",
                 "0", "--quiet"})
        .exit_code;
  };
  EXPECT_EQ(code("npz", "time"), 2);
  EXPECT_EQ(code("bgeo", "pscale"), 2);
  EXPECT_EQ(code("ply", "time"), 0);
  EXPECT_EQ(code("csv", "pscale,nx"), 0) << "a table of particles has no normals";
  EXPECT_EQ(code("usda", "a_b"), 0);
}

TEST_F(StrangerNames, ALineBreakInANameIsNoLine) {
  const std::string odd = "a\nframes = 9\n1";
  fs::copy_file(folder / "scene.toml", folder / (odd + ".toml"));
  folder.write("clicks.txt", "1\n");
  const auto picked =
      neve({"pick", odd + ".toml", "--clicks", "clicks.txt", "-p", "material.snow.hardening=5,20",
            "--frames", "0-1", "--size", "64x36", "--out", "a"});
  EXPECT_EQ(picked.exit_code, 0) << picked.errors;
  EXPECT_FALSE(contains(read_text(folder / "a/clicks.txt"), "\nframes = 9"));
  EXPECT_FALSE(contains(read_text(folder / "a/picked.toml"), "\nframes = 9\n1"));
  folder.write("empty.txt", "# none\n");
  EXPECT_EQ(neve({"pick", "scene.toml", "--clicks", "empty.txt", "-p",
                  "material.snow.hardening=5,20", "--frames", "0-1", "--out", "b"})
                .exit_code,
            2);
}

}  // namespace
}  // namespace neve::test
