/// The screen of `neve pick`, worked by scripts.

#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "render/image/image.h"
#include "tests/support/needs.h"
#include "tests/support/pick_cli.h"

namespace neve::test {
namespace {

class PickByScript : public PickSearch {
 protected:
  render::Image picture(const std::string& file) {
    return render::decode_png(app::output::read_file(folder / file));
  }
};

#define SKIP_PICK_WITHOUT_GL(result) \
  if (result.exit_code == app::exit_no_backend) SKIP_OR_FAIL(result.errors)

/// Clicks on tiles, and keys: of two, and a finger's two.
TEST_F(PickByScript, ClicksAndKeysGiveThePickOfAListToTheBit) {
  const auto result = replay(R"([
    {"wait_for": "label Round 1 of 8"}, {"click": "tile 3"},
    {"wait_for": "label Round 2 of 8"}, {"click": "tile 2", "shift": true}, {"click": "tile 7"},
    {"wait_for": "label Round 3 of 8"}, {"click": "Two are equal"}, {"click": "tile 9"},
    {"key": "4"}, {"wait_for": "label Round 4 of 8"}, {"key": "0"},
    {"wait_for": "label Round 5 of 8"}, {"click": "Stop and write the pick"},
    {"wait_for": "label Picked"}, {"wait": 3}, {"screenshot": "end.png"}, {"click": "Done"}])",
                             "a");
  SKIP_PICK_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(answers("a"), "3\n2 7\n9 4\n0\n");
  EXPECT_TRUE(contains(result.output, "picked after 4 rounds")) << result.output;
  ASSERT_EQ(by_list("3\n2 7\n9 4\n0\n", "b").exit_code, 0);
  expect_same_pick("a", "b");
}

TEST_F(PickByScript, AnAnswerIsTakenBackWhileTheNextRoundIsMade) {
  const auto result = replay(R"([
    {"wait_for": "label Round 1 of 8"}, {"click": "tile 3"},
    {"wait_for": "label making Round 2 of 8"}, {"click": "Take back"},
    {"wait_for": "label Round 1 of 8"}, {"key": "5"},
    {"wait_for": "label Round 2 of 8"}, {"key": "u"}, {"wait_for": "label making Round 1 of 8"},
    {"wait_for": "label Round 1 of 8"}, {"key": "6"},
    {"wait_for": "label Round 2 of 8"}, {"key": "q"}, {"wait_for": "label Picked"}, {"key": "q"}])",
                             "a");
  SKIP_PICK_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(answers("a"), "6\n");
}

/// Other rounds may be answered before their sheet is made, the last one has it.
TEST_F(PickByScript, TheLastRoundHasItsSheetAndItsFilm) {
  const auto result = replay(R"([
    {"wait_for": "label Round 1 of 2"}, {"click": "tile 3"},
    {"wait_for": "label Round 2 of 2"}, {"click": "tile 4"}, {"wait_for": "label Picked"},
    {"key": "q"}])",
                             "a", {"--rounds", "2"});
  SKIP_PICK_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto time = [&](const char* file) {
    return std::filesystem::last_write_time(folder / (std::string("a/") + file));
  };
  EXPECT_GT(time("sheet.png"), time("round_2.toml"));
  EXPECT_GT(time("report.html"), time("round_2.toml"));
}

/// A closed window writes what there is; the same command continues from there.
TEST_F(PickByScript, AClosedScreenLosesNothing) {
  const auto closed = replay(R"([
    {"wait_for": "label Round 1 of 2"}, {"key": "4"},
    {"wait_for": "label making Round 2 of 2"}, {"quit": true}])",
                             "a", {"--rounds", "2"});
  SKIP_PICK_WITHOUT_GL(closed);
  ASSERT_EQ(closed.exit_code, 0) << closed.errors;
  EXPECT_TRUE(contains(closed.output, "picked after 1 round:")) << closed.output;
  const auto more = replay(R"([
    {"wait_for": "label Round 2 of 2"}, {"key": "1"}, {"wait_for": "label Picked"},
    {"wait": 3}, {"click": "Done"}])",
                           "a", {"--rounds", "2"});
  ASSERT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_EQ(answers("a"), "4\n1\n");
  folder.write("list.txt", "4\n1\n");
  ASSERT_EQ(neve(words("b", {"--clicks", "list.txt", "--rounds", "2"})).exit_code, 0);
  expect_same_pick("a", "b");
}

