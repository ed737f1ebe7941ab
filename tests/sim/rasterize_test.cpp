/// Pictures show the grid that the steps rasterise, and rasterising for them changes nothing.

#include "sim/rasterize.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "sim/staged.h"
#include "tests/support/snow.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

constexpr double cube_cell = 0.02;

ParticleArrays moving_cube() {
  ParticleArrays in = box_of_snow(Vec3d(0, 0, 0), Vec3d(0.1, 0.1, 0.1), cube_cell / 2);
  for (std::size_t p = 0; p < in.x.size(); ++p)
    in.v[p] = Vec3d(1, -2, 0.5) + in.x[p].cross(Vec3d(3, 1, -2));
  return in;
}

Simulation simulation_of(Transfer transfer, Precision precision, const ParticleArrays& in) {
  SolverSettings settings;
  settings.cell_size = cube_cell;
  settings.transfer = transfer;
  settings.precision = precision;
  return Simulation(settings, {Material{}}, {}, in, 2);
}

using Node = std::array<int, 3>;

std::map<Node, std::size_t> index_of(const RasterizedNodes& nodes) {
  std::map<Node, std::size_t> index;
  for (std::size_t b = 0; b < nodes.block.size(); ++b)
    for (int n = 0; n < 64; ++n)
      index[{4 * nodes.block[b].x() + n / 16, 4 * nodes.block[b].y() + n / 4 % 4,
             4 * nodes.block[b].z() + n % 4}] = 64 * b + static_cast<std::size_t>(n);
  return index;
}

class RasterizeTest : public testing::TestWithParam<std::tuple<Transfer, Precision>> {};

TEST_P(RasterizeTest, RasterizeGivesTheGridOfTheStagedStep) {
  const auto [transfer, precision] = GetParam();
  Simulation simulation = simulation_of(transfer, precision, moving_cube());
  for (int k = 0; k < 3; ++k) simulation.step(1e-4);
  const std::uint64_t before = simulation.state_hash();
  const RasterizedNodes nodes = rasterize(simulation);
  EXPECT_EQ(simulation.state_hash(), before);
  EXPECT_EQ(nodes.spacing, cube_cell);

  // The staged step starts from the same particles with the same transfer, in the same order of
  // storage (a sort comes with step 32 only): the same bits.
  const StagedStep step = staged_step(simulation, 1e-4);
  const auto index = index_of(nodes);
  std::size_t with_mass = 0;
  for (const double m : nodes.mass) with_mass += m > 0;
  ASSERT_EQ(with_mass, step.nodes.node.size());
  for (std::size_t n = 0; n < step.nodes.node.size(); ++n) {
    const neve::sim::Vec3i at = step.nodes.node[n];
    const auto found = index.find({at.x(), at.y(), at.z()});
    ASSERT_NE(found, index.end());
    EXPECT_EQ(nodes.mass[found->second], step.nodes.mass[n]);
    // v_old is divided in the precision of the run, the velocity here in double.
    const double rounding = precision == Precision::single ? 1e-6 : 1e-14;
    EXPECT_LT((nodes.velocity[found->second] - step.nodes.v_old[n]).norm(), 10 * rounding);
  }
}

