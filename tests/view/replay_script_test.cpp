#include "app/view/replay/replay_script.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/scene/toml/error.h"
#include "app/view/frontend/key_names.h"

namespace neve::app {
namespace {

std::string complaint(const std::string& text) {
  try {
    app::view::replay::parse_replay(text, "clicks.json");
  } catch (const app::scene::toml::SceneError& error) {
    return error.what();
  }
  return "no complaint";
}

constexpr const char* every_step = R"([
{"click":"Run"},
{"click":[12,40],"at_frame":3,"button":"right","times":2,"ctrl":true},
{"drag":["E0",{"label":"E0","part":[0.25,0.5]},[300,20.5]],"steps":4,"shift":true},
{"move":{"label":"picture","part":[0.1,0.9]}},
{"wheel":2,"at":[400,300]},
{"wheel":[-1,0.5]},
{"key":"z","ctrl":true,"alt":true,"super":true},
{"key":"space","hold":30},
{"type":"snö \"w\""},
{"paste":"a\nb"},
{"wait":5},
{"wait_for":"simulation frame 12"},
{"wait_for":"label Run","within":2.5},
{"screenshot":"a/b.png"},
{"screenshot":"part.png","crop":[1,2,30,40]},
{"screenshot":"panel.png","crop":"Parameters"},
{"resize":[1920,1080,2]},
{"resize":[640,480]},
{"drop":"scene.toml"},
{"quit":true}
]
)";

TEST(ReplayScript, EveryStepIsReadAndWrittenAlike) {
  const std::vector<app::view::replay::ReplayStep> steps =
      app::view::replay::parse_replay(every_step, "clicks.json");
  ASSERT_EQ(steps.size(), 20u);
  // The order of the keys in a step is the writer's.
  const std::string written = app::view::replay::replay_text(steps);
  EXPECT_EQ(app::view::replay::replay_text(app::view::replay::parse_replay(written, "written")),
            written);
  EXPECT_EQ(std::count(written.begin(), written.end(), '\n'), 22);
  EXPECT_EQ(steps[1].at_frame, 3);
  EXPECT_EQ(steps[1].button, 1);
  EXPECT_EQ(steps[1].times, 2);
  EXPECT_TRUE(steps[1].held.ctrl);
  ASSERT_EQ(steps[2].places.size(), 3u);
  EXPECT_EQ(steps[2].places[1].label, "E0");
  EXPECT_EQ(steps[2].places[1].x, 0.25f);
  EXPECT_EQ(steps[2].places[2].y, 20.5f);
  EXPECT_EQ(steps[4].wheel_y, 2);
  EXPECT_EQ(steps[5].wheel_x, -1);
  EXPECT_EQ(steps[6].key, 'Z');
  EXPECT_EQ(steps[7].frames, 30);
  EXPECT_EQ(steps[8].text, "snö \"w\"");
  EXPECT_EQ(steps[12].seconds, 2.5);
  EXPECT_EQ((*steps[14].crop)[3], 40);
  EXPECT_EQ(steps[15].crop_label, "Parameters");
  EXPECT_EQ(steps[16].size.scale, 2);
  EXPECT_EQ(steps[18].line, 20);
}

/// Handles of a scene from 0 have such numbers, and what records them is replayed.
TEST(ReplayScript, FramesBelowZeroAreAwaited) {
  const auto goal = app::view::replay::parse_goal("simulation frame -12");
  ASSERT_TRUE(goal);
  EXPECT_EQ(goal->frame, -12);
  EXPECT_FALSE(app::view::replay::parse_goal("simulation frame -"));
}

TEST(ReplayScript, MisspeltStepNamesPlaceAndNearestName) {
  EXPECT_EQ(complaint("[\n {\"wait\": 3},\n {\"clik\": \"Run\"}\n]"),
            "clicks.json:3:2: error: step 2: nothing to do; expected one of click, drag, move, "
            "wheel, key, type, paste, wait, wait_for, screenshot, resize, drop, quit; did you mean "
            "\"click\"?");
  EXPECT_EQ(complaint("[{\"click\": \"Run\", \"buton\": \"left\"}]"),
            "clicks.json:1:19: error: unknown key \"buton\" in [step 1]; did you mean \"button\"?");
  EXPECT_EQ(complaint("[{\"key\": \"spacee\"}]"),
            "clicks.json:1:10: error: step 1.key = \"spacee\"; expected the name of a key; did you "
            "mean \"space\"?");
}

TEST(ReplayScript, ColumnCountsCharactersOverNestedValuesAndStrings) {
  EXPECT_EQ(complaint("[{\"type\": \"ö]}\\\"{\"}, {\"click\": [1, 2], \"times\": 0}]"),
            "clicks.json:1:49: error: step 2.times = 0; expected 1 <= value <= 9");
}

