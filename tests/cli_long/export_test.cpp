/// neve export, read by VTK, ParaView, OpenVDB, USD and Blender; the recipes of docs/python.md.

#include <cstdlib>

#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"
#include "tests/support/meshes.h"
#include "tests/support/needs.h"
#include "tests/support/python.h"

namespace neve::test {
namespace {

class ExportToVtk : public Cli {};

class ExportToOpenVdb : public Cli {};

class ExportToUsd : public Cli {};

class ExportToParaView : public Cli {};

class ExportToBlender : public Cli {};

class PythonPage : public Cli {};

TEST_F(ExportToVtk, VtkReadsTheSameBits) {
  const auto python = python_with("vtkmodules.vtkIOXML");
  if (!python) SKIP_OR_FAIL("no Python with VTK; install python3-vtk9");
  const auto written =
      neve({"export", "scene.toml", "--format", "npz,vtp,vti,ply", "--out", "all", "--attributes",
            "id,x,v,m,V0,density,J_E,J_P,F_E,stress,kirchhoff,C,material,body,radius,age"});
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  const auto same = run_script(*python, "check_vtk.py", {"all", "3"}, folder.path());
  EXPECT_EQ(same.output, "same\n") << same.errors;
}

TEST_F(ExportToVtk, VtkFindsNoHoleInASurface) {
  const auto python = python_with("vtkmodules.vtkIOXML");
  if (!python) SKIP_OR_FAIL("no Python with VTK; install python3-vtk9");
  const auto written = neve({"export", "scene.toml", "--format", "ply,vtp,obj", "--surface",
                             "--frames", "3-3", "--attributes", "id,x,J_P", "--out", "all"});
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  const auto same = run_script(*python, "check_vtk_surface.py", {"all", "3"}, folder.path());
  EXPECT_EQ(same.output, "same\n") << same.errors;
}

/// ./neve test --all installs it from PyPI and says where.
TEST_F(ExportToUsd, UsdOpensTheStages) {
  const auto python = python_with("numpy");
  const char* const usd = std::getenv("NEVE_USD");
  if (!python || !usd || !std::filesystem::exists(std::filesystem::path(usd) / "pxr"))
    SKIP_OR_FAIL("no USD: pip install --target DIR usd-core, and NEVE_USD=DIR");
  folder.write("stage.toml",
               std::string(tiny_scene) +
                   "[[collider]]\nname = \"sheet\"\nshape = { mesh_sequence = { files = "
                   "\"sheet_%04d.obj\", first = 0, last = 9, rate = 24, center = [3, 0, 0] } }\n"
                   "[[collider]]\nname = \"blade\"\nangular_velocity = [0, 0, 38]\nshape = "
                   "{ box = { center = [2, 0.2, 0], size = [0.3, 0.1, 0.1] } }\n"
                   "[camera]\neye = [0, 0.3, 1]\ntarget = [0, 0.1, 0]\n");
  written_sequence(folder, "sheet", 10, 24, [](int k) {
    return plate_obj({1, 0.3, 1}, 4,
                     [&](double x) { return sim::Vec3d(0, 0.1 * k * (0.5 - x), 0); });
  });
  auto written = neve({"export", "stage.toml", "--format", "npz,usda", "--frames", "1-4", "--up",
                       "z", "--scale", "100", "--out", "points"});
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  written = neve({"export", "stage.toml", "--format", "ply,usda", "--frames", "2-4", "--surface",
                  "--out", "surface"});
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  const auto same = run_script_with(*python, {std::string("PYTHONPATH=") + usd}, "check_usd.py",
                                    {"points", "surface"}, folder.path());
  EXPECT_EQ(same.output, "same\n") << same.errors;
}

/// ./neve test --all unpacks it from Debian's packages and says where.
TEST_F(ExportToParaView, ParaViewReadsTheSeriesToTheBit) {
  const char* const paraview = std::getenv("NEVE_PARAVIEW");
  const std::filesystem::path pvpython =
      std::filesystem::path(paraview ? paraview : "/usr/bin") / "pvpython";
  if (!std::filesystem::exists(pvpython))
    SKIP_OR_FAIL("no ParaView: install python3-paraview, or NEVE_PARAVIEW=folder of pvpython");
  const auto written =
      neve({"export", "scene.toml", "--format", "npz,vtp,vti", "--out", "all", "--attributes",
            "id,x,v,m,V0,density,J_E,J_P,F_E,stress,material,body,radius"});
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  const auto same = app::output::run_process(
      pvpython, {NEVE_SOURCE_DIR "/tests/python/check_paraview.py", "all"}, folder.path());
  EXPECT_EQ(same.output, "same\n") << same.errors;
}

TEST_F(ExportToBlender, TheScriptOfThePageDrawsAFrame) {
  const auto blender = app::output::find_program("blender");
  if (!blender) SKIP_OR_FAIL("no blender in PATH; install blender");
  ASSERT_EQ(neve({"export", "scene.toml", "--format", "ply,vdb", "--surface", "--up", "z",
                  "--frames", "3-3", "--out", "mesh"})
                .exit_code,
            0);
  const auto drawn = app::output::run_process(
      *blender,
      {"-b", "--python-exit-code", "1", "--python", NEVE_SOURCE_DIR "/docs/pipeline/frame.py", "--",
       "mesh/ply/0003.ply", (folder / "frame.png").string(), "1"},
      folder.path());
  ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
  EXPECT_TRUE(contains(drawn.output, "grains of spray")) << drawn.output;
  // White snow in front of a dark ground.
  const render::Image image = render::decode_png(app::output::read_file(folder / "frame.png"));
  int white = 0;
  for (std::size_t k = 0; k < image.pixels.size(); k += static_cast<std::size_t>(image.channels))
    white += image.pixels[k] > 180;
  EXPECT_GT(white, image.width * image.height / 50);
  const std::string script =
      "import bpy\nbpy.ops.object.volume_import(filepath='" +
      (folder / "mesh/vdb/0003.vdb").string() + "', directory='" + (folder / "mesh/vdb").string() +
      "', files=[{'name': '0003.vdb'}])\nvolume = bpy.context.object.data\nvolume.grids.load()\n"
      "print('grids', sorted(grid.name for grid in volume.grids))\n";
  const auto volume = app::output::run_process(
      *blender, {"-b", "--python-exit-code", "1", "--python-expr", script}, folder.path());
  EXPECT_TRUE(contains(volume.output, "grids ['density', 'mass', 'surface', 'velocity']"))
      << volume.output << volume.errors;
}

TEST_F(ExportToOpenVdb, OpenVdbReadsTheGridAndTheSurface) {
  const auto python = python_with("pyopenvdb");
  if (!python) SKIP_OR_FAIL("no Python with OpenVDB; install python3-openvdb");
  for (const std::vector<std::string>& axes :
       {std::vector<std::string>{}, {"--up", "z", "--scale", "100"}}) {
    std::vector<std::string> words{"export", "scene.toml", "--format", "vdb,ply", "--frames",
                                   "3-3",    "--surface",  "--out",    "all"};
    words.insert(words.end(), axes.begin(), axes.end());
    auto written = neve(words);
    ASSERT_EQ(written.exit_code, 0) << written.errors;
    words = {"export", "scene.toml", "--format", "vti", "--frames", "3-3", "--out", "grid"};
    words.insert(words.end(), axes.begin(), axes.end());
    ASSERT_EQ(neve(words).exit_code, 0);
    std::filesystem::rename(folder / "grid/vti", folder / "all/vti");
    const auto same = run_script(*python, "check_vdb.py", {"all", "3"}, folder.path());
    EXPECT_EQ(same.output, "same\n") << same.errors;
    std::filesystem::remove_all(folder / "all");
    std::filesystem::remove_all(folder / "grid");
  }
}

TEST_F(PythonPage, ThePageOfRecipesRuns) {
  const auto python = python_with("matplotlib.pyplot");
  if (!python) SKIP_OR_FAIL("no Python with matplotlib; install python3-matplotlib");
  std::filesystem::create_directory_symlink(NEVE_SOURCE_DIR "/scenes", folder / "scenes");
  const auto result = run_script_with(
      *python, {"NEVE=" NEVE_BINARY, "MPLBACKEND=Agg"}, "run_page.py",
      {NEVE_SOURCE_DIR "/python", NEVE_SOURCE_DIR "/docs/python.md"}, folder.path());
  EXPECT_TRUE(result.output.ends_with("done\n")) << result.errors;
  for (const char* picture : {"energy.png", "J_P.png", "transfers.png"})
    EXPECT_TRUE(exists(picture)) << picture;
}

}  // namespace
}  // namespace neve::test
