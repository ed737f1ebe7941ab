/// `neve view` as a person uses it, whose hand is a script.

#include <algorithm>
#include <array>

#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"
#include "tests/view/by_script.h"

namespace neve::test {
namespace {

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
  const render::Image window =
      render::decode_png(app::output::read_file(folder / "out" / "window.png"));
  EXPECT_EQ(window.width, 1280);
  const render::Image picture =
      render::decode_png(app::output::read_file(folder / "out" / "picture.png"));
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

TEST_F(ViewByScript, ASceneInThisFolderIsSavedOverItsFile) {
  folder.write("scene.toml", "# mine\n" + std::string(tiny_scene));
  const auto result = view(R"([
    {"click": "find a parameter"}, {"type": "hardening"},
    {"click": "material.snow.hardening", "ctrl": true}, {"type": "17"}, {"key": "enter"},
    {"click": "Save ..."}, {"wait_for": "label Scene with the changes, over its file"},
    {"click": "Scene with the changes, over its file"}, {"wait": 3}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string text = read_text(folder / "scene.toml");
  EXPECT_TRUE(text.starts_with("# mine") && contains(text, "hardening = 17")) << text;
}

TEST_F(ViewByScript, VaryFromHereMakesASweepOfTheFrameThatIsShown) {
  const auto result = view(R"([
    {"key": "."}, {"wait_for": "simulation frame 1"}, {"wait_for": "simulation paused"},
    {"key": "."}, {"wait_for": "simulation frame 2"}, {"wait_for": "simulation paused"},
    {"key": "left"}, {"wait_for": "simulation frame 1"},
    {"click": "Vary from here"}, {"wait_for": "label find a parameter to vary"},
    {"click": "find a parameter to vary"}, {"type": "hardening"},
    {"wait_for": "label vary material.snow.hardening"},
    {"click": "vary material.snow.hardening"},
    {"click": "values of material.snow.hardening"}, {"key": "a", "ctrl": true}, {"type": "4, 20"},
    {"click": "Start the runs"}, {"wait_for": "label Copy the command of the sweep"},
    {"wait": 3}, {"screenshot": "done.png"},
    {"click": {"label": "picture", "part": [0.5, 0.5]}}, {"wait": 5},
    {"screenshot": "run.png"}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  ASSERT_TRUE(std::filesystem::exists(folder / "out/vary_0001/sweep.cdb/sheet.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "out/vary_0001/sweep.cdb/report.html"));
  // The sheet is in the place of the picture until it is clicked.
  EXPECT_NE(read_text(folder / "out/done.png"), read_text(folder / "out/run.png"));
  // A run of the command line that forks there has the same state.
  ASSERT_EQ(neve({"render", "scene.toml", "--no-movie", "--out", "plain"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "plain", "--from", "0.041666666666666664s", "--set",
                  "material.snow.hardening=20", "--no-movie", "--out", "branch"})
                .exit_code,
            0);
  const auto hash = [&](const std::string& run) {
    return json_of(run + "/run.json")["frames"].back()["state_hash"];
  };
  EXPECT_EQ(hash("out/vary_0001/sweep.cdb/runs/0001"), hash("branch"));
}

/// However often the button is pressed, later frames stay until the question is answered.
TEST_F(ViewByScript, LaterFramesAreDroppedAfterAQuestionAlone) {
  const std::string start = R"([
    {"click": "Run"}, {"wait_for": "simulation frame 4"}, {"wait_for": "simulation paused"},
    {"key": "home"}, {"wait_for": "simulation frame 0"}, {"wait": 3},
    {"click": "Continue from here"}, {"wait_for": "label Drop them and continue"},
    {"click": "Continue from here"}, {"wait": 3},
    {"click": "Continue from here"}, {"wait_for": "label Keep them"},)";
  const auto kept = view(start + R"({"click": "Keep them"}, {"wait": 3},
    {"click": "Back to the run"}, {"wait_for": "simulation frame 4"}])");
  SKIP_WITHOUT_GL(kept);
  EXPECT_EQ(kept.exit_code, 0) << kept.errors;
  const auto dropped = view(start + R"({"click": "Drop them and continue"}, {"wait": 20},
    {"key": "end"}, {"wait": 20}, {"wait_for": "simulation frame 0"}])");
  EXPECT_EQ(dropped.exit_code, 0) << dropped.errors;
}

TEST_F(ViewByScript, ADroppedSceneIsOpenedAndAnotherFileIsAMessage) {
  folder.write("out/wrong.toml", "[material.snow]\nyoungs_modulos = 1\n");
  std::string other = tiny_scene;
  other.replace(other.find("name = \"ball\""), 13, "name = \"egg\" ");
  folder.write("out/other.toml", other);
  const auto result = view(R"([
    {"wait_for": "label body.ball"}, {"drop": "wrong.toml"}, {"wait": 10},
    {"click": "body.ball"}, {"wait": 5}, {"screenshot": "wrong.png"},
    {"drop": "other.toml"}, {"wait_for": "label body.egg"}, {"key": "p"}, {"wait": 5}])",
                           {"--coarsen", "1.25", "--set", "material.snow.hardening=5"});
  SKIP_WITHOUT_GL(result);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  // The dropped scene is as coarse as the first one; what was set was meant for that one.
  // Thresholds are of the scene's cell.
  const std::vector<std::string> saved = files("particles_0000_step", ".png");
  ASSERT_EQ(saved.size(), 1u);
  const auto info = neve({"info", "out/" + saved[0], "--json"});
  const app::Json json = app::parse_json(std::string_view(info.output));
  EXPECT_EQ(json["coarsen"], 1.25);
  EXPECT_EQ(json["overrides"], app::Json{"solver.threshold_cell=0.04"}) << info.output;
}

TEST_F(ViewByScript, ADroppedSceneThatIsTooLargeIsAMessageAndTheRunGoesOn) {
  std::string large = tiny_scene;
  large.replace(large.find("name = \"ball\""), 13, "name = \"egg\" ");
  folder.write("out/large.toml", large + "[limits]\nparticles = 10\n");
  const auto result = view(R"([
    {"key": "."}, {"wait_for": "simulation frame 1"}, {"wait_for": "simulation paused"},
    {"drop": "large.toml"}, {"wait": 10}, {"wait_for": "label body.ball"},
    {"wait_for": "simulation frame 1"}, {"key": "p"}, {"wait": 5}])");
  SKIP_WITHOUT_GL(result);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(files("particles_0001_step", ".png").size(), 1u);
}

