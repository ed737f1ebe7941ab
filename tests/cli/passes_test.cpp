/// neve render --passes: pictures with channels beside the PNGs.

#include "app/output/atomic_file.h"
#include "render/image/exr.h"
#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"
#include "tests/support/python.h"

namespace neve::test {
namespace {

/// A ball that nothing pulls at.
constexpr const char* flying_scene = R"(
frames = 3
[solver]
cell_size = 0.04
gravity = [0, 0, 0]
[[view]]
name = "particles"
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.3, 0], radius = 0.12 } }
velocity = [1.5, 0.5, -0.4]
[[collider]]
name = "post"
shape = { box = { center = [0.5, 0.2, -0.3], size = [0.1, 0.4, 0.1] } }
[camera]
eye = [0.2, 0.6, 1.6]
target = [0.2, 0.3, 0]
[output]
size = [160, 90]
)";

class Passes : public Cli {
 protected:
  Passes() { folder.write("flying.toml", flying_scene); }

  void render(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"--no-movie", "--quiet"});
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
  }
  render::ExrPicture picture(const std::string& file) {
    return render::decode_exr(app::output::read_file(folder / file));
  }
};

TEST_F(Passes, AnotherReaderFindsTheBallWhereItIsAndWhereItGoes) {
  const auto python = python_with("numpy");
  if (!python) SKIP_OR_FAIL("no Python with numpy; install python3-numpy");
  render({"flying.toml", "--passes", "all,v,speed", "--out", "all"});
  const auto checked =
      run_script(*python, "check_passes.py", {"all/particles/0002.exr", "1.5", "0.5", "-0.4", "24"},
                 folder.path());
  EXPECT_EQ(checked.output, "same\n") << checked.errors;
}

TEST_F(Passes, AFileHasTheChannelsThatAreAskedFor) {
  render({"flying.toml", "--passes", "depth,F_E,pressure", "--frames", "1-1", "--out", "some"});
  std::vector<std::string> names;
  for (const render::ExrChannel& channel : picture("some/particles/0001.exr").channels)
    names.push_back(channel.name);
  EXPECT_EQ(names, (std::vector<std::string>{"A", "B", "F_E.xx", "F_E.xy", "F_E.xz", "F_E.yx",
                                             "F_E.yy", "F_E.yz", "F_E.zx", "F_E.zy", "F_E.zz", "G",
                                             "R", "depth.Z", "pressure.Y"}));
}

/// A holdout is a surface like any other to passes and to the shutter, though it is not seen.
TEST_F(Passes, HoldoutsAreAmongTheSurfaces) {
  folder.write("holdout.toml",
               std::string(flying_scene) +
                   "[[collider]]\nname = \"hand\"\nstyle = \"holdout\"\nvelocity = [2, 0, 0]\n"
                   "shape = { sphere = { center = [0, 0.3, 0.4], radius = 0.05 } }\n"
                   "[[collider]]\nname = \"table\"\nstyle = \"holdout\"\n"
                   "shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }\n");
  render({"holdout.toml", "--passes", "all", "--quality", "final", "--frames", "1-1", "--out",
          "held"});
  const render::ExrPicture drawn = picture("held/particles/0001.exr");
  EXPECT_EQ(drawn.width, 160);
}

TEST_F(Passes, UnknownNamesAreRefusedWithAProposal) {
  const auto result = neve({"render", "flying.toml", "--passes", "depth,normals"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.errors, "unknown pass \"normals\"")) << result.errors;
  EXPECT_TRUE(contains(result.errors, "did you mean normal?")) << result.errors;
  const auto empty = neve({"render", "flying.toml", "--passes", ""});
  EXPECT_EQ(empty.exit_code, 2);
  EXPECT_TRUE(contains(empty.errors, "expected all")) << empty.errors;
}

TEST_F(Passes, AMosaicHasNoneAndSaysSo) {
  folder.write("both.toml", std::string(flying_scene) +
                                "[[view]]\nname = \"snow\"\n"
                                "[[mosaic]]\nname = \"both\"\nviews = [\"particles\", \"snow\"]\n");
  for (const auto& [flag, value] :
       {std::pair{"--passes", "depth"}, std::pair{"--plate", "plate.png"}}) {
    const auto refused = neve({"render", "both.toml", "--view", "both", flag, value});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(contains(refused.errors, std::string(flag) + ": cannot be used with a mosaic"))
        << refused.errors;
  }
  // Its views have them, and a mosaic that was drawn beside them makes itself again.
  render({"both.toml", "--passes", "depth", "--frames", "2-2", "--out", "all"});
  EXPECT_EQ(picture("all/snow/0002.exr").channels.size(), 5u);
  render({"all/both/0002.png", "--out", "again"});
  EXPECT_TRUE(std::filesystem::exists(folder / "again/both/0002.png"));
}

