/// Commands to paste into a shell.

#include "app/options/arguments.h"

#include <gtest/gtest.h>

#include "app/output/process.h"
#include "app/run/render_options.h"
#include "app/support/text.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

run::RenderOptions awkward() {
  run::RenderOptions options;
  options.scene = "my scenes/snow'ball $HOME.toml";
  options.overrides = {"title=It's « névé » & \"more\"; `ls` \\ $(ls) !x *",
                       "solver.cfl=0.2",
                       "body.ball.velocity=[0, -5, 0]",
                       "title=",
                       "title=a\tb",
                       "camera={ fov = 20 }"};
  options.coarsening = 1.5;
  options.frames = setup::FrameRange{3, 7};
  options.views = {"smoke", "two words"};
  options.size = scene::PictureSize{640, 360};
  options.quality = setup::Quality::draft;
  options.out = "out/~x";
  return options;
}

TEST(CommandLine, CommandLineIsAsShortAsTypedByHand) {
  run::RenderOptions options;
  options.scene = "scenes/snowball_drop.toml";
  EXPECT_EQ(options::shell_line(options::words_of(options)),
            "neve render scenes/snowball_drop.toml");
  options.overrides = {"material.snow.hardening=5"};
  options.frames = setup::FrameRange{0, 12};
  EXPECT_EQ(options::shell_line(options::words_of(options)),
            "neve render scenes/snowball_drop.toml --set material.snow.hardening=5 --frames 0-12");
  options = {};
  options.scene = "-x.toml";
  options.plate = "-1.png";
  EXPECT_EQ(options::shell_line(options::words_of(options)),
            "neve render ./-x.toml --plate=-1.png");
}

/// A shell splits the line into the arguments.
TEST(CommandLine, CommandLineGoesThroughAShellUnharmed) {
  const std::vector<std::string> words = options::words_of(awkward());
  const test::TemporaryFolder folder;
  const output::ProcessResult shell = output::run_process(
      "/bin/sh",
      {"-c", "neve() { for word in \"$@\"; do printf '%s\\0' \"$word\"; done; }; " +
                 options::shell_line(words)},
      folder.path());
  ASSERT_EQ(shell.exit_code, 0) << shell.errors;
  std::string expected;
  for (const std::string& word : words) expected += word + '\0';
  EXPECT_EQ(shell.output, expected);
}

TEST(ShellWord, ShellWordIsQuotedIfNecessary) {
  EXPECT_EQ(shell_word("a/b-c_d.toml"), "a/b-c_d.toml");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("~"), "'~'");
}

}  // namespace
}  // namespace neve::app
