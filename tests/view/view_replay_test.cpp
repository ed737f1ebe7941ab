/// `neve view` as a person uses it, whose hand is a script.

#include <algorithm>

#include "app/errors.h"
#include "app/output/atomic_file.h"
#include "render/image.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

class ViewByScript : public Cli {
 protected:
  app::ProcessResult view(const std::string& script) {
    folder.write("clicks.json", script);
    return neve({"view", "scene.toml", "--replay", "clicks.json", "--out", "out", "--quiet"});
  }

  /// Files of the output folder whose names begin and end so.
  std::vector<std::string> files(const std::string& begin, const std::string& end) {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out")) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(begin) && name.ends_with(end)) found.push_back(name);
    }
    return found;
  }
};

#define SKIP_WITHOUT_GL(result) \
  if (result.exit_code == app::exit_no_backend) GTEST_SKIP() << result.errors

TEST_F(ViewByScript, AParameterIsFoundChangedSimulatedWithAndSaved) {
  const auto result = view(R"([
    {"click": "find a parameter"}, {"type": "hardening"},
    {"click": "material.snow.hardening", "button": "right"},
    {"wait_for": "label Copy the address"}, {"key": "escape"},
    {"click": "material.snow.hardening", "ctrl": true}, {"type": "17"}, {"key": "enter"},
    {"key": "."}, {"wait_for": "simulation frame 1"}, {"wait_for": "simulation paused"},
    {"key": "p"}, {"wait": 5}, {"key": "s", "ctrl": true}, {"wait": 5},
    {"screenshot": "window.png"}, {"screenshot": "picture.png", "crop": "picture"}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const render::Image window = render::decode_png(app::read_file(folder / "out" / "window.png"));
  EXPECT_EQ(window.width, 1280);
  const render::Image picture = render::decode_png(app::read_file(folder / "out" / "picture.png"));
  // Snow is bright, panels and background are not.
  const auto bright = std::count_if(picture.pixels.begin(), picture.pixels.end(),
                                    [](std::uint8_t value) { return value > 200; });
  EXPECT_GT(bright, static_cast<std::ptrdiff_t>(picture.pixels.size() / 200));
  EXPECT_TRUE(contains(read_text(folder / "out" / "scene.toml"), "hardening = 17"));
  const std::vector<std::string> saved = files("particles_0001_step", ".png");
  ASSERT_EQ(saved.size(), 1u);
  const auto info = neve({"info", "out/" + saved[0]});
  EXPECT_TRUE(contains(info.output, "material.snow.hardening")) << info.output;
}

TEST_F(ViewByScript, DroppedSceneTakesOverAndWhatIsNoneIsOnlyAMessage) {
  folder.write("out/wrong.toml", "[material.snow]\nyoungs_modulos = 1\n");
  std::string other = tiny_scene;
  other.replace(other.find("name = \"ball\""), 13, "name = \"egg\" ");
  folder.write("out/other.toml", other);
  const auto result = view(R"([
    {"wait_for": "label body.ball"}, {"drop": "wrong.toml"}, {"wait": 10},
    {"click": "body.ball"}, {"wait": 5}, {"screenshot": "wrong.png"},
    {"drop": "other.toml"}, {"wait_for": "label body.egg"}])");
  SKIP_WITHOUT_GL(result);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

TEST_F(ViewByScript, WhatCannotBeDoneEndsItWithStepAndReason) {
  const auto result = view("[{\"wait\": 2},\n {\"click\": \"Simulate\"}]");
  SKIP_WITHOUT_GL(result);
  EXPECT_EQ(result.exit_code, app::exit_check_failed);
  EXPECT_TRUE(contains(
      result.errors, "clicks.json:2:2: error: step 2 (click): \"Simulate\" is not on the picture"))
      << result.errors;
}

TEST_F(ViewByScript, MistakeInTheScriptIsToldBeforeAnythingOpens) {
  const auto result = view("[{\"clik\": \"Run\"}]");
  EXPECT_EQ(result.exit_code, app::exit_invalid_scene);
  EXPECT_TRUE(contains(result.errors, "clicks.json:1:2: error: step 1")) << result.errors;
}

}  // namespace
}  // namespace neve::test
