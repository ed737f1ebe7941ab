/// neve export, read by VTK.

#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"
#include "tests/support/python.h"

namespace neve::test {
namespace {

class ExportToVtk : public Cli {};

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

}  // namespace
}  // namespace neve::test
