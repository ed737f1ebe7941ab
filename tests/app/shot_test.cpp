/// Numbers of frames, and the words of a shot.

#include <gtest/gtest.h>

#include "app/options/languages.h"
#include "app/output/sequence.h"
#include "app/scene/burn_in.h"
#include "app/scene/read.h"
#include "app/setup/plan.h"
#include "app/support/errors.h"

namespace neve::test {
namespace {

using app::setup::FrameRange;

app::scene::Scene scene_of(const std::string& head) {
  return app::scene::read_scene_text(
      head + "[[body]]\nshape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }\n", "s.toml");
}

FrameRange frames(const app::scene::Scene& scene, const std::string& text) {
  return app::setup::frames_of(scene, app::options::frames().read("--frames", text));
}

TEST(FrameNumbers, BeginWithTheHandlesOfTheFirstFrame) {
  const auto scene = scene_of("frames = 48\nfirst_frame = 1001\nhandles = 8\n");
  EXPECT_EQ(app::scene::last_frame(scene), 64);
  EXPECT_DOUBLE_EQ(app::scene::duration(scene), 64 / 24.0);
  EXPECT_EQ(app::scene::number_of(scene, 0), 993);
  EXPECT_EQ(app::scene::frame_of(scene, 1001), 8);
  EXPECT_EQ(app::scene::range_text(scene), "1001-1049");
}

TEST(FrameNumbers, AreThoseOfTheFlag) {
  const auto scene = scene_of("frames = 48\nfirst_frame = 1001\n");
  EXPECT_EQ(frames(scene, "1003-1010").first, 2);
  EXPECT_EQ(frames(scene, "1003-1010").last, 9);
  EXPECT_EQ(frames(scene, "1010").first, 0);
  EXPECT_EQ(frames(scene, "1010").last, 9);
  EXPECT_THROW(frames(scene, "0-48"), app::UsageError);
  EXPECT_THROW(frames(scene, "48"), app::UsageError);
}

TEST(FrameNumbers, MayBeNegative) {
  const auto scene = scene_of("frames = 4\nhandles = 8\n");
  EXPECT_EQ(frames(scene, "-8--6").first, 0);
  EXPECT_EQ(frames(scene, "-8--6").last, 2);
  EXPECT_EQ(frames(scene, "-8-3").last, 11);
  const auto language = app::options::frames();
  for (const char* text : {"-8--6", "-8-3", "12", "1-48"})
    EXPECT_EQ(language.write(language.read("--frames", text)), text);
  EXPECT_EQ(app::output::frame_path("out", "v", -8), "out/v/-008.png");
  EXPECT_EQ(app::output::frame_path("out", "v", 1001), "out/v/1001.png");
}

TEST(BurnIn, FillsBracesWithValues) {
  const auto scene = scene_of(R"(
frames = 48
first_frame = 1001
title = "Wall"
[shot]
name = "sh010"
[material.snow]
hardening = 7
[burn_in]
top_left = "{shot.name} {title}"
top = "{frame} {time_code} {range}"
top_right = "xi {material.snow.hardening}"
bottom = "{{{view}}} {changes}"
)");
  const auto words = app::scene::burnt_in(scene, {23, 23 / 24.0, "snow", "hardening = 7"});
  EXPECT_EQ(words[0], "sh010 Wall");
  EXPECT_EQ(words[1], "1024 00:00:42:16 1001-1049");
  EXPECT_EQ(words[2], "xi 7");
  EXPECT_EQ(words[3], "");
  EXPECT_EQ(words[4], "{snow} hardening = 7");
}

TEST(BurnIn, ARunOfASweepHasItsChangesInItsScene) {
  app::scene::Scene scene =
      scene_of("[burn_in]\ntop = \"{{changes}} {view}: {changes}\"\nbottom = \"{{{changes}}}\"\n");
  app::scene::write_changes({"material.snow.hardening=7", "title=a{b}"}, scene);
  const auto words = app::scene::burnt_in(scene, {0, 0, "snow", "nothing else"});
  EXPECT_EQ(words[1], "{changes} snow: hardening = 7");
  EXPECT_EQ(words[4], "{hardening = 7}");
}

TEST(BurnIn, TimesHaveTheDigitsThatTellFramesApart) {
  const auto time = [](const std::string& fps) {
    const auto scene = scene_of("fps = " + fps + "\n[burn_in]\ntop = \"{time}\"\n");
    return app::scene::burnt_in(scene, {3, 3 / scene.fps, "snow", ""})[1];
  };
  EXPECT_EQ(time("24"), "0.125 s");
  EXPECT_EQ(time("1000"), "0.003 s");
  EXPECT_EQ(time("10000"), "0.0003 s");
}

TEST(BurnIn, RefusesABraceWithoutItsEnd) {
  for (const std::string text : {"{frame", "{", "{frame} {{view}} {time"}) {
    try {
      scene_of("[burn_in]\ntop = \"" + text + "\"\n");
      FAIL() << "not refused: " << text;
    } catch (const app::scene::toml::SceneError& error) {
      EXPECT_NE(std::string(error.what()).find("a brace has no end: \"" + text + "\""),
                std::string::npos)
          << error.what();
    }
  }
  const auto scene = scene_of("[burn_in]\ntop = \"a}b {frame}} {{frame}}\"\n");
  EXPECT_EQ(app::scene::burnt_in(scene, {})[1], "a}b 0000} {frame}");
}

TEST(BurnIn, RefusesWhatNamesNothing) {
  try {
    scene_of("[burn_in]\ntop = \"{material.snow.hardning}\"\n");
    FAIL() << "not refused";
  } catch (const app::scene::toml::SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("there is no value {material.snow.hardning}"),
              std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("did you mean material.snow.hardening?"),
              std::string::npos)
        << error.what();
  }
}

TEST(ShotTimeCode, IsCountedFromTheFirstFrame) {
  const auto scene =
      scene_of("first_frame = 1001\nfps = 25\n[shot]\ntime_code = \"10:00:00:00\"\n");
  EXPECT_EQ(app::scene::time_code_of(scene, 1001, 25), "10:00:00:00");
  EXPECT_EQ(app::scene::time_code_of(scene, 1000, 25), "09:59:59:24");
  EXPECT_THROW(scene_of("[shot]\ntime_code = \"10:00:00:24\"\n"), app::scene::toml::SceneError);
}

TEST(ShotTimeCode, IsRequiredOfAMovieAtItsOwnRate) {
  const auto scene = scene_of("fps = 25\n[shot]\ntime_code = \"10:00:00:24\"\n");
  for (const double movie_fps : {0.0, 25.0, 50.0})
    EXPECT_NO_THROW(app::scene::require_time_code(scene, movie_fps)) << movie_fps;
  for (const double movie_fps : {24.0, 12.5}) try {
      app::scene::require_time_code(scene, movie_fps);
      ADD_FAILURE() << movie_fps << " is not refused";
    } catch (const app::UsageError& error) {
      EXPECT_NE(error.message.find("\"10:00:00:24\" is not a time code of"), std::string::npos)
          << error.message;
    }
  EXPECT_NO_THROW(app::scene::require_time_code(scene_of("first_frame = 1001\n"), 12.5));
}

}  // namespace
}  // namespace neve::test
