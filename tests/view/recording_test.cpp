/// Pictures that stay, of `neve view`: what they show, what they say, and what they replace.

#include <algorithm>

#include "app/output/atomic_file.h"
#include "app/record/picture_record.h"
#include "render/image/image.h"
#include "tests/view/by_script.h"

namespace neve::test {
namespace {

/// The tiny scene, for long, with a view that needs the grid.
std::string two_views(int frames) {
  std::string text = tiny_scene;
  text.replace(text.find("frames = 4"), 10, "frames = " + std::to_string(frames));
  return text + "[[view]]\nname = \"cut\"\nlayers = [\"heatmap\", \"arrows\", \"caption\"]\n";
}

constexpr const char* record_on =
    R"({"click": "Save ..."}, {"wait": 3}, {"click": "Record every frame"}, {"wait": 10},
       {"key": "escape"}, {"wait": 3})";

TEST_F(ViewByScript, AnotherViewIsShownWhileTheRunGoes) {
  folder.write("scene.toml", two_views(40));
  const auto result = view(R"([{"wait_for": "simulation frame 3"}, {"key": "2"},
    {"wait_for": "simulation frame 40", "within": 60}, {"wait": 5},
    {"screenshot": "cut.png", "crop": "picture"}])",
                           {"--run"});
  SKIP_WITHOUT_GL(result);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  // The heat map is dark, where particles are bright.
  const render::Image cut = render::decode_png(app::output::read_file(folder / "out/cut.png"));
  std::size_t dark = 0;
  for (std::size_t k = 0; k + 2 < cut.pixels.size(); k += static_cast<std::size_t>(cut.channels))
    dark += std::max({cut.pixels[k], cut.pixels[k + 1], cut.pixels[k + 2]}) < 24 ? 1 : 0;
  EXPECT_GT(dark, 2000u);
}

