/// neve view, worked by scripts: what it saves is what neve render makes of it.

#include "tests/cli/run_neve.h"
#include "tests/support/child.h"

namespace neve::test {
namespace {

class View : public Cli {
 protected:
  app::output::ProcessResult view(const std::string& script, std::vector<std::string> more = {}) {
    folder.write("script.json", script);
    std::vector<std::string> arguments{"view",  "scene.toml", "--replay", "script.json",
                                       "--out", "viewed",     "--size",   "1100x700"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return neve(arguments);
  }
  app::Json info_of(const std::string& picture) {
    const auto result = neve({"info", picture, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return app::parse_json(std::string_view(result.output));
  }
};

TEST_F(View, APictureOfAChangedRunIsMadeAgain) {
  const auto result = view(R"([
    {"click": "Frame"}, {"wait_for": "simulation frame 1"},
    {"click": "material.snow.youngs_modulus", "ctrl": true},
    {"key": "a", "ctrl": true}, {"type": "30000"}, {"key": "enter"}, {"wait": 5},
    {"click": "Run"}, {"wait_for": "simulation frame 3"}, {"wait_for": "simulation paused"},
    {"key": "left"}, {"wait_for": "simulation frame 3"}, {"wait": 5},
    {"key": "p"}, {"wait": 10},
    {"screenshot": "end.png"}, {"quit": true}])");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  ASSERT_TRUE(exists("viewed/end.png"));
  std::string picture;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "viewed"))
    if (contains(entry.path().filename().string(), "particles_0003_step"))
      picture = "viewed/" + entry.path().filename().string();
  ASSERT_FALSE(picture.empty());
  const app::Json saved = info_of(picture);
  ASSERT_EQ(saved["changes"].size(), 1u);
  EXPECT_EQ(saved["changes"][0]["address"], "material.snow.youngs_modulus");
  EXPECT_GT(saved["changes"][0]["step"], 0);
  const auto again = neve({"render", picture, "--out", "again"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(info_of("again/particles/0003.png")["state_hash"], saved["state_hash"]);
}

/// A picture reads the mesh of a collider again, which is gone.
TEST_F(View, APictureThatCannotBeDrawnDoesNotEndTheProgram) {
  folder.write("mesh.obj",
               "v 0 0 0\nv 0.3 0 0\nv 0 0.2 0\nv 0 0 0.3\n"
               "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  folder.write("scene.toml",
               std::string(tiny_scene) +
                   "[[collider]]\nname = \"mesh\"\n"
                   "shape = { mesh = { file = \"mesh.obj\", center = [1, 0, 0] } }\n");
  folder.write("script.json", R"([
    {"click": "Frame"}, {"wait_for": "simulation frame 1"}, {"wait": 5},
    {"screenshot": "before.png"}, {"wait": 90}, {"wheel": 3, "at": [500, 300]}, {"wait": 20},
    {"screenshot": "after.png"}, {"quit": true}])");
  const pid_t program =
      start_program({"/bin/bash", "-c",
                     "cd \"$1\" && exec \"$0\" view scene.toml --replay script.json --out viewed "
                     "--size 900x600 2>said",
                     NEVE_BINARY, folder.path().string()});
  ASSERT_TRUE(wait_for_file(folder / "viewed/before.png"));
  std::filesystem::remove(folder / "mesh.obj");
  EXPECT_EQ(wait_for(program), 0) << read_text(folder / "said");
  EXPECT_TRUE(exists("viewed/after.png"));
}

TEST_F(View, AScriptEndsWithTheFileThatWasNotSaved) {
  const std::string save = R"([
    {"click": "Frame"}, {"wait_for": "simulation frame 1"}, {"wait": 5},
    {"key": "p"}, {"wait": 10}, {"key": "s", "ctrl": true}, {"wait": 5}, {"quit": true}])";
  folder.write("viewed", "a file where the folder is to be");
  const auto result = view(save);
  EXPECT_EQ(result.exit_code, 6) << result.errors;
  EXPECT_TRUE(contains(result.errors, "no picture: ")) << result.errors;
  std::filesystem::remove(folder / "viewed");
  EXPECT_EQ(view(save).exit_code, 0);
  EXPECT_TRUE(exists("viewed/scene.toml"));
}

/// Panels leave a place for the picture that is higher than wide.
TEST_F(View, APictureIsFramedAsRenderFramesIt) {
  const auto result = view(R"([
    {"click": "Frame"}, {"wait_for": "simulation frame 1"}, {"wait": 5},
    {"key": "p"}, {"wait": 10}, {"quit": true}])");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  std::string picture;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "viewed"))
    if (entry.path().extension() == ".png") picture = "viewed/" + entry.path().filename().string();
  ASSERT_FALSE(picture.empty());
  ASSERT_EQ(neve({"render", picture, "--out", "again"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "rendered", "--no-movie"}).exit_code, 0);
  for (const char* other : {"again/particles/0001.png", "rendered/particles/0001.png"}) {
    const auto same =
        neve({"compare", picture, other, "--threshold", "0", "--local-threshold", "0"});
    EXPECT_EQ(same.exit_code, 0) << other << same.output << same.errors;
  }
}