TEST_F(Passes, MosaicsHaveMotionBlur) {
  folder.write("one.toml",
               std::string(flying_scene) + "[[mosaic]]\nname = \"one\"\nviews = [\"particles\"]\n");
  const auto drawn = [&](const std::string& shutter) {
    render(
        {"one.toml", "--view", "one", "--frames", "2-2", "--shutter", shutter, "--out", shutter});
    return render::decode_png(app::output::read_file(folder / (shutter + "/one/0002.png")));
  };
  const render::Image sharp = drawn("0"), blurred = drawn("360");
  EXPECT_GT(render::compare(sharp, blurred).local, 8);
}

TEST_F(Passes, AnExrMakesItselfAgain) {
  render({"flying.toml", "--passes", "normal,id", "--frames", "2-2", "--out", "first"});
  render({"first/particles/0002.exr", "--out", "again"});
  EXPECT_EQ(json_of("first/run.json")["frames"][0]["state_hash"],
            json_of("again/run.json")["frames"][0]["state_hash"]);
  const render::ExrPicture first = picture("first/particles/0002.exr"),
                           again = picture("again/particles/0002.exr");
  ASSERT_EQ(first.channels.size(), again.channels.size());
  for (std::size_t c = 0; c < first.channels.size(); ++c)
    EXPECT_EQ(first.channels[c].numbers, again.channels[c].numbers) << first.channels[c].name;
  const auto info = neve({"info", "first/particles/0002.exr"});
  EXPECT_TRUE(contains(info.output, "passes      normal, id\n")) << info.output;
}

TEST_F(Passes, DamagedFilesAreFoundAndMadeAgain) {
  render({"flying.toml", "--passes", "depth", "--out", "run", "--checkpoint-every", "1"});
  EXPECT_EQ(neve({"verify", "run"}).exit_code, 0);
  const std::string file = "run/particles/0002.exr";
  const std::string whole = read_text(folder / file);
  std::filesystem::resize_file(folder / file, 500);
  const auto verified = neve({"verify", "run"});
  EXPECT_EQ(verified.exit_code, 9);
  EXPECT_TRUE(contains(verified.output + verified.errors, "particles/0002.exr")) << verified.output;
  render(
      {"flying.toml", "--passes", "depth", "--out", "run", "--checkpoint-every", "1", "--resume"});
  EXPECT_EQ(read_text(folder / file), whole);
  const auto other = neve({"render", "flying.toml", "--out", "run", "--resume"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(contains(other.errors, "--passes was depth")) << other.errors;
}

TEST_F(Passes, ALaterRunRemovesTheFilesOfAnEarlierOne) {
  render({"flying.toml", "--passes", "depth", "--out", "run"});
  folder.write("run/particles/mine.exr", "mine");
  render({"flying.toml", "--out", "run", "--replace"});
  EXPECT_FALSE(exists("run/particles/0002.exr"));
  EXPECT_TRUE(exists("run/particles/0002.png"));
  EXPECT_TRUE(exists("run/particles/mine.exr"));
}

TEST_F(Passes, OpenGlDrawsTheSamePassesAsTheCpu) {
  render({"flying.toml", "--passes", "all", "--frames", "1-1", "--out", "cpu"});
  ASSERT_EQ(setenv("NEVE_PARTICLES", "gl", 1), 0);
  render({"flying.toml", "--passes", "all", "--frames", "1-1", "--out", "gl"});
  unsetenv("NEVE_PARTICLES");
  const render::ExrPicture cpu = picture("cpu/particles/0001.exr"),
                           gl = picture("gl/particles/0001.exr");
  ASSERT_EQ(cpu.channels.size(), gl.channels.size());
  for (std::size_t c = 0; c < cpu.channels.size(); ++c)
    EXPECT_EQ(cpu.channels[c].numbers, gl.channels[c].numbers) << cpu.channels[c].name;
}

TEST_F(Passes, WhatTheStateDoesNotSayOfSeveralEmittersIsNoPass) {
  const auto emitter = [](const std::string& name, const std::string& x) {
    return "[[emitter]]\nname = \"" + name + "\"\nshape = { box = { center = [" + x +
           ", 0.3, 0], size = [0.1, 0.1, 0.1] } }\nvelocity = [0, -1, 0]\nrate = 4\n";
  };
  folder.write("two.toml", flying_scene + emitter("left", "-0.3") + emitter("right", "0.3"));
  for (const char* passes : {"body", "depth,age", "all,age"}) {
    const auto refused = neve({"render", "two.toml", "--passes", passes});
    EXPECT_EQ(refused.exit_code, 2) << passes;
    EXPECT_TRUE(contains(refused.errors, "which of several emitters")) << refused.errors;
  }
  const auto all = neve({"render", "two.toml", "--passes", "all", "--view", "particles", "--frames",
                         "1-1", "--no-movie", "--out", "all"});
  EXPECT_EQ(all.exit_code, 0) << all.errors;
  EXPECT_TRUE(contains(all.errors, "no pass body: the state does not say")) << all.errors;
  const render::ExrPicture drawn = picture("all/particles/0001.exr");
  const auto has = [&](const char* name) {
    return std::ranges::any_of(drawn.channels, [&](const auto& c) { return c.name == name; });
  };
  EXPECT_TRUE(has("id.Y"));
  EXPECT_FALSE(has("body.Y"));
}

}  // namespace
}  // namespace neve::test