/// The runs whose tiles were chosen from may not have ended yet when something follows the click.
TEST_F(PickByScript, TheLastAnswerCountsThoughOneStopsAtOnce) {
  const auto stopped = replay(R"([
    {"wait_for": "label Round 1 of 2"}, {"click": "tile 3"}, {"key": "q"},
    {"wait_for": "label The pick"}, {"wait": 3}])",
                              "a", {"--rounds", "2"});
  SKIP_PICK_WITHOUT_GL(stopped);
  ASSERT_EQ(stopped.exit_code, 0) << stopped.errors;
  EXPECT_EQ(answers("a"), "3\n");
  EXPECT_TRUE(contains(stopped.output, "picked after 1 round:")) << stopped.output;
  EXPECT_TRUE(contains(read_text(folder / "a/clicks.txt"), ", frames 2,"))
      << read_text(folder / "a/clicks.txt");
  const auto closed = replay(R"([
    {"wait_for": "label Round 1 of 2"}, {"click": "tile 3"}, {"quit": true}])",
                             "b", {"--rounds", "2"});
  ASSERT_EQ(closed.exit_code, 0) << closed.errors;
  EXPECT_EQ(answers("b"), "3\n");
  EXPECT_TRUE(contains(closed.output, "picked after 1 round:")) << closed.output;
}

/// Everything can be tapped on a phone, and a tile is shown large by a finger that rests.
TEST_F(PickByScript, APhoneHeldUprightHasEverything) {
  const auto result = replay(R"([
    {"resize": [390, 844]}, {"wait_for": "label Round 1 of 8"}, {"wait": 3},
    {"screenshot": "phone.png"}, {"click": "tile 6", "button": "right"},
    {"wait_for": "label closer"}, {"wait": 3}, {"screenshot": "large.png"},
    {"click": "All nine"}, {"wait_for": "label tile 1"},
    {"click": "Two are equal"}, {"click": "tile 1"}, {"click": "tile 9"},
    {"wait_for": "label Round 2 of 8"}, {"wait_for": "label map"}, {"click": "None of them"},
    {"wait_for": "label Round 3 of 8"}, {"click": "Take back"},
    {"wait_for": "label Round 2 of 8"}, {"click": "Stop and write the pick"},
    {"wait_for": "label Picked"}, {"wait": 3}, {"screenshot": "end.png"}, {"click": "Done"}])",
                             "a");
  SKIP_PICK_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(answers("a"), "1 9\n");
  const render::Image nine = picture("a/phone.png"), one = picture("a/large.png");
  ASSERT_EQ(nine.pixels.size(), one.pixels.size());
  std::size_t changed = 0;
  for (std::size_t k = 0; k < nine.pixels.size(); ++k) changed += nine.pixels[k] != one.pixels[k];
  EXPECT_GT(changed, 10000u);
}

/// The pointed tile has its values below the tiles, and a frame.
TEST_F(PickByScript, ThePointedTileShowsItsValues) {
  const auto result = replay(R"([
    {"wait_for": "label Round 1 of 8"}, {"move": [5, 5]}, {"wait": 3},
    {"screenshot": "none.png", "crop": "values"}, {"move": "tile 5"}, {"wait": 3},
    {"screenshot": "five.png", "crop": "values"}, {"key": "q"}, {"wait": 5}, {"key": "q"}])",
                             "a");
  SKIP_PICK_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(result.errors, "nothing was chosen; the same command continues"));
  EXPECT_NE(picture("a/none.png").pixels, picture("a/five.png").pixels);
}

/// Snow as stiff as ice under steps far too long: no run gets to its end.
TEST_F(PickByScript, ARoundWhoseRunsAllFailIsToldAndAnotherIsMade) {
  folder.write("scene.toml", exploding_scene);
  folder.write("script.json", R"([
    {"wait_for": "label Round 1 of 8"}, {"wait": 3}, {"screenshot": "failed.png"},
    {"click": "tile 3"}, {"wait": 5}, {"wait_for": "label Round 1 of 8"},
    {"click": "None of them"}, {"wait_for": "label Round 2 of 8"}, {"key": "q"}, {"wait": 5},
    {"key": "q"}])");
  const auto result = neve({"pick", "scene.toml", "--out", "a", "--size", "64x36", "--replay",
                            "script.json", "-p", "material.snow.youngs_modulus=4e7,9e7"});
  SKIP_PICK_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(answers("a"), "0\n");
}

TEST_F(PickByScript, WithoutADisplayAWindowIsRefused) {
  const auto result = app::output::run_process(
      "/bin/bash",
      {"-c",
       "unset DISPLAY WAYLAND_DISPLAY; exec \"$0\" pick scene.toml --window "
       "-p material.snow.hardening=2,20",
       NEVE_BINARY},
      folder.path());
  EXPECT_EQ(result.exit_code, app::exit_no_backend) << result.errors;
  EXPECT_TRUE(contains(result.errors, "window")) << result.errors;
  EXPECT_EQ(neve(words("a", {"--window", "--web"})).exit_code, 2);
  EXPECT_EQ(neve(words("a", {"--terminal", "--web"})).exit_code, 2);
  EXPECT_EQ(neve(words("a", {"--listen", "127.0.0.1:99999"})).exit_code, 2);
}

}  // namespace
}  // namespace neve::test