/// --view and --at are of the scene that they are given with.
TEST_F(ViewByScript, ADroppedSceneBeginsWithAViewOfItsOwn) {
  std::string other = tiny_scene;
  other.replace(other.find("name = \"ball\""), 13, "name = \"egg\" ");
  folder.write("out/other.toml", other);
  folder.write("scene.toml", std::string(tiny_scene) + "[[view]]\nname = \"mine\"\n");
  const auto result = view(R"([
    {"wait_for": "label body.ball"}, {"drop": "other.toml"}, {"wait_for": "label body.egg"},
    {"wait": 5}, {"key": "p"}, {"wait": 5}])",
                           {"--view", "mine"});
  SKIP_WITHOUT_GL(result);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(files("particles_0000_step", ".png").size(), 1u);
}

TEST_F(ViewByScript, ASmallWindowHasAllButtonsOfTheBar) {
  const auto result = view(R"([
    {"click": "find a parameter"}, {"type": "hardening"},
    {"click": "material.snow.hardening", "ctrl": true}, {"type": "17"}, {"key": "enter"},
    {"wait": 3}, {"resize": [320, 240]}, {"wait": 5},
    {"click": "Undo"}, {"wait": 3}, {"click": "Redo"}, {"wait": 3},
    {"click": "Save ..."}, {"wait_for": "label Scene with the changes"},
    {"click": "Scene with the changes"}, {"wait": 5}, {"click": "?"}, {"wait": 3},
    {"screenshot": "small.png"}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(read_text(folder / "out" / "scene.toml"), "hardening = 17"));
}