TEST_P(RasterizeTest, MeansArePartitionsOfTheParticles) {
  const auto [transfer, precision] = GetParam();
  const ParticleArrays in = moving_cube();
  const Simulation simulation = simulation_of(transfer, precision, in);
  const std::size_t count = in.x.size();
  std::vector<std::vector<double>> values(4, std::vector<double>(count, 2.5));
  double moment = 0, mass = 0;
  for (std::size_t p = 0; p < count; ++p) {
    values[3][p] = 1 + 0.001 * static_cast<double>(p % 97);
    moment += in.m[p] * values[3][p];
    mass += in.m[p];
  }
  const RasterizedNodes nodes = rasterize(simulation, values);
  ASSERT_EQ(nodes.mean.size(), 4u);
  // Single precision adds 8^3 numbers per node: some tens of roundings of 6e-8.
  const double rounding = precision == Precision::single ? 3e-6 : 1e-13;
  double rasterized_moment = 0, rasterized_mass = 0;
  for (std::size_t n = 0; n < nodes.mass.size(); ++n) {
    if (nodes.mass[n] == 0) continue;
    EXPECT_NEAR(nodes.mean[0][n], 2.5, 2.5 * rounding);
    EXPECT_NEAR(nodes.mean[2][n], 2.5, 2.5 * rounding);
    rasterized_moment += nodes.mass[n] * nodes.mean[3][n];
    rasterized_mass += nodes.mass[n];
  }
  EXPECT_NEAR(rasterized_mass, mass, mass * rounding);
  EXPECT_NEAR(rasterized_moment, moment, moment * rounding);
}

INSTANTIATE_TEST_SUITE_P(All, RasterizeTest,
                         testing::Combine(testing::Values(Transfer::flip, Transfer::apic,
                                                          Transfer::mls, Transfer::aflip),
                                          testing::Values(Precision::single, Precision::real64)));

TEST(Rasterize, BlocksAreSortedAndAroundTheParticles) {
  const Simulation simulation = simulation_of(Transfer::flip, Precision::single, moving_cube());
  const RasterizedNodes nodes = rasterize(simulation);
  ASSERT_FALSE(nodes.block.empty());
  ASSERT_EQ(nodes.mass.size(), 64 * nodes.block.size());
  const auto key = [](const neve::sim::Vec3i& b) { return Node{b.x(), b.y(), b.z()}; };
  for (std::size_t b = 1; b < nodes.block.size(); ++b)
    EXPECT_LT(key(nodes.block[b - 1]), key(nodes.block[b]));
}

TEST(Rasterize, NoParticlesGiveNoBlocksAndLengthsAreChecked) {
  const Simulation empty = simulation_of(Transfer::flip, Precision::single, {});
  EXPECT_TRUE(rasterize(empty).block.empty());
  const Simulation snow = simulation_of(Transfer::flip, Precision::single, moving_cube());
  EXPECT_THROW(rasterize(snow, {{1.0, 2.0}}), std::invalid_argument);
}

/// Particles on one lattice fill space evenly, whatever they weigh. Beside other densities, the
/// light ones got 0.44 of their volume and the heavy ones 1.7 times theirs.
TEST(EstimatedVolumes, DoNotDependOnTheDensityOfNeighbours) {
  constexpr double spacing = cube_cell / 2;
  ParticleArrays in = box_of_snow(Vec3d(-0.14, -0.14, -0.14), Vec3d(0.14, 0.14, 0.14), spacing);
  for (Vec3d& x : in.x) x = spacing * ((x / spacing).array().floor() + 0.5).matrix();
  in.V0.clear();
  in.material.assign(in.x.size(), 0);
  Material snow, sand;
  sand.density = 1500;
  for (std::size_t p = 0; p < in.x.size(); ++p) {
    const bool is_sand = in.x[p].y() < 0;
    in.material[p] = is_sand;
    in.m[p] = spacing * spacing * spacing * (is_sand ? sand.density : snow.density);
  }
  for (const Precision precision : {Precision::single, Precision::real64}) {
    SolverSettings settings;
    settings.cell_size = cube_cell;
    settings.precision = precision;
    const ParticleArrays out = Simulation(settings, {snow, sand}, {}, in, 2).particles();
    int inside = 0;
    for (std::size_t p = 0; p < out.x.size(); ++p) {
      if (out.x[p].cwiseAbs().maxCoeff() > 0.05) continue;
      ++inside;
      // A lattice of two particles to a cell is even on the grid but for rounding.
      EXPECT_NEAR(out.V0[p] / std::pow(spacing, 3), 1, 1e-5) << out.x[p].transpose();
    }
    EXPECT_GT(inside, 500);
  }
}

}  // namespace
