/// Solids that everybody knows, from Debian's packages, as snow.

#include <cstdlib>
#include <filesystem>
#include <map>

#include "app/output/atomic_file.h"
#include "app/output/process.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

class PublicSolids : public Cli {
 protected:
  void write_scene(const std::string& mesh, double scale, double cell_size) {
    folder.write("solid.toml", "frames = 1\n[solver]\ncell_size = " + std::to_string(cell_size) +
                                   "\n[[view]]\nname = \"particles\"\n[[body]]\nname = "
                                   "\"solid\"\nshape = { mesh = { file = \"" +
                                   mesh + "\", scale = " + std::to_string(scale) +
                                   " } }\n[output]\nsize = [160, 90]\n");
  }

  double particles(const std::string& mesh, double scale, double cell_size) {
    write_scene(mesh, scale, cell_size);
    const auto planned = neve({"render", "solid.toml", "--dry-run", "--json"});
    EXPECT_EQ(planned.exit_code, 0) << mesh << planned.errors;
    return planned.exit_code == 0 ? app::Json::parse(planned.output)["particles"].get<double>() : 0;
  }

  /// Snow covers a part of the picture.
  void expect_drawn(const std::string& mesh, double scale, double cell_size) {
    write_scene(mesh, scale, cell_size);
    const auto drawn = neve({"render", "solid.toml", "--view", "snow", "--no-caption", "--no-movie",
                             "--quiet", "--out", "drawn", "--replace"});
    ASSERT_EQ(drawn.exit_code, 0) << mesh << drawn.errors;
    for (const char* frame : {"drawn/snow/0000.png", "drawn/snow/0001.png"}) {
      const render::Image image = render::decode_png(app::output::read_file(folder / frame));
      int white = 0;
      for (std::size_t k = 0; k < image.pixels.size();
           k += static_cast<std::size_t>(image.channels))
        white += image.pixels[k] > 120;
      EXPECT_GT(white, image.width * image.height / 50) << mesh << frame;
    }
  }
};

/// Closed copies are made of voxels 1/200 of the solid; winding numbers are sampled to half a per
/// cent.
TEST_F(PublicSolids, SuzanneAndTheTeapotWeighAsTheirClosedCopies) {
  const auto blender = app::output::find_program("blender");
  if (!blender) SKIP_OR_FAIL("no blender in PATH; install blender");
  const auto made = app::output::run_process(
      *blender,
      {"-b", "--python-exit-code", "1", "--python",
       NEVE_SOURCE_DIR "/tests/python/public_solids.py", "--", folder.path().string()},
      folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  for (const std::string name : {"suzanne", "teapot", "torus", "icosphere"}) {
    const double open = particles(name + ".obj", 1, 0.02);
    EXPECT_GT(open, 10000);
    EXPECT_NEAR(open / particles(name + "_closed.obj", 1, 0.02), 1, 0.02) << name;
    expect_drawn(name + ".obj", 1, 0.05);
  }
}

/// Scales make each about 2 m across.
TEST_F(PublicSolids, ModelsOfManyProgramsAreDrawn) {
  const char* given = std::getenv("NEVE_ASSIMP_MODELS");
  const std::filesystem::path models = given ? given : "/usr/share/assimp/models";
  if (!std::filesystem::exists(models))
    SKIP_OR_FAIL("no models: install assimp-testmodels, or NEVE_ASSIMP_MODELS=folder");
  const std::map<std::string, double> scales{{"OBJ/spider.obj", 0.01},
                                             {"OBJ/WusonOBJ.obj", 1},
                                             {"PLY/Wuson.ply", 1},
                                             {"STL/Wuson.stl", 1},
                                             {"STL/Spider_ascii.stl", 0.5},
                                             {"STL/Spider_binary.stl", 0.5},
                                             {"STL/sphereWithHole.stl", 0.5},
                                             {"STL/3DSMaxExport.STL", 0.1},
                                             {"OBJ/box.obj", 1},
                                             {"OBJ/box_longline.obj", 1},
                                             {"PLY/cube_binary.ply", 1}};
  for (const auto& [file, scale] : scales) expect_drawn((models / file).string(), scale, 0.1);
  const double obj = particles((models / "OBJ/WusonOBJ.obj").string(), 1, 0.05);
  // The same model in three formats.
  EXPECT_EQ(particles((models / "PLY/Wuson.ply").string(), 1, 0.05), obj);
  EXPECT_EQ(particles((models / "STL/Wuson.stl").string(), 1, 0.05), obj);
}

}  // namespace
}  // namespace neve::test