TEST_F(ViewByScript, ANarrowWindowShowsOneColumnAtATime) {
  const auto result = view(R"([
    {"resize": [800, 600]}, {"wait": 3}, {"wait_for": "label Parameters"},
    {"click": "View"}, {"wait_for": "label Inspect"}, {"screenshot": "right.png"},
    {"click": "Parameters"}, {"wait_for": "label Objects"}, {"key": ";"},
    {"wait_for": "label Probe"}, {"screenshot": "stage.png"},
    {"resize": [640, 480]}, {"wait": 3}, {"click": "time line"}, {"click": "Parameters"},
    {"resize": [1280, 760]}, {"wait_for": "label Objects"}, {"wait_for": "label Inspect"}])");
  SKIP_WITHOUT_GL(result);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

/// Number of bytes of the pixels that differ between two screenshots.
std::size_t changed_bytes(const render::Image& a, const render::Image& b) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  std::size_t changed = 0;
  for (std::size_t k = 0; k < std::min(a.pixels.size(), b.pixels.size()); ++k)
    changed += a.pixels[k] != b.pixels[k];
  return changed;
}

TEST_F(ViewByScript, APictureOfAFrameShowsNoStage) {
  const auto picture = [&](const char* name) {
    return render::decode_png(app::output::read_file(folder / "out" / name));
  };
  const char* const saved = "slice_0000_step0.png";
  const auto result = view(R"([
    {"key": "3"}, {"wait": 10}, {"key": "p"}, {"wait": 8},
    {"screenshot": "frame.png", "crop": "picture"}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const render::Image plain = picture(saved);
  const auto inside = view(R"([
    {"key": "3"}, {"wait": 10}, {"key": ";"}, {"wait": 10}, {"key": ";"}, {"wait": 10},
    {"key": ";"}, {"wait": 30},
    {"screenshot": "stage.png", "crop": "picture"}, {"key": "p"}, {"wait": 12}])");
  ASSERT_EQ(inside.exit_code, 0) << inside.errors;
  EXPECT_GT(changed_bytes(picture("frame.png"), picture("stage.png")), 500u);  // its arrows
  EXPECT_EQ(changed_bytes(plain, picture(saved)), 0u);
}

TEST_F(ViewByScript, AClickBesideTheSnowIsAnsweredForAMoment) {
  const auto result = view(R"([
    {"wait": 20}, {"move": {"label": "picture", "part": [0.1, 0.9]}}, {"wait": 20},
    {"screenshot": "before.png", "crop": "picture"},
    {"click": {"label": "picture", "part": [0.1, 0.9]}}, {"wait": 3},
    {"screenshot": "told.png", "crop": "picture"}, {"wait": 150},
    {"screenshot": "after.png", "crop": "picture"}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto image = [&](const char* name) {
    return render::decode_png(app::output::read_file(folder / "out" / name));
  };
  const render::Image before = image("before.png");
  // A box of three words.
  EXPECT_GT(changed_bytes(before, image("told.png")), 500u);
  EXPECT_EQ(changed_bytes(before, image("after.png")), 0u);
}

/// A click on a plane that follows a body is a click on the same plane at a place of its own.
TEST_F(ViewByScript, AClickOnASliceIsOnThePlaneThatIsDrawn) {
  const auto picture = [&](const std::string& plane) {
    folder.write("scene.toml", R"(
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0.3], radius = 0.08 } }
[[view]]
name = "slice"
[view.camera]
eye = [0.3, 0.3, 0.7]
target = [0, 0.12, 0.3]
[view.slice]
normal = [0, 0, 1]
)" + plane);
    const auto result = view(R"([
      {"click": "Inspect"}, {"wait_for": "label Probe"},
      {"wait": 20}, {"click": {"label": "picture", "part": [0.53, 0.45]}},
      {"wait_for": "label Clear"}, {"wait": 20}, {"screenshot": "picture.png", "crop": "picture"}])",
                             {"--view", "slice"});
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == app::exit_no_backend) << result.errors;
    return result.exit_code == 0
               ? render::decode_png(app::output::read_file(folder / "out/picture.png"))
               : render::Image{};
  };
  const render::Image here = picture("point = [0, 0.12, 0.3]");
  if (here.pixels.empty()) SKIP_OR_FAIL("no way to draw");
  const render::Image at_body = picture("follow = \"ball\"\npoint = [0, 0, 0]");
  // The ring about the node would be at another place; the centre of the snow is near the ball's.
  EXPECT_LT(changed_bytes(here, at_body), 1000u);
}