/// A frame that may go back shows nothing new before its end, and this one is 5 s long: the stress
/// that the second view shows is not computed yet.
TEST_F(ViewByScript, ARangeIsNotFittedToWhatIsNotComputedYet) {
  std::string text = tiny_scene;
  text.replace(text.find("frames = 4"), 10, "frames = 4\nfps = 0.02");
  text.replace(text.find("[solver]"), 8, "[solver]\non_divergence = \"retry\"");
  folder.write("scene.toml", text + R"([[view]]
name = "stress"
layers = ["ground", "colliders", "particles"]
particles = { color_by = "von_mises" }
)");
  const auto result = view(R"([{"click": "View"}, {"wait": 5}, {"click": "Run"},
    {"wait_for": "simulation running"}, {"wait": 5}, {"key": "2"}, {"wait": 3},
    {"click": "Fit the range"}, {"wait": 5}, {"key": "s", "ctrl": true}, {"wait": 3}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_FALSE(contains(read_text(folder / "out/scene.toml"), "range"));
}

TEST_F(ViewByScript, APictureOfAViewChosenAtAFrameHasAllOfIt) {
  folder.write("scene.toml", two_views(4));
  const auto result = view("[{\"wait\": 5}, " + std::string(record_on) + R"(,
    {"key": "2"}, {"wait": 10}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  expect_made_again("out/cut/0000.png");
}

TEST_F(ViewByScript, ARecordingContinuesWithAnotherView) {
  folder.write("scene.toml", two_views(12));
  const auto result =
      view("[" + std::string(record_on) + R"(, {"key": "space"}, {"wait_for": "simulation frame 3"},
    {"key": "2"}, {"wait_for": "simulation frame 12", "within": 60},
    {"wait_for": "simulation paused"}, {"wait": 5}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "particles" / "0000.png"));
  // Pictures are made again from their record, with all that the view shows.
  for (const char* file : {"out/particles/0000.png", "out/cut/0012.png"}) {
    ASSERT_TRUE(std::filesystem::exists(folder / file)) << file;
    expect_made_again(file);
  }
}

TEST_F(ViewByScript, WhatIsTakenBackIsShown) {
  folder.write("scene.toml", two_views(4));
  const auto result = view(R"([{"wait": 5}, {"key": "2"}, {"wait": 10},
    {"screenshot": "before.png", "crop": "picture"},
    {"click": "find a parameter"}, {"type": "view.cut.slice.scalar"}, {"wait": 3},
    {"click": "view.cut.slice.scalar"}, {"wait": 3}, {"click": "density"}, {"wait": 10},
    {"screenshot": "changed.png", "crop": "picture"},
    {"key": "escape"}, {"key": "tab"}, {"wait": 3}, {"key": "tab"}, {"wait": 5},
    {"key": "z", "ctrl": true}, {"wait": 20},
    {"screenshot": "after.png", "crop": "picture"}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto pixels = [&](const char* name) {
    return render::decode_png(app::output::read_file(folder / "out" / name)).pixels;
  };
  EXPECT_NE(pixels("before.png"), pixels("changed.png"));
  EXPECT_EQ(pixels("before.png"), pixels("after.png"));
}

/// The line of a scene that places its camera.
std::string eye_of(const std::string& scene) {
  const auto at = scene.find("eye");
  return at == std::string::npos ? "" : scene.substr(at, scene.find('\n', at) - at);
}

TEST_F(ViewByScript, AFrameIsRecordedAgainWhereTheCameraMovesBeforeTheNext) {
  const auto result = view("[{\"wait\": 5}, " + std::string(record_on) + R"(,
    {"drag": [[600, 300], [760, 330]], "steps": 5}, {"wait": 10},
    {"key": "."}, {"wait_for": "simulation frame 1"}, {"wait_for": "simulation paused"},
    {"wait": 5}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto eye = [&](const char* name) {
    return eye_of(
        app::record::read_picture_record((folder / "out/particles" / name).string()).scene);
  };
  EXPECT_EQ(eye("0000.png"), eye("0001.png"));
  EXPECT_NE(eye("0000.png"), "");
  EXPECT_NE(eye("0000.png"), eye_of(read_text(folder / "scene.toml")));
}

TEST_F(ViewByScript, ARecordingReplacesNoPicturesOfARun) {
  ASSERT_EQ(
      neve({"render", "scene.toml", "--frames", "0-2", "--no-movie", "--out", "out"}).exit_code, 0);
  const std::vector<std::uint8_t> before =
      app::output::read_file(folder / "out/particles/0001.png");
  const auto result = view("[{\"wait\": 5}, " + std::string(record_on) + R"(,
    {"key": "."}, {"wait_for": "simulation frame 1"}, {"wait": 10}])",
                           {"--set", "material.snow.hardening=3"});
  SKIP_WITHOUT_GL(result);
  EXPECT_EQ(result.exit_code, app::exit_io) << result.errors;
  EXPECT_TRUE(contains(result.errors, "is the folder of a run")) << result.errors;
  EXPECT_EQ(app::output::read_file(folder / "out/particles/0001.png"), before);
  EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
}

TEST_F(ViewByScript, ASavedPictureIsTheOneThatItsRecordMakes) {
  folder.write("scene.toml", std::string(tiny_scene) + R"(background = "transparent"
[burn_in]
top_left = "AAA"
)");
  const auto result = view(R"([{"wait": 5}, {"key": "."}, {"wait_for": "simulation frame 1"},
    {"wait_for": "simulation paused"},
    {"click": "find a parameter"}, {"type": "burn_in.top_left"}, {"wait": 3},
    {"click": "burn_in.top_left"}, {"wait": 2}, {"key": "a", "ctrl": true},
    {"type": "BBBBBBBBBB"}, {"key": "enter"}, {"wait": 10}, {"key": "escape"}, {"wait": 3},
    {"key": "p"}, {"wait": 10}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::vector<std::string> saved = files("particles_0001_step", ".png");
  ASSERT_EQ(saved.size(), 1u);
  const std::string file = "out/" + saved[0];
  EXPECT_TRUE(
      contains(app::record::read_picture_record((folder / file).string()).scene, "BBBBBBBBBB"));
  EXPECT_EQ(render::decode_png(app::output::read_file(folder / file)).channels, 4);
  expect_made_again(file);
}

TEST_F(ViewByScript, ASecondPictureOfAFrameIsAnotherFile) {
  const auto result =
      view(R"([{"wait": 5}, {"key": "p"}, {"wait": 10}, {"key": "p"}, {"wait": 10}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(files("particles_0000_step0", ".png"),
            (std::vector<std::string>{"particles_0000_step0_2.png", "particles_0000_step0.png"}));
}

TEST_F(ViewByScript, ASettingThatIsTakenBackAfterAResetIsInNoPicture) {
  const auto result = view(R"([{"wait": 5}, {"click": "find a parameter"},
    {"type": "burn_in.top_left"}, {"wait": 3}, {"click": "burn_in.top_left"}, {"wait": 2},
    {"key": "a", "ctrl": true}, {"type": "BBBBBBBBBB"}, {"key": "enter"}, {"wait": 5},
    {"key": "escape"}, {"key": "tab"}, {"wait": 3}, {"key": "tab"}, {"wait": 5},
    {"key": "r"}, {"wait": 10}, {"key": "z", "ctrl": true}, {"wait": 5},
    {"key": "."}, {"wait_for": "simulation frame 1"}, {"wait_for": "simulation paused"},
    {"key": "p"}, {"wait": 10}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::vector<std::string> saved = files("particles_0001_step", ".png");
  ASSERT_EQ(saved.size(), 1u);
  expect_made_again("out/" + saved[0]);
}

/// Frames of two runs are not mixed, and those of the first stay as they are.
TEST_F(ViewByScript, ARecordingHasAFolderForEachRun) {
  const std::string next = R"(, {"key": "."}, {"wait_for": "simulation frame )";
  const auto result =
      view("[{\"wait\": 5}, " + std::string(record_on) + next + R"(1"}, {"wait": 5})" + next +
           R"(2"}, {"wait": 5})" + next + R"(3"}, {"wait": 5},
    {"key": "left"}, {"wait_for": "simulation frame 2"}, {"wait": 5},
    {"key": "left"}, {"wait_for": "simulation frame 1"}, {"wait": 5},
    {"click": "Continue from here"}, {"wait_for": "label Drop them and continue"},
    {"click": "Drop them and continue"}, {"wait": 5})" +
           next + R"(2"}, {"wait": 5},
    {"key": "r"}, {"wait_for": "simulation frame 0"}, {"wait": 5})" +
           next + R"(1"}, {"wait": 5}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto pictures = [&](const std::string& take) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / take / "particles"))
      count += entry.path().extension() == ".png" ? 1 : 0;
    return count;
  };
  EXPECT_EQ(pictures("out"), 4u);
  EXPECT_EQ(pictures("out/take"), 3u) << "with the frames that both runs have";
  EXPECT_EQ(pictures("out/take_2"), 2u);
  EXPECT_EQ(app::output::read_file(folder / "out/particles/0001.png"),
            app::output::read_file(folder / "out/take/particles/0001.png"));
  expect_made_again("out/take/particles/0002.png");
  expect_made_again("out/take_2/particles/0001.png");
}

