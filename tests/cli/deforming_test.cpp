/// Scenes whose colliders are numbered files: runs, resumed runs, exports, mistakes.

#include <filesystem>

#include "app/output/atomic_file.h"
#include "tests/cli/run_neve.h"
#include "tests/support/child.h"
#include "tests/support/meshes.h"

namespace neve::test {
namespace {

constexpr const char* flap_scene = R"(
frames = 4
[solver]
cell_size = 0.04
[[view]]
name = "particles"
[[body]]
shape = { box = { center = [0, 0.06, 0], size = [0.16, 0.1, 0.16] } }
[[collider]]
name = "plate"
shape = { mesh_sequence = { files = "flap_%04d.obj", first = 0, last = 3, rate = 20 } }
[camera]
eye = [0, 0.3, 1]
target = [0, 0.05, 0]
[output]
size = [160, 90]
)";

class Deforming : public Cli {
 protected:
  Deforming() {
    folder.write("flap.toml", flap_scene);
    write_files(0.03);
  }
  /// A plate that bulges upwards, by so much from file to file.
  void write_files(double way) const {
    written_sequence(folder, "flap", 4, 20, [&](int k) {
      return plate_obj({0.4, 0.12, 0.4}, 6, [&](double x) {
        return sim::Vec3d(0, way * k * (1 - 25 * x * x) - 0.06, 0);
      });
    });
  }
  app::Json record(const std::string& out) const {
    return app::parse_json(read_text(folder / out / "run.json"));
  }
  void expect_refused(const std::string& setting, const std::string& part) {
    const auto result = neve({"check", "flap.toml", "--set", setting});
    EXPECT_NE(result.exit_code, 0) << setting;
    EXPECT_TRUE(contains(result.errors, part)) << result.errors;
  }
};

TEST_F(Deforming, ARunContinuesToTheBitAndOnlyWithItsFiles) {
  ASSERT_EQ(neve({"render", "flap.toml", "--out", "whole"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "flap.toml", "--out", "parts", "--frames", "0-2"}).exit_code, 0);
  const auto resumed =
      neve({"render", "flap.toml", "--out", "parts", "--frames", "0-4", "--resume"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
  const app::Json whole = record("whole"), parts = record("parts");
  EXPECT_EQ(whole.at("frames").back().at("state_hash"), parts.at("frames").back().at("state_hash"));
  // Other files are another run.
  write_files(0.02);
  ASSERT_EQ(neve({"render", "flap.toml", "--out", "other"}).exit_code, 0);
  EXPECT_NE(record("other").at("frames").back().at("state_hash"),
            whole.at("frames").back().at("state_hash"));
  const auto refused = neve({"render", "flap.toml", "--out", "parts", "--resume"});
  EXPECT_NE(refused.exit_code, 0);
  EXPECT_TRUE(contains(refused.errors, "is a different run")) << refused.errors;
  EXPECT_TRUE(contains(refused.errors, ".obj has changed since the run began")) << refused.errors;
}

TEST_F(Deforming, APictureOfAMovedProjectFindsItsNumberedFiles) {
  namespace fs = std::filesystem;
  ASSERT_EQ(neve({"render", "flap.toml", "--out", "out", "--frames", "0-2"}).exit_code, 0);
  fs::create_directory(folder / "moved");
  for (const char* part :
       {"flap_0000.obj", "flap_0001.obj", "flap_0002.obj", "flap_0003.obj", "out"})
    fs::rename(folder / part, folder / "moved" / part);
  const auto again = neve({"render", "moved/out/particles/0002.png", "--out", "again"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(record("again").at("frames").back().at("state_hash"),
            record("moved/out").at("frames").back().at("state_hash"));
}

TEST_F(Deforming, StagesHaveTheMeshAtEveryTime) {
  const auto written = neve({"export", "flap.toml", "--format", "usda", "--frames", "0-2",
                             "--scale", "100", "--out", "stage"});
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  const std::string stage = read_text(folder / "stage/usda.usda");
  const std::size_t at = stage.find("point3f[] points.timeSamples");
  ASSERT_NE(at, std::string::npos);
  // Vertex 13 is in the middle, on the lower side: from -12 cm up by 3 cm in a twentieth of a
  // second.
  const std::string points = stage.substr(at, stage.find("            }", at) - at);
  EXPECT_EQ(std::count(points.begin(), points.end(), '['), 4) << points;  // and the type's
  EXPECT_TRUE(contains(points, "(0, -12, -20)")) << points;
  const std::size_t second = points.find("2: ");
  ASSERT_NE(second, std::string::npos);
  EXPECT_TRUE(contains(points.substr(second), "(0, -7, -20)")) << points;
}

TEST_F(Deforming, MistakesWithNumberedFilesAreExplained) {
  const std::string at = "collider.plate.shape.mesh_sequence.";
  expect_refused(at + "files=\"flap.obj\"", "one %d, %04d, #### or $F4 in the name of the files");
  expect_refused(at + "files=\"../../etc/passwd\"",
                 "one %d, %04d, #### or $F4 in the name of the files");
  expect_refused(at + "last=5",
                 "flap_0004.obj: no such file; missing of the numbers 0 to "
                 "5: 4, 5");
  expect_refused(at + "last=0", "the files have the numbers 0 to 0; expected 2 to 10000 files");
  expect_refused(at + "last=999999", "the files have the numbers 0 to 999999; expected 2 to 10000");
  expect_refused(at + "last=1e12", "expected 0 <= value <= 999999");
  expect_refused(at + "rate=0", "expected 0.001 <= value");
  expect_refused(at + "scale=1e6", "more than 4194280 cells from the origin");
  folder.write("flap_0002.obj", box_obj({1, 1, 1}));
  const auto refused = neve({"check", "flap.toml"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_TRUE(contains(refused.errors, "flap_0002.obj: the mesh has 8 vertices")) << refused.errors;
  const auto body = neve({"check", "flap.toml", "--set",
                          "body.1.shape={mesh_sequence={files=\"flap_%04d.obj\", last=3}}"});
  EXPECT_EQ(body.exit_code, 2);
  EXPECT_TRUE(contains(body.errors, "unsupported shape")) << body.errors;
}

TEST_F(Deforming, FastFilesAreWarnedOfByTheirRate) {
  const auto checked = neve({"check", "flap.toml", "--set", "solver.time_step=\"fixed\"", "--set",
                             "collider.plate.shape.mesh_sequence.rate=20000"});
  EXPECT_TRUE(contains(checked.output + checked.errors, "collider.plate.shape.mesh_sequence.rate"))
      << checked.output;
}

}  // namespace
}  // namespace neve::test
