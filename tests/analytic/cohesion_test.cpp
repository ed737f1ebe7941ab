/// Numerical cohesion: a block that leaves another takes it along, over a gap that the grid does
/// not see.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/support/elastic.h"
#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

constexpr double gap_cell = 0.02;

/// Velocity of a block at rest after another has left it, in units of the other's at the start:
/// 0.5 where they stay together.
/// @param gap  cells between their particles' cubes at the start
/// @param leaving_speed  m/s
double drag_of(Transfer transfer, Kernel kernel, double gap, double leaving_speed) {
  SolverSettings s;
  s.cell_size = gap_cell;
  s.transfer = transfer;
  s.kernel = kernel;
  s.gravity.setZero();
  const double side = 6 * gap_cell;
  ParticleArrays p = box_of_snow({0, 0, 0}, {side, side, side}, gap_cell / 2);
  const std::size_t count = p.x.size();
  ParticleArrays other = box_of_snow({0, 0, 0}, {side, side, side}, gap_cell / 2, 7);
  for (std::size_t q = 0; q < other.x.size(); ++q) {
    p.x.push_back(other.x[q] + Vec3d(side + gap * gap_cell, 0, 0));
    p.v.push_back({leaving_speed, 0, 0});
    p.m.push_back(other.m[q]);
    p.V0.push_back(other.V0[q]);
  }
  Simulation simulation(s, {Material{}}, {}, p, 1);
  // Those that part are ten cells apart.
  simulation.advance_to(0.2 / leaving_speed);
  EXPECT_FALSE(simulation.divergence());
  const std::vector<Vec3d> v = simulation.particles().v;
  double sum = 0;
  for (std::size_t q = 0; q < count; ++q) sum += v[q][0];
  return sum / static_cast<double>(count) / leaving_speed;
}

/// Fast enough to part: the grid, and what stretches between the blocks, take some of the speed.
TEST(Cohesion, CohesionAcrossAGapIsLeastWithAsflip) {
  for (const double gap : {0.5, 1.0, 1.5, 2.0, 3.0}) {
    std::map<Transfer, double> drag;
    for (const Transfer transfer :
         {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip}) {
      const Kernel kernel = transfer == Transfer::mls ? Kernel::quadratic : Kernel::cubic;
      drag[transfer] = drag_of(transfer, kernel, gap, 1);
      const Quantity q{"cohesion", name(transfer) + ", " + name(kernel), in_digits(gap) + " cells"};
      if (gap == 3)
        verify_near(q, 0, drag[transfer], 1e-3);
      else
        keep_number(q, drag[transfer]);
    }
    if (gap == 3) continue;
    EXPECT_LT(drag[Transfer::asflip], drag[Transfer::flip]) << gap;
    EXPECT_LT(drag[Transfer::asflip], drag[Transfer::aflip]) << gap;
    EXPECT_LT(drag[Transfer::asflip], 0.5 * drag[Transfer::apic]) << gap;
  }
}

/// Slow ones stay together, with any transfer: the snow between them is stretched, but not torn.
TEST(Cohesion, CohesionOfSlowSnowIsThatOfItsStress) {
  for (const Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::asflip})
    verify_near({"cohesion of slow snow", name(transfer) + ", cubic, 1 cell, 0.2 m/s",
                 "share of the speed"},
                0.5, drag_of(transfer, Kernel::cubic, 1, 0.2), 0.1);
}

}  // namespace
