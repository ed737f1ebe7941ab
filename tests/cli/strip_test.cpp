/// neve strip: one view at several times in one picture.

#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

constexpr const char* falling = R"(
title = "Fall"
frames = 6
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.2, 0], radius = 0.1 } }
velocity = [0, -1, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[output]
size = [160, 90]
)";

class Strip : public Cli {
 protected:
  Strip() { folder.write("fall.toml", falling); }

  render::Image picture(const std::string& name) const {
    return render::decode_png(app::output::read_file(folder.path() / name));
  }

  void expect_refused(std::vector<std::string> arguments, const std::string& part) {
    arguments.insert(arguments.begin(), "strip");
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
  }
};

TEST_F(Strip, SpreadsMomentsOverTheFramesAndSaysWhich) {
  const auto result = neve({"strip", "fall.toml", "--view", "slice", "--tiles", "4", "--width",
                            "640", "--out", "s.png", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const app::Json json = app::parse_json(std::string_view(result.output));
  ASSERT_EQ(json.at("times").size(), 4u);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(json.at("times")[k].get<double>(), k * 2 / 24.0, 1e-9);
  EXPECT_TRUE(json.at("is_whole").get<bool>());
  EXPECT_EQ(picture("s.png").width, 640);
}

TEST_F(Strip, ARunWithCheckpointsGivesTheSamePictureAsItsScene) {
  ASSERT_EQ(neve({"render", "fall.toml", "--no-movie", "--checkpoint-every", "2", "--out", "run"})
                .exit_code,
            0);
  const std::vector<std::string> more{"--at", "0.1,0.2", "--columns", "2", "--width", "320"};
  const auto strip = [&](std::vector<std::string> arguments, const std::string& out) {
    arguments.insert(arguments.begin(), "strip");
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.insert(arguments.end(), {"--out", out});
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return picture(out);
  };
  const render::Image of_scene = strip({"fall.toml"}, "a.png"), of_run = strip({"run"}, "b.png");
  const render::Difference difference = render::compare(of_scene, of_run);
  EXPECT_EQ(difference.max, 0);
  // A view that the run has not drawn, too.
  EXPECT_EQ(render::compare(strip({"fall.toml", "--view", "slice"}, "c.png"),
                            strip({"run", "--view", "slice"}, "d.png"))
                .max,
            0);
}

/// The camera of a slice was not found anew: anything might be before its plane.
TEST_F(Strip, ARunWithSlicesGivesTheSamePictureAsItsScene) {
  folder.write("slices.toml", std::string(falling) + R"(
[[view]]
name = "snow"
[[view]]
name = "slice"
layers = ["heatmap", "arrows", "legend"]
)");
  ASSERT_EQ(neve({"render", "slices.toml", "--no-movie", "--out", "run"}).exit_code, 0);
  const auto strip = [&](const std::string& source) {
    EXPECT_EQ(neve({"strip", source, "--view", "slice", "--at", "0.05,0.1", "--columns", "2",
                    "--width", "320", "--out", "s.png"})
                  .exit_code,
              0);
    return picture("s.png");
  };
  const render::Image of_scene = strip("slices.toml");
  EXPECT_EQ(render::compare(of_scene, strip("run")).max, 0);
}

TEST_F(Strip, MakesItselfAgain) {
  ASSERT_EQ(neve({"strip", "fall.toml", "--view", "slice", "--at", "0.05,0.1,0.2", "--columns", "2",
                  "--width", "500", "--set", "body.ball.velocity=[0.5,-1,0]", "--out", "a.png"})
                .exit_code,
            0);
  const auto info = neve({"info", "a.png"});
  ASSERT_EQ(info.exit_code, 0) << info.errors;
  EXPECT_NE(info.output.find("3 moments, 0.050 to 0.200 s; neve strip a.png"), std::string::npos)
      << info.output;
  EXPECT_EQ(app::parse_json(std::string_view(neve({"info", "a.png", "--json"}).output))
                .at("strip")
                .at("times")
                .size(),
            3u);
  const auto again = neve({"strip", "a.png", "--out", "b.png"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(render::compare(picture("a.png"), picture("b.png")).max, 0);

  // One picture of it is another thing.
  const auto refused = neve({"render", "a.png"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.errors.find("neve strip a.png"), std::string::npos) << refused.errors;
  const auto last = neve({"render", "a.png", "--frames", "2-2", "--no-movie", "--out", "run"});
  EXPECT_EQ(last.exit_code, 0) << last.errors;
}

/// Moments between frames: the nearest frame is another state.
TEST_F(Strip, ExportsAreOfTheMomentsThatItShows) {
  ASSERT_EQ(neve({"strip", "fall.toml", "--at", "0.05,0.2", "--width", "400", "--out", "a.png"})
                .exit_code,
            0);
  const app::Json info =
      app::parse_json(std::string_view(neve({"info", "a.png", "--json"}).output));
  const auto done = neve({"export", "a.png", "--format", "npz", "--out", "made", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  const app::Json made = app::parse_json(std::string_view(done.output));
  const app::Json& files = made["exports"][0]["files"];
  ASSERT_EQ(files.size(), 2u);
  // The state before the step that contains a time.
  EXPECT_NEAR(files[0]["time"], 0.05, 0.001);
  EXPECT_NEAR(files[1]["time"], 0.2, 0.001);
  EXPECT_EQ(files[1]["state_hash"], info["state_hash"]);
  // No frame has that state.
  EXPECT_FALSE(info.contains("frame"));
  EXPECT_EQ(neve({"info", "a.png"}).output.find("frame       "), std::string::npos);
  // The frames that somebody asks for are frames.
  const auto frame =
      neve({"export", "a.png", "--frames", "5-5", "--format", "npz", "--out", "frame", "--json"});
  ASSERT_EQ(frame.exit_code, 0) << frame.errors;
  EXPECT_EQ(app::parse_json(std::string_view(frame.output))["exports"][0]["files"][0]["number"], 5);
  EXPECT_EQ(frame.errors.find("another state"), std::string::npos) << frame.errors;
}

TEST_F(Strip, TilesShowTheirMoment) {
  ASSERT_EQ(neve({"strip", "fall.toml", "--at", "0,0.2", "--columns", "2", "--width", "640",
                  "--out", "two.png"})
                .exit_code,
            0);
  const render::Image both = picture("two.png");
  ASSERT_EQ(neve({"strip", "fall.toml", "--at", "0,0.02", "--columns", "2", "--width", "640",
                  "--out", "same.png"})
                .exit_code,
            0);
  // The first tile is the same in both, the second one is not.
  EXPECT_GT(render::compare(both, picture("same.png")).local, 8);
}

TEST_F(Strip, RefusesNumbersAndNamesThatItCannotUse) {
  expect_refused({"fall.toml", "--at", "0.1", "--tiles", "3"}, "--at");
  expect_refused({"fall.toml", "--tiles", "0"}, "1 to 200");
  expect_refused({"fall.toml", "--width", "20"}, "160 to 16384");
  expect_refused({"fall.toml", "--out", "folder"}, "ends in .png");
  expect_refused({"fall.toml", "--view", "slcie"}, "slice");
}

/// A fork tells its changes above the tiles: in 40 rows of a picture of 640.
TEST_F(Strip, SaysWhatAForkChanged) {
  ASSERT_EQ(neve({"render", "fall.toml", "--no-movie", "--out", "run"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "run", "--from", "0.1", "--set", "material.snow.hardening=11",
                  "--no-movie", "--out", "fork"})
                .exit_code,
            0);
  const auto words = [&](const char* run, const char* at) {
    EXPECT_EQ(neve({"strip", run, "--at", at, "--width", "640", "--out", "s.png"}).exit_code, 0);
    render::Image image = picture("s.png");
    image.height = 40;
    image.pixels.resize(static_cast<std::size_t>(image.width * image.height * image.channels));
    return image;
  };
  EXPECT_GT(render::compare(words("run", "0.2"), words("fork", "0.2")).max, 100);
  EXPECT_EQ(render::compare(words("run", "0.05"), words("fork", "0.05")).max, 0);
}

/// A picture of the slice says its place at its lower edge: a strip says it above the tiles, or in
/// those where it differs.
TEST_F(Strip, SaysWhereItsSlicesAre) {
  folder.write("slices.toml", (falling + 16) + std::string(R"(
[[view]]
name = "still"
layers = ["heatmap"]
[[view]]
name = "moving"
layers = ["heatmap"]
slice = { motion = [0, 0, 0.4] }
)"));
  const auto strip = [&](const char* view) {
    EXPECT_EQ(neve({"strip", "slices.toml", "--at", "0.05,0.2", "--columns", "1", "--width", "640",
                    "--view", view, "--out", "s.png"})
                  .exit_code,
              0);
    return picture("s.png");
  };
  const render::Image still = strip("still"), moving = strip("moving");
  const auto light_in = [](const render::Image& image, int left, int top) {
    int count = 0;
    for (int y = top; y < top + 16; ++y)
      for (int x = left; x < left + 60; ++x)
        count +=
            image.pixels[static_cast<std::size_t>((y * image.width + x) * image.channels)] > 150;
    return count;
  };
  EXPECT_GT(light_in(still, 80, 20), 4) << "z = 0 m, in the line above the tiles";
  EXPECT_EQ(light_in(still, 10, 430), 0) << "the second tile has the same plane";
  EXPECT_GT(light_in(moving, 10, 430), 10) << "z = 0.08 m";
}

TEST_F(Strip, IsOpaqueAndSaysSo) {
  const auto done = neve({"strip", "fall.toml", "--at", "0.1", "--width", "320", "--out", "s.png",
                          "--set", "output.background=transparent"});
  EXPECT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_EQ(picture("s.png").channels, 3);
  EXPECT_TRUE(contains(done.errors, "output.background: a strip is opaque")) << done.errors;
}

TEST_F(Strip, BurnInsSayWhatWasChanged) {
  const auto drawn = [&](const std::string& more) {
    folder.write("burnt.toml", "title = \"Burnt\"\n" + more + (falling + 16));
    EXPECT_EQ(neve({"strip", "burnt.toml", "--at", "0.1", "--set", "material.snow.hardening=11",
                    "--width", "320", "--out", "s.png"})
                  .exit_code,
              0);
    return picture("s.png");
  };
  EXPECT_GT(render::compare(drawn(""), drawn("burn_in = { bottom = \"{changes}\" }\n")).max, 100);
}

}  // namespace
}  // namespace neve::test
