/// Snow on both sides of a wall: how thick a wall keeps it apart.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

constexpr double cell = 0.02;

/// Share of its speed that snow sliding on a wall without friction gives within 50 ms to the snow
/// on the other side.
double dragged(Kernel kernel, Transfer transfer, double cells) {
  SolverSettings s;
  s.cell_size = cell;
  s.kernel = kernel;
  s.transfer = transfer;
  s.gravity.setZero();
  const double top = 0.003, bottom = top - cells * cell, depth = 0.1;
  ParticleArrays p = box_of_snow({-0.1, top, -0.1}, {0.1, top + depth, 0.1}, 0.01);
  for (Vec3d& v : p.v) v = {1, 0, 0};
  const std::size_t upper = p.x.size();
  const ParticleArrays below = box_of_snow({-0.1, bottom - depth, -0.1}, {0.1, bottom, 0.1}, 0.01);
  p.x.insert(p.x.end(), below.x.begin(), below.x.end());
  p.v.insert(p.v.end(), below.v.begin(), below.v.end());
  p.m.insert(p.m.end(), below.m.begin(), below.m.end());
  p.V0.insert(p.V0.end(), below.V0.begin(), below.V0.end());
  shapes::Collider wall;
  wall.name = "wall";
  wall.shape.form = shapes::Box{{0, 0.5 * (top + bottom), 0}, {3, top - bottom, 3}};
  wall.contact = shapes::Contact::slip;
  wall.friction = 0;
  Simulation simulation(s, {Material{}}, {wall}, p, 1);
  simulation.advance_to(0.05);
  const ParticleArrays after = simulation.particles();
  double sum = 0;
  for (std::size_t q = upper; q < after.v.size(); ++q) sum += after.v[q][0];
  return sum / static_cast<double>(after.v.size() - upper);
}

/// Weights of cubic splines reach two cells to each side, those of quadratic ones one and a half,
/// but they are small at their ends: three cells are enough, and two and a half.
TEST(Wall, ThickWallKeepsSnowApart) {
  EXPECT_LT(std::abs(dragged(Kernel::cubic, Transfer::flip, 3)), 1e-3);
  EXPECT_LT(std::abs(dragged(Kernel::quadratic, Transfer::mls, 2.5)), 0.03);
}

/// A thin wall drags snow, as docs/scenes.md says and neve check warns.
TEST(Wall, ThinWallDragsTheSnowOnItsOtherSide) {
  EXPECT_GT(dragged(Kernel::cubic, Transfer::flip, 1), 0.3);
  EXPECT_GT(dragged(Kernel::cubic, Transfer::flip, 2), 0.05);
  EXPECT_GT(dragged(Kernel::quadratic, Transfer::mls, 1), 0.3);
}

}  // namespace