TEST_F(View, APictureOpensTheSceneInIt) {
  ASSERT_EQ(neve({"render", "scene.toml", "--set", "material.snow.density=250", "--frames", "0-1",
                  "--out", "rendered", "--no-movie"})
                .exit_code,
            0);
  folder.write("script.json", R"([
    {"click": "Frame"}, {"wait_for": "simulation frame 1"}, {"wait": 5},
    {"key": "p"}, {"wait": 10}, {"quit": true}])");
  const auto result = neve({"view", "rendered/particles/0000.png", "--replay", "script.json",
                            "--out", "viewed", "--size", "1100x700"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  std::string picture;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "viewed"))
    if (entry.path().extension() == ".png") picture = "viewed/" + entry.path().filename().string();
  ASSERT_FALSE(picture.empty());
  EXPECT_EQ(info_of(picture)["state_hash"], info_of("rendered/particles/0001.png")["state_hash"]);
}

TEST_F(View, ViewRecordsASequenceThatRenderWouldMake) {
  const auto result = view(R"([
    {"click": "Save ..."}, {"wait": 3}, {"click": "Record every frame"}, {"wait": 3},
    {"key": "escape"}, {"wait": 3},
    {"click": "Run"}, {"wait_for": "simulation frame 4"}, {"wait_for": "simulation paused"},
    {"wait": 5}, {"quit": true}])");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "rendered", "--no-movie"}).exit_code, 0);
  for (const char* frame : {"0001.png", "0002.png", "0003.png", "0004.png"}) {
    ASSERT_TRUE(exists(std::string("viewed/particles/") + frame)) << frame;
    EXPECT_EQ(info_of(std::string("viewed/particles/") + frame)["state_hash"],
              info_of(std::string("rendered/particles/") + frame)["state_hash"]);
  }
}

TEST_F(View, ViewShowsWhyARunBroke) {
  folder.write("scene.toml", exploding_scene);
  const auto result = view(R"([
    {"click": "Run"}, {"wait_for": "label Show me"}, {"click": "Show me"}, {"wait": 10},
    {"screenshot": "incident.png"}, {"click": "Reset"}, {"wait": 10}, {"quit": true}])");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(exists("viewed/incident.png"));
}

TEST_F(View, ViewRefusesImpossibleOptionsBeforeAnythingOpens) {
  EXPECT_EQ(neve({"view", "nowhere.toml"}).exit_code, 3);
  EXPECT_EQ(neve({"view", "scene.toml", "--set", "material.snow.poisson_ratio=1"}).exit_code, 2);
  EXPECT_EQ(neve({"view", "scene.toml", "--listen", "127.0.0.1:99999"}).exit_code, 2);
  EXPECT_EQ(neve({"view", "scene.toml", "--web", "--window"}).exit_code, 2);
  const auto view_name = neve({"view", "scene.toml", "--view", "smokey", "--web", "--frames", "1"});
  EXPECT_EQ(view_name.exit_code, 2);
  EXPECT_TRUE(contains(view_name.errors, "smoke")) << view_name.errors;
  EXPECT_EQ(view(R"([{"klick": "Run"}])").exit_code, 3);
  const auto label = view(R"([{"click": "Rum"}])");
  EXPECT_EQ(label.exit_code, 9);
  EXPECT_TRUE(contains(label.errors, "Run")) << label.errors;
}

}  // namespace
}  // namespace neve::test
