/// A standard output that takes nothing: said by every command that prints, once its work is done.

#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

class Streams : public Cli {
 protected:
  /// @param redirection  of the shell, after the command
  int code_of(const std::string& arguments, const std::string& redirection) {
    for (const char* made : {"x", "x.png", "x.toml", "x.json", "scene.schema.json"})
      std::filesystem::remove_all(folder / made);
    const auto result = app::output::run_process(
        "/bin/bash",
        {"-c", "set -o pipefail; \"$0\" " + arguments + " 2>said " + redirection, NEVE_BINARY},
        folder.path());
    return result.exit_code;
  }
};

TEST_F(Streams, EveryCommandThatPrintsSaysThatItCannot) {
  folder.write("quit.json", R"([{"quit": true}])");
  ASSERT_EQ(
      neve({"render", "scene.toml", "--out", "run", "--frames", "0-1", "--no-movie"}).exit_code, 0);
  ASSERT_EQ(
      neve({"sweep", "scene.toml", "-p", "seed=1,2", "--frames", "0", "--out", "made"}).exit_code,
      0);
  for (const std::string& command :
       {std::string("--help"),
        std::string("--version"),
        std::string("version"),
        std::string("help"),
        std::string("help render --json"),
        std::string("params"),
        std::string("params --json"),
        std::string("schema"),
        std::string("info run"),
        std::string("info run/particles/0000.png"),
        std::string("verify run"),
        std::string("verify made"),
        std::string("compare run run"),
        std::string("doctor"),
        std::string("compare run/particles/0000.png run/particles/0000.png"),
        std::string("render scene.toml --dry-run"),
        std::string("check scene.toml"),
        std::string("render scene.toml --frames 0 --no-movie --json --out x"),
        std::string("render run --view snow --frames 0 --no-movie --json --out x"),
        std::string("sweep scene.toml -p seed=1,2 --dry-run"),
        std::string("sweep scene.toml -p seed=1 --frames 0 --json --out x"),
        std::string("sweep promote made 0 --out x.toml"),
        std::string("strip scene.toml --tiles 1 --frames 0 --json --out x.png"),
        std::string("dump scene.toml"),
        std::string("export scene.toml --frames 0 --format csv --json --out x"),
        std::string("new x --json"),
        std::string("view scene.toml --replay quit.json --json "
                    "--size 320x200 --out x")}) {
    for (const char* nowhere : {">/dev/full", ">&-"}) {
      EXPECT_EQ(code_of(command, nowhere), 6) << command << nowhere << read_text(folder / "said");
      EXPECT_TRUE(contains(read_text(folder / "said"), "cannot write to standard output"))
          << command << nowhere;
    }
    // Whoever closes a pipe has read enough.
    EXPECT_EQ(code_of(command, "| true"), 0) << command << read_text(folder / "said");
  }
  EXPECT_EQ(code_of("params --json", "| head -1"), 0);
  EXPECT_EQ(neve({"verify", "made"}).exit_code, 0);
}

}  // namespace
}  // namespace neve::test