TEST_F(ViewByScript, ImpossibleActionsEndItWithStepAndReason) {
  const auto result = view("[{\"wait\": 2},\n {\"click\": \"Simulate\"}]");
  SKIP_WITHOUT_GL(result);
  EXPECT_EQ(result.exit_code, app::exit_check_failed);
  EXPECT_TRUE(contains(
      result.errors, "clicks.json:2:2: error: step 2 (click): \"Simulate\" is not on the picture"))
      << result.errors;
}

TEST_F(ViewByScript, MistakesInTheScriptAreReportedBeforeAnythingOpens) {
  const auto result = view("[{\"clik\": \"Run\"}]");
  EXPECT_EQ(result.exit_code, app::exit_invalid_scene);
  EXPECT_TRUE(contains(result.errors, "clicks.json:1:2: error: step 1")) << result.errors;
}

/// The curve is bright on the dark of its frame, from one end of it to the other.
TEST_F(ViewByScript, AProbedParticleHasAPlotOverTime) {
  const auto result = view(R"([
    {"click": "Inspect"}, {"wait_for": "label Probe"}, {"key": "1"}, {"wait": 3},
    {"click": "picture"}, {"wait_for": "label Clear"},
    {"key": "."}, {"wait_for": "simulation frame 1"}, {"wait_for": "simulation paused"},
    {"key": "."}, {"wait_for": "simulation frame 2"}, {"wait_for": "simulation paused"},
    {"wait_for": "label probe plot"}, {"wait": 5},
    {"screenshot": "plot.png", "crop": "probe plot"}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const render::Image plot =
      render::decode_png(app::output::read_file(folder / "out" / "plot.png"));
  ASSERT_GT(plot.width, 100) << "the plot has no width";
  int bright_columns = 0;
  for (int x = 0; x < plot.width; ++x) {
    bool is_bright = false;
    for (int y = 0; y < plot.height; ++y)
      is_bright = is_bright ||
                  plot.pixels[(static_cast<std::size_t>(y) * plot.width + x) * plot.channels] > 110;
    bright_columns += is_bright;
  }
  EXPECT_GT(bright_columns, plot.width / 2);
}

/// Pixels of the ring around the widget that a step of the tour is about.
int ring_pixels(const render::Image& image) {
  int count = 0;
  for (std::size_t k = 0; k + 2 < image.pixels.size();
       k += static_cast<std::size_t>(image.channels))
    count += image.pixels[k] == 255 && image.pixels[k + 1] == 184 && image.pixels[k + 2] == 60;
  return count;
}

/// Some of the widgets are in the other column in a narrow window.
TEST_F(ViewByScript, EveryStepOfTheTourHasARing) {
  for (const char* size : {"[1280, 760]", "[390, 844]"}) {
    std::string script =
        std::string(R"([{"resize": )") + size + R"(}, {"wait": 3}, {"click": "Tour"})";
    for (int step = 0; step < 10; ++step)
      script += (step == 0 ? "" : R"(, {"click": "Next"})") +
                std::string(R"(, {"wait": 3}, {"screenshot": "tour)") + std::to_string(step) +
                R"(.png"})";
    const auto result = view(script + "]");
    SKIP_WITHOUT_GL(result);
    ASSERT_EQ(result.exit_code, 0) << size << ": " << result.errors;
    for (int step = 0; step < 10; ++step) {
      const std::string name = "tour" + std::to_string(step) + ".png";
      EXPECT_GT(ring_pixels(render::decode_png(app::output::read_file(folder / "out" / name))), 100)
          << size << ", step " << step + 1;
    }
  }
}

