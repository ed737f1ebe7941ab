/// neve where cmake --install puts it: anywhere, with man pages and completions.

#include <regex>
#include <sstream>

#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

class Install : public Cli {};

TEST_F(Install, InstalledProgramFindsItsFilesWhereverItIsMoved) {
  const auto cmake = app::output::find_program("cmake");
  if (!cmake) SKIP_OR_FAIL("no cmake in PATH; install cmake");
  const std::filesystem::path build = std::filesystem::path(NEVE_BINARY).parent_path();
  const auto installed = app::output::run_process(
      *cmake, {"--install", build.string(), "--prefix", (folder / "first").string()},
      folder.path());
  ASSERT_EQ(installed.exit_code, 0) << installed.errors;
  std::filesystem::rename(folder / "first", folder / "moved");
  for (const char* file :
       {"bin/neve", "share/neve/scenes/snowball_drop.toml", "share/neve/python/neve.py",
        "share/doc/neve/README.md", "share/doc/neve/docs/scenes.md", "share/doc/neve/copyright",
        "share/man/man1/neve-render.1.gz", "share/man/man1/neve.1.gz",
        "share/man/man1/neve-bench-sim.1.gz", "share/bash-completion/completions/neve",
        "share/zsh/vendor-completions/_neve", "share/fish/vendor_completions.d/neve.fish",
        "share/neve/schema/scene.schema.json", "share/neve/schema/sweep.schema.json"})
    EXPECT_TRUE(exists(std::string("moved/") + file)) << file;
  const auto check = app::output::run_process(folder / "moved/bin/neve",
                                              {"check", "--coarsen", "3"}, folder.path());
  EXPECT_EQ(check.exit_code, 0) << check.errors;
  EXPECT_TRUE(contains(check.output, (folder / "moved").string())) << check.output;
}

/// neve help --json lists them.
TEST_F(Install, HelpManPagesAndCompletionsHaveEveryOption) {
  ASSERT_EQ(neve({"manual", "m"}).exit_code, 0);
  const std::string bash = read_text(folder / "m/bash/neve"),
                    zsh = read_text(folder / "m/zsh/_neve"),
                    fish = read_text(folder / "m/fish/neve.fish");
  int options = 0;
  for (const app::Json& command :
       app::parse_json(std::string_view(neve({"help", "--json"}).output))) {
    const std::string name = command["command"];
    std::vector<std::string> words{"help"};
    std::istringstream in(name);
    for (std::string word; in >> word;)
      if (word != "neve") words.push_back(word);
    const std::string help = neve(words).output;
    const std::string file = "m/man1/" + std::regex_replace(name, std::regex(" "), "-") + ".1";
    const std::string page = std::regex_replace(read_text(folder / file), std::regex("\\\\-"), "-");
    for (const app::Json& option : command["options"]) {
      const std::string flag = option["name"], place = name + " " + flag;
      ++options;
      EXPECT_TRUE(contains(help, flag)) << place;
      EXPECT_TRUE(contains(help, option["help"].get<std::string>())) << place;
      EXPECT_TRUE(contains(page, flag + "\\fR")) << place;
      // A value after "=" alone is written so.
      EXPECT_EQ(contains(page, flag + "\\fR[="), contains(help, flag + "[=")) << place;
      if (option["is_argument"] == true || words.size() != 2) continue;
      EXPECT_TRUE(contains(bash, flag)) << place;
      EXPECT_TRUE(contains(zsh, flag + "[")) << place;
      EXPECT_TRUE(contains(fish, " -l " + flag.substr(2) + " ")) << place;
    }
  }
  EXPECT_GT(options, 300);
  EXPECT_EQ(neve({"help", "sweep", "run", "--json"}).exit_code, 0);
}

TEST_F(Install, BashCompletesCommandsFlagsAndFiles) {
  ASSERT_EQ(neve({"manual", "m"}).exit_code, 0);
  const auto completed = [&](const std::string& words, int index) {
    return app::output::run_process("/bin/bash",
                                    {"-c", "source m/bash/neve; COMP_WORDS=(" + words +
                                               "); COMP_CWORD=" + std::to_string(index) +
                                               "; _neve; echo ${COMPREPLY[@]}"},
                                    folder.path())
        .output;
  };
  EXPECT_EQ(completed("neve ren", 1), "render\n");
  EXPECT_EQ(completed("neve export --att", 2), "--attributes\n");
  EXPECT_EQ(completed("neve check sce", 2), "scene.toml\n");
  EXPECT_EQ(completed("neve --vers", 1), "--version\n");
  EXPECT_EQ(completed("neve help ren", 2), "render\n");
  // A value is no flag, and a part has its own.
  EXPECT_EQ(completed("neve render scene.toml --view ''", 4), "m scene.toml\n");
  EXPECT_EQ(completed("neve sweep run --ind", 3), "--index\n");
  EXPECT_EQ(completed("neve sweep --ind", 2), "\n");
  // A folder of the same name does not make it one: no slash follows.
  std::filesystem::create_directory(folder / "sim");
  EXPECT_FALSE(contains(read_text(folder / "m/bash/neve"), "complete -o filenames"));
  EXPECT_EQ(completed("neve bench si", 2), "sim sim\n");
  EXPECT_EQ(neve({"manual"}).exit_code, 2);
  folder.write("file", "");
  EXPECT_EQ(neve({"manual", "file"}).exit_code, 6);
}

}  // namespace
}  // namespace neve::test
