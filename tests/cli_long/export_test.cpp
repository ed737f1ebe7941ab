/// neve export, read by VTK; the recipes of docs/python.md.

#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"
#include "tests/support/python.h"

namespace neve::test {
namespace {

class ExportToVtk : public Cli {};

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
