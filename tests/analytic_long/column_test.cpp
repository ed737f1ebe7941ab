/// A column of dry sand that collapses: how far it runs.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/sand.h"
#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

constexpr double radius = 0.4, height = 0.8;  // m

/// Run-out over the radius, of 98 % of the sand, a second after it was let go: it lies since 0.8 s.
/// @param cells  of the radius
double run_out(int cells, double friction) {
  SolverSettings s;
  s.cell_size = radius / cells;
  s.max_dt = 5e-3;
  const Material sand = dry_sand(26.3);  // slides at about 31 degrees, as that of the experiments
  ParticleArrays column;
  const ParticleArrays box =
      box_of_snow({-radius, 0, -radius}, {radius, height, radius}, s.cell_size / 2);
  for (std::size_t p = 0; p < box.x.size(); ++p) {
    if (std::hypot(box.x[p].x(), box.x[p].z()) > radius) continue;
    column.x.push_back(box.x[p]);
    column.v.push_back(box.v[p]);
    column.V0.push_back(box.V0[p]);
    column.m.push_back(sand.density * box.V0[p]);
  }
  Simulation simulation(s, {sand}, {plane({0, 0, 0}, {0, 1, 0}, friction)}, column, 2);
  simulation.advance_to(1);
  std::vector<double> r;
  for (const Vec3d& x : simulation.particles().x) r.push_back(std::hypot(x.x(), x.z()));
  const auto most = r.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(r.size()));
  std::nth_element(r.begin(), most, r.end());
  return *most / radius - 1;
}

/// Experiments with a height of twice the radius: 1.6 sqrt(2) = 2.26 (Lube, Huppert, Sparks and
/// Hallworth 2004, J. Fluid Mech. 508), 2 (Lajeunesse, Mangeney-Castelnau and Vilotte 2004, Phys.
/// Fluids 16). Theirs is the front, a few grains thick; cells hold it back, and finer ones less:
/// the tolerance is that of the two experiments and half of what the next finer cells add.
TEST(SandColumn, RunsOutAsInExperimentsWhereCellsAreFine) {
  for (const int cells : {6, 9})
    keep_number({"sand column", "cells of r/" + std::to_string(cells), "run-out over the radius"},
                run_out(cells, 0.5));
  verify_near({"sand column", "cells of r/12", "run-out over the radius"}, 2.13, run_out(12, 0.5),
              0.2);
  keep_number({"sand column", "cells of r/12, friction of the floor 1", "run-out over the radius"},
              run_out(12, 1));
}

}  // namespace