/// Another session may be of another run: its frames would lie among those of the first.
TEST_F(ViewByScript, ARecordingReplacesNoFramesOfAnEarlierSession) {
  const auto record = [&](const std::string& next, const char* hardening) {
    return view("[" + std::string(record_on) + next + "]",
                {"--set", std::string("material.snow.hardening=") + hardening});
  };
  const std::string one = R"(, {"key": "."}, {"wait_for": "simulation frame 1"}, {"wait": 5})";
  const auto first =
      record(one + R"(, {"key": "."}, {"wait_for": "simulation frame 2"}, {"wait": 5})", "10");
  SKIP_WITHOUT_GL(first);
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  const std::vector<std::uint8_t> before =
      app::output::read_file(folder / "out/particles/0001.png");
  ASSERT_EQ(record(one, "3").exit_code, 0);
  EXPECT_EQ(app::output::read_file(folder / "out/particles/0001.png"), before);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/take/particles/0001.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/take/particles/0002.png"));
  expect_made_again("out/take/particles/0001.png");
}

/// A picture that is asked for between two frames waits for the next; who pauses before it comes
/// has paused the run for good.
TEST_F(ViewByScript, ARunThatIsPausedBeforeItsPictureStaysPaused) {
  std::string text = tiny_scene;
  text.replace(text.find("frames = 4"), 10, "frames = 6\nfps = 0.2");
  folder.write("scene.toml", text);
  const auto result = view(R"([{"click": "Run"}, {"wait_for": "simulation running"}, {"wait": 3},
    {"key": "p"}, {"wait": 3}, {"click": "Pause"}, {"wait_for": "simulation paused"}, {"wait": 3},
    {"click": "Frame"}, {"wait_for": "simulation frame 1", "within": 60}, {"wait": 20},
    {"wait_for": "simulation paused", "within": 1}, {"wait_for": "simulation frame 1"}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(files("particles_0001_step", ".png").size(), 1u);
}

}  // namespace
}  // namespace neve::test
