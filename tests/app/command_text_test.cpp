/// Commands to paste into a shell.

#include <gtest/gtest.h>

#include "app/output/process.h"
#include "app/setup/command_text.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

app::setup::RenderCommand awkward() {
  app::setup::RenderCommand command;
  command.scene_file = "my scenes/snow'ball $HOME.toml";
  for (const char* set :
       {"title=It's « névé » & \"more\"; `ls` \\ $(ls) !x *", "solver.cfl=0.2",
        "body.ball.velocity=[0, -5, 0]", "title=", "title=a\tb", "camera={ fov = 20 }"})
    command.overrides.push_back(app::scene::parse_override(set));
  command.coarsening = 1.5;
  command.frames = app::setup::FrameRange{3, 7};
  command.views = {"smoke", "two words"};
  command.size = app::scene::PictureSize{640, 360};
  command.quality = app::setup::Quality::draft;
  command.out = "out/~x";
  return command;
}

TEST(CommandLine, CommandLineIsAsShortAsTypedByHand) {
  app::setup::RenderCommand command;
  command.scene_file = "scenes/snowball_drop.toml";
  EXPECT_EQ(app::setup::command_line(command), "neve render scenes/snowball_drop.toml");
  command.overrides = {app::scene::parse_override("material.snow.hardening=5")};
  command.frames = app::setup::FrameRange{0, 12};
  EXPECT_EQ(
      app::setup::command_line(command),
      "neve render scenes/snowball_drop.toml --set 'material.snow.hardening=5' --frames 0-12");
  command = {};
  command.scene_file = "-x.toml";
  EXPECT_EQ(app::setup::command_line(command), "neve render ./-x.toml");
}

/// A shell splits the line into the arguments.
TEST(CommandLine, CommandLineGoesThroughAShellUnharmed) {
  const app::setup::RenderCommand command = awkward();
  const test::TemporaryFolder folder;
  const app::output::ProcessResult shell = app::output::run_process(
      "/bin/sh",
      {"-c", "neve() { for word in neve \"$@\"; do printf '%s\\0' \"$word\"; done; }; " +
                 app::setup::command_line(command)},
      folder.path());
  ASSERT_EQ(shell.exit_code, 0) << shell.errors;
  std::string expected;
  for (const std::string& word : app::setup::arguments(command)) expected += word + '\0';
  EXPECT_EQ(shell.output, expected);
}

TEST(ShellWord, ShellWordIsQuotedIfNecessary) {
  EXPECT_EQ(app::setup::shell_word("a/b-c_d.toml"), "a/b-c_d.toml");
  EXPECT_EQ(app::setup::shell_word(""), "''");
  EXPECT_EQ(app::setup::shell_word("a b"), "'a b'");
  EXPECT_EQ(app::setup::shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(app::setup::shell_word("~"), "'~'");
}

}  // namespace
}  // namespace neve::app