/// Some of the widgets are in the other column in a narrow window.
TEST_F(ViewByScript, TheTourHasTenStepsAndEnds) {
  for (const char* size : {"[1280, 760]", "[390, 844]"}) {
    std::string script =
        std::string(R"([{"resize": )") + size + R"(}, {"wait": 3}, {"click": "Tour"})";
    for (int step = 0; step < 9; ++step)
      script += R"(, {"wait_for": "label End the tour"}, {"click": "Next"}, {"wait": 3})";
    script += R"(, {"wait_for": "label Done"}, {"screenshot": "tour.png"}, {"click": "Previous"},
      {"wait_for": "label End the tour"}, {"click": "Next"}, {"wait_for": "label Done"},
      {"click": "Done"}, {"wait": 3}])";
    const auto result = view(script);
    SKIP_WITHOUT_GL(result);
    EXPECT_EQ(result.exit_code, 0) << size << ": " << result.errors;
  }
}

/// Middle of what differs between two pictures, px: the button that lights up under the mouse.
std::array<int, 2> middle_of_change(const render::Image& a, const render::Image& b) {
  int left = a.width, right = 0, top = a.height, bottom = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const std::size_t k = (static_cast<std::size_t>(y) * a.width + x) * a.channels;
      if (std::equal(a.pixels.begin() + k, a.pixels.begin() + k + a.channels, b.pixels.begin() + k))
        continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  return {(left + right) / 2, (top + bottom) / 2};
}

/// A hand that stays where it is clicks through the tour: no other button comes to lie there.
TEST_F(ViewByScript, TheTourIsClickedThroughAtOnePlace) {
  const auto found = view(R"([{"resize": [1280, 760]}, {"wait": 3}, {"click": "Tour"}, {"wait": 3},
    {"move": {"label": "picture", "part": [0.5, 0.2]}}, {"wait": 4}, {"screenshot": "before.png"},
    {"move": "Next"}, {"wait": 4}, {"screenshot": "lit.png"}])");
  SKIP_WITHOUT_GL(found);
  ASSERT_EQ(found.exit_code, 0) << found.errors;
  const auto image = [&](const char* name) {
    return render::decode_png(app::output::read_file(folder / "out" / name));
  };
  const auto [x, y] = middle_of_change(image("before.png"), image("lit.png"));
  std::string script = R"([{"resize": [1280, 760]}, {"wait": 3}, {"click": "Tour"}, {"wait": 4})";
  for (int step = 0; step < 9; ++step)
    script +=
        ", {\"click\": [" + std::to_string(x) + ", " + std::to_string(y) + "]}, {\"wait\": 3}";
  const auto clicked = view(script + R"(, {"wait_for": "label Done"}])");
  EXPECT_EQ(clicked.exit_code, 0) << clicked.errors;
}