struct Wrong {
  const char* script;
  const char* message;  ///< a part of it
};

TEST(ReplayScript, EveryWrongValueIsRefusedWithWhatWasExpected) {
  const Wrong all[] = {
      {"", "not valid JSON"},
      {"[{\"wait\": 3}", "not valid JSON"},
      {"{\"wait\": 3}", "is a list of steps"},
      {"[3]", "3 is not a step"},
      {"[{}]", "nothing to do"},
      {"[{\"wait\": 3, \"type\": \"a\"}]", "one action"},
      {"[{\"click\": null}]", "null"},
      {"[{\"click\": [1, 2], \"at\": [1, 2]}]", "unknown key \"at\""},
      {"[{\"wait\": 3, \"wait\": 4}]", "\"wait\" is given twice"},
      {"[{\"wait\": 0}]", "1 <= value"},
      {"[{\"wait\": 1.5}]", "a whole number"},
      {"[{\"wait\": \"long\"}]", "a whole number"},
      {"[{\"wait\": 1e300}]", "1 <= value"},
      {"[{\"click\": 3}]", "a place"},
      {"[{\"click\": \"\"}]", "a place"},
      {"[{\"click\": [1]}]", "a place"},
      {"[{\"click\": [1, 1e30]}]", "a place"},
      {"[{\"click\": {\"label\": \"a\", \"prat\": [0, 0]}}]", "a place"},
      {"[{\"click\": {\"label\": \"a\", \"part\": [0, 2]}}]", "a place"},
      {"[{\"click\": [1, 2], \"button\": \"top\"}]", "\"left\", \"right\" or \"middle\""},
      {"[{\"click\": [1, 2], \"ctrl\": 1}]", "true or false"},
      {"[{\"drag\": [[1, 2]]}]", "two places"},
      {"[{\"drag\": \"Run\"}]", "two places"},
      {"[{\"wheel\": 1000}]", "notches"},
      {"[{\"key\": \"\"}]", "the name of a key"},
      {"[{\"wait_for\": \"simulation frame x\"}]", "simulation frame N"},
      {"[{\"wait_for\": \"label \"}]", "simulation frame N"},
      {"[{\"wait_for\": \"simulation paused\", \"within\": 0}]", "0.001 <= value"},
      {"[{\"screenshot\": \"a.jpg\"}]", ".png"},
      {"[{\"screenshot\": \"../../evil.png\"}]", "within the folder of --out"},
      {"[{\"screenshot\": \"a/../b.png\"}]", "within the folder of --out"},
      {"[{\"screenshot\": \"/tmp/evil.png\"}]", "within the folder of --out"},
      {"[{\"screenshot\": \"a.png\", \"crop\": [1, 2, 3]}]", "[x, y, width, height]"},
      {"[{\"screenshot\": \"a.png\", \"crop\": [1, 2, 0, 3]}]", "[x, y, width, height]"},
      {"[{\"resize\": [1, 1]}]", "from 64 to 8192"},
      {"[{\"resize\": [640, 480, 9]}]", "from 64 to 8192"},
      {"[{\"quit\": false}]", "expected true"},
      {"[{\"at_frame\": -1, \"wait\": 1}]", "at_frame"},
  };
  for (const Wrong& wrong : all) {
    const std::string message = complaint(wrong.script);
    EXPECT_NE(message.find(wrong.message), std::string::npos) << wrong.script << "\n" << message;
    EXPECT_TRUE(message.starts_with("clicks.json:1:")) << message;
  }
}

TEST(ReplayScript, DeepNestingIsNoTrouble) {
  const std::string deep = std::string(200'000, '[') + std::string(200'000, ']');
  EXPECT_NE(complaint(deep).find("error"), std::string::npos);
  EXPECT_NE(complaint("[{\"click\": " + deep + "}]").find("a place"), std::string::npos);
}

TEST(KeyNames, EveryNamedKeyIsFoundByItsName) {
  int named = 0;
  for (int key = 0; key <= app::view::frontend::key::last; ++key) {
    const std::string name = app::view::frontend::key_name(key);
    if (name.empty()) continue;
    ++named;
    EXPECT_EQ(app::view::frontend::key_named(name), key) << name;
  }
  // Letters, digits, signs, twelve function keys, and those listed by name.
  EXPECT_EQ(named, 26 + 10 + 16 + static_cast<int>(app::view::frontend::key_names().size()));
  EXPECT_EQ(app::view::frontend::key_named("Z"), 'Z');
  EXPECT_EQ(app::view::frontend::key_named("f13"), std::nullopt);
}

}  // namespace
}  // namespace neve::app
