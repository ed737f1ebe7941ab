/// Terrain and the snow on it, from files to findings, pictures and exports.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "tests/cli/run_neve.h"
#include "tests/support/height_files.h"

namespace neve::test {
namespace {

constexpr const char* slope_scene = R"(
frames = 1
[solver]
cell_size = 0.1
[material.snow]
density = 300
[[collider]]
name = "slope"
[collider.shape.terrain]
file = "slope.asc"
coordinates = "world"
origin = [431000, 5254000, 1800]
[[view]]
name = "particles"
[[body]]
name = "slab"
shape = { cover = { on = "slope", depth = 0.4, width = 1.5, length = 2, center = [4, 0, 3] } }
[output]
size = [160, 90]
)";

double slope(double x) {
  return 1802 - 0.5 * x;
}

class Terrain : public Cli {
 protected:
  Terrain() {
    folder.write("scene.toml", slope_scene);
    std::string grid = height_grid(17, 13, 0.5, [](double x, double) { return slope(x); });
    // The first post is on the scene's origin.
    grid.replace(grid.find("xllcenter 0"), 11, "xllcenter 431000");
    const std::size_t south = grid.find("yllcenter"), end = grid.find('\n', south);
    grid.replace(south, end - south, "yllcenter 5253994");
    folder.write("slope.asc", grid);
  }
};

TEST_F(Terrain, CheckSaysMassAndDepthOfACover) {
  const auto result = neve({"check", "scene.toml"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const std::string said = result.output + result.errors;
  // 0.4 m x 1.5 m x 2 m x 300 kg/m3
  EXPECT_TRUE(contains(said, "lies 0.4 m deep on 3 m2 seen from above: 1.2 m3, 360 kg")) << said;
  EXPECT_TRUE(contains(said, "17 x 13 posts, 0.5 m apart, at heights from 1798 m to 1802 m"))
      << said;
  EXPECT_FALSE(contains(said, "starts inside")) << said;
}

/// The curve of docs/scenes.md: snow on a roof settles, held by friction, and then slides.
TEST_F(Terrain, HeightsAreToldAsFinelyAsTheyDiffer) {
  folder.write("slope.asc", height_grid(5, 5, 0.05, [](double x, double) { return 0.05 * x; }));
  const std::vector<std::string> words{
      "check", "scene.toml",
      "--set", "collider.slope.shape={ terrain = { file = \"slope.asc\" } }",
      "--set", "body.slab.shape={ sphere = { center = [0, 1, 0], radius = 0.2 } }"};
  const auto check = neve(words);
  EXPECT_TRUE(contains(check.output, "at heights from 0 m to 0.01 m")) << check.output;
}

TEST_F(Terrain, ACoverMaySettleBeforeItSlides) {
  std::string scene = read_text(NEVE_SOURCE_DIR "/scenes/roof.toml");
  const std::string page = read_text(NEVE_SOURCE_DIR "/docs/scenes.md"), start = "[[curve]]  ";
  const std::size_t from = page.find(start);
  ASSERT_NE(from, std::string::npos);
  scene += "\n" + page.substr(from, page.find("```", from) - from);
  scene.replace(scene.find("friction = 0.12"), 15, "");
  std::filesystem::create_directory_symlink(NEVE_SOURCE_DIR "/scenes/meshes", folder / "meshes");
  folder.write("roof.toml", scene);
  const auto result = neve({"render", "roof.toml", "--coarsen", "2", "--frames", "0-20", "--size",
                            "64x36", "--no-movie", "--out", "a"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const app::Json frames = json_of("a/run.json")["frames"];
  EXPECT_LT(frames[12]["max_speed"].get<double>(), 0.5);  // 0.13 m/s
  EXPECT_GT(frames[20]["max_speed"].get<double>(), 0.8);  // 1.27 m/s
  EXPECT_NEAR(frames[12]["height"].get<double>(), frames[0]["height"].get<double>(), 0.05);
}

TEST_F(Terrain, ExportsHaveTheCoordinatesOfTheMap) {
  const auto result = neve({"export", "scene.toml", "--frames", "0-0", "--format", "csv", "--up",
                            "z", "--attributes", "x,m", "--out", "e"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  std::istringstream rows(read_text(folder / "e/csv/0000.csv"));
  std::string row;
  std::getline(rows, row);
  double mass = 0;
  for (; std::getline(rows, row);) {
    double east = 0, north = 0, up = 0, m = 0;
    ASSERT_EQ(std::sscanf(row.c_str(), "%lf,%lf,%lf,%lf", &east, &north, &up, &m), 4) << row;
    EXPECT_NEAR(east, 431004, 0.75 + 1e-5);
    EXPECT_NEAR(north, 5253997, 1 + 1e-5);
    const double above = up - slope(east - 431000);
    // Places have single precision near the origin.
    EXPECT_GT(above, -1e-5);
    EXPECT_LT(above, 0.4 + 1e-5);
    mass += m;
  }
  EXPECT_NEAR(mass, 360, 1e-3);
}

TEST_F(Terrain, IsDrawnAsGroundAndItsPictureMakesItselfAgain) {
  ASSERT_EQ(neve({"render", "scene.toml", "--view", "snow", "--view", "particles", "--no-movie",
                  "--out", "a", "--quiet"})
                .exit_code,
            0);
  ASSERT_EQ(neve({"render", "a/snow/0001.png", "--no-movie", "--out", "b", "--quiet"}).exit_code,
            0);
  EXPECT_EQ(json_of("a/run.json")["frames"][1]["state_hash"],
            json_of("b/run.json")["frames"][0]["state_hash"]);
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "0-0", "--set", "view.particles.layers=[]",
                  "--no-movie", "--out", "c", "--quiet"})
                .exit_code,
            0);
  EXPECT_NE(read_text(folder / "a/particles/0000.png"), read_text(folder / "c/particles/0000.png"));
}

TEST_F(Terrain, HostileFilesEndBeforeTheRunWithTheirLine) {
  const std::string good = read_text(folder / "slope.asc");
  const auto refused = [&](const std::string& text, const std::string& says) {
    folder.write("slope.asc", text);
    const auto result = neve({"render", "scene.toml", "--dry-run"});
    EXPECT_EQ(result.exit_code, 3) << result.errors;
    EXPECT_TRUE(contains(result.errors, says)) << result.errors;
  };
  std::string huge = good;
  huge.replace(0, 8, "ncols 99999");
  refused(huge, "slope.asc:1: the header names 99999 x 13 posts");
  refused(good + "1\n", "slope.asc:19: \"1\" comes after all 221 heights");
  refused(good.substr(0, good.size() - 9), "expected 221, ncols x nrows");
  refused(std::string("II*\0", 4), "gdal_translate -of AAIGrid");
}

TEST_F(Terrain, IsNotReadWithoutRoomForIt) {
  folder.write("slope.asc", height_grid(300, 300, 0.5, [](double x, double) { return slope(x); }));
  const auto result = neve({"render", "scene.toml", "--dry-run", "--max-memory", "1MiB"});
  EXPECT_EQ(result.exit_code, 8) << result.errors;
  EXPECT_TRUE(contains(result.errors, "the height field needs about")) << result.errors;
}

TEST_F(Terrain, CoversWithoutGroundAreRefusedWithTheRemedy) {
  const auto refused = [&](const std::string& setting, const std::string& says) {
    const auto result = neve({"render", "scene.toml", "--dry-run", "--set", setting});
    // 2 where the mistake is in the setting itself, 3 where it is in the scene that this makes.
    EXPECT_TRUE(result.exit_code == 2 || result.exit_code == 3) << result.errors;
    EXPECT_TRUE(contains(result.errors, says)) << result.errors;
  };
  refused("body.slab.shape.cover.on=slop", "did you mean \"slope\"");
  refused("body.slab.shape.cover.width=0", "give width and length, or radius alone");
  refused("body.slab.shape.cover.width=9", "its posts are at x = 0 to 8");
  refused("body.slab.shape.cover.rotation=[10,0,0]", "cannot be tilted");
  refused("collider.slope.shape.terrain.rotation=[0,0,5]",
          "a terrain that is tilted carries no cover");
}

}  // namespace
}  // namespace neve::test