/// A hand that stays where it is meets the same button in a run, in an older frame of it, and after
/// an object was added to it.
TEST_F(ViewByScript, ButtonsOfTheTimeLineAndOfObjectsStayWhereTheyAre) {
  const std::string rest = R"({"move": {"label": "picture", "part": [0.5, 0.2]}}, {"wait": 4},)";
  const auto look = [&](const std::string& button, const std::string& name) {
    return rest + R"({"screenshot": ")" + name + R"(_rest.png"}, {"move": ")" + button +
           R"("}, {"wait": 4}, {"screenshot": ")" + name + R"(_lit.png"},)";
  };
  const auto found = view(R"([{"resize": [1280, 760]}, {"click": "Run"},
    {"wait_for": "simulation frame 4"}, {"wait_for": "simulation paused"},)" +
                          look("Vary from here", "newest") +
                          R"({"key": "home"}, {"wait_for": "simulation frame 0"}, {"wait": 3},)" +
                          look("Vary from here", "older") +
                          R"({"key": "end"}, {"wait_for": "simulation frame 4"},
    {"click": "Objects"}, {"wait_for": "label Add ..."},)" +
                          look("Add ...", "before") +
                          R"({"click": "Add ..."}, {"click": "Collider: a sphere"},
    {"wait_for": "label collider.sphere"}, {"wait": 4},)" +
                          look("Add ...", "after") + rest + R"({"wait": 1}])");
  SKIP_WITHOUT_GL(found);
  ASSERT_EQ(found.exit_code, 0) << found.errors;
  const auto image = [&](const std::string& name) {
    return render::decode_png(app::output::read_file(folder / "out" / (name + ".png")));
  };
  const auto place = [&](const std::string& name) {
    return middle_of_change(image(name + "_rest"), image(name + "_lit"));
  };
  EXPECT_NE(place("newest"), place("before")) << "both were lit";
  EXPECT_EQ(place("newest"), place("older")) << "Vary from here";
  EXPECT_EQ(place("before"), place("after")) << "Add ...";
}

/// The list of keys is beside what it explains, in any window.
TEST_F(ViewByScript, TheListOfKeysLeavesThePictureFree) {
  for (const char* size : {"[1280, 760]", "[800, 600]", "[390, 844]"}) {
    const auto result = view(std::string(R"([{"resize": )") + size +
                             R"(}, {"wait": 40}, {"move": {"label": "picture", "part": [0.9, 0.9]}},
      {"wait": 40}, {"screenshot": "before.png", "crop": "picture"}, {"click": "?"},
      {"wait_for": "label keys and mouse"}, {"move": {"label": "picture", "part": [0.9, 0.9]}},
      {"wait": 40}, {"screenshot": "after.png", "crop": "picture"}])");
    SKIP_WITHOUT_GL(result);
    ASSERT_EQ(result.exit_code, 0) << size << ": " << result.errors;
    const auto image = [&](const char* name) {
      return render::decode_png(app::output::read_file(folder / "out" / name));
    };
    EXPECT_EQ(changed_bytes(image("before.png"), image("after.png")), 0u) << size;
  }
}

/// The lower half is for the panels, which a button hides and brings back: at the right, because
/// the caption is at the left.
TEST_F(ViewByScript, APhoneHeldUprightHasThePanelsBelow) {
  const auto result = view(R"([
    {"resize": [390, 844]}, {"wait": 3}, {"screenshot": "phone.png", "crop": "picture"},
    {"click": "Hide"}, {"wait_for": "label Panels"}, {"wait": 2},
    {"screenshot": "alone.png", "crop": "picture"}, {"click": [355, 16]},
    {"wait_for": "label Parameters"}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto size_of = [&](const char* name) {
    const render::Image image = render::decode_png(app::output::read_file(folder / "out" / name));
    return std::pair(image.width, image.height);
  };
  EXPECT_EQ(size_of("phone.png").first, 390);
  EXPECT_GT(size_of("phone.png").second, 300);
  EXPECT_LT(size_of("phone.png").second, 500);
  EXPECT_EQ(size_of("alone.png"), std::pair(390, 844));
}

/// Two drags are two changes, of one slider or of one arrow.
TEST_F(ViewByScript, AnUndoTakesOneDragBack) {
  folder.write("scene.toml", std::string(tiny_scene) + R"(
[[collider]]
name = "a"
shape = { sphere = { center = [-0.3, 0.1, 0], radius = 0.1 } })");
  const auto saved = [&](const std::string& script) {
    std::filesystem::remove_all(folder / "out");
    const auto result = view("[" + script + R"(, {"click": "Undo"}, {"wait": 5},
      {"key": "s", "ctrl": true}, {"wait": 3}])");
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == app::exit_no_backend) << result.errors;
    return result.exit_code == 0 ? read_text(folder / "out/scene.toml") : "";
  };
  const std::string slider = saved(R"({"click": "find a parameter"},
    {"type": "material.snow.hardening"}, {"wait": 5},
    {"drag": [{"label": "material.snow.hardening", "part": [0.3, 0.5]},
              {"label": "material.snow.hardening", "part": [0.5, 0.5]}]}, {"wait": 5},
    {"drag": [{"label": "material.snow.hardening", "part": [0.5, 0.5]},
              {"label": "material.snow.hardening", "part": [0.8, 0.5]}]}, {"wait": 5})");
  if (slider.empty()) SKIP_OR_FAIL("no way to draw");
  EXPECT_TRUE(contains(slider, "hardening")) << slider;
  const std::string handles = saved(R"({"click": "Objects"}, {"wait": 5},
    {"click": "collider.a"}, {"wait": 5},
    {"drag": ["handle x", {"label": "picture", "part": [0.3, 0.5]}]}, {"wait": 5},
    {"drag": ["handle x", {"label": "picture", "part": [0.2, 0.5]}]}, {"wait": 5})");
  EXPECT_FALSE(contains(handles, "center = [-0.3, 0.1, 0]")) << handles;
}

/// In some of these windows three columns have just room beside each other.
TEST_F(ViewByScript, ButtonsOfTheTimeLineAreWholeInWindowsOfAnyWidth) {
  const auto width = [&](const std::string& size) {
    const auto result = view(R"([{"resize": )" + size + R"(}, {"wait": 5},
      {"screenshot": "button.png", "crop": "Back to the run"}])",
                             {"--set", "frames=3600"});
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == app::exit_no_backend) << result.errors;
    return result.exit_code == 0
               ? render::decode_png(app::output::read_file(folder / "out/button.png")).width
               : 0;
  };
  const int whole = width("[1280, 760]");
  if (whole == 0) SKIP_OR_FAIL("no way to draw");
  for (const char* size : {"[960, 560]", "[1000, 560]", "[900, 560]", "[640, 480]", "[390, 844]"})
    EXPECT_EQ(width(size), whole) << size;
}

/// A step after frame 1, the key for earlier frames shows frame 1, whose picture is saved as it is.
TEST_F(ViewByScript, TheKeyForEarlierFramesStopsAtTheOneBeforeAStep) {
  const auto result = view(R"([
    {"key": "."}, {"wait_for": "simulation frame 1"}, {"wait_for": "simulation paused"},
    {"key": ","}, {"wait": 10}, {"key": "left"}, {"wait": 10}, {"key": "p"}, {"wait": 10}])");
  SKIP_WITHOUT_GL(result);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(files("particles_0001_step", ".png").size(), 1u);
}

/// The picture on the screen is the one that is saved, whatever is up in it.
TEST_F(ViewByScript, ThePictureOnTheScreenIsTiltedAsTheCameraOfTheScene) {
  const auto shown = [&](const std::string& up, const char* name) {
    const auto result = view(std::string(R"([{"key": "1"}, {"wait": 10}, {"screenshot": ")") +
                                 name + R"(", "crop": "picture"}])",
                             {"--set", "camera.eye=[0, 0.3, 1]", "--set",
                              "camera.target=[0, 0.1, 0]", "--set", "camera.up=" + up});
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == app::exit_no_backend) << result.errors;
    return result.exit_code == 0 ? render::decode_png(app::output::read_file(folder / "out" / name))
                                 : render::Image{};
  };
  const render::Image level = shown("[0, 1, 0]", "level.png");
  if (level.pixels.empty()) SKIP_OR_FAIL("no way to draw");
  EXPECT_GT(changed_bytes(level, shown("[1, 1, 0]", "tilted.png")), level.pixels.size() / 20);
}

}  // namespace
}  // namespace neve::test
