/// Spray takes its step without the grid, with the same bits as on it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/engine/load.h"
#include "sim/engine/state_reader.h"
#include "sim/engine/step.h"
#include "sim/laws/list.h"
#include "tests/support/simd_levels.h"
#include "tests/support/snow.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

constexpr double h = 0.01;

/// Particles at random in a cube, and some of them with company in their cell.
ParticleArrays cloud(std::size_t count, double cells_a_side, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-0.5 * cells_a_side * h, 0.5 * cells_a_side * h);
  ParticleArrays p;
  const auto add = [&](const Vec3d& x) {
    p.x.push_back(x);
    p.v.emplace_back(0, 0, 0);
    p.V0.push_back(h * h * h / 8);
    p.m.push_back(400 * p.V0.back());
  };
  while (p.x.size() < count) {
    const double x = place(random), y = place(random), z = place(random);
    add({x, y, z});
    for (std::size_t k = random() % 24; k < 4 && p.x.size() < count; ++k)
      add(Vec3d(x, y, z) + 0.05 * h * static_cast<double>(k) * Vec3d(1, -1, 0.5));
  }
  disturb(p, 0.02, 3.0, seed);
  return p;
}

/// A run whose steps may leave the spray off the grid, and the same on it.
template <class Real>
struct Run {
  Run(const SolverSettings& s, const std::vector<Material>& materials,
      const std::vector<shapes::Collider>& colliders, const ParticleArrays& p, bool on_grid,
      int threads)
      : state(s, materials, colliders, threads, sim::Vec3i::Zero()) {
    parts.keeps_spray_on_grid = on_grid;
    StartState start = engine::load(p, state);
    engine::prepare(state, start);
  }
  void step(double dt) {
    engine::FusedDriver<Real>(state, parts, dt).step(false);
    report = state.grid.step_report();
    state.grid.add_loads(state.method.load_unit, loads);
    state.progress.limits.max_speed = report.max_speed;
  }
  std::uint64_t hash() const { return engine::StateReader<Real>(state).state_hash(); }

  engine::State<Real> state;
  engine::StepParts<Real> parts;
  engine::StepReport report{};
  std::vector<ColliderLoad> loads;
};

/// @return share of the particles that were spray, over all steps
template <class Real>
double expect_bits_of_the_grid(const SolverSettings& s, const std::vector<Material>& materials,
                               const std::vector<shapes::Collider>& colliders,
                               const ParticleArrays& p, int steps, double dt, int threads = 2) {
  Run<Real> off(s, materials, colliders, p, false, threads),
      on(s, materials, colliders, p, true, 1);
  double spray = 0;
  for (int k = 0; k < steps; ++k) {
    off.step(dt);
    on.step(dt);
    EXPECT_EQ(off.hash(), on.hash()) << "step " << k;
    EXPECT_EQ(off.report.max_speed, on.report.max_speed);
    EXPECT_EQ(off.report.max_sound_speed, on.report.max_sound_speed);
    EXPECT_EQ(off.report.max_strain_rate, on.report.max_strain_rate);
    EXPECT_EQ(off.report.min_J_P, on.report.min_J_P);
    EXPECT_EQ(off.report.max_J_P, on.report.max_J_P);
    EXPECT_EQ(off.report.contact_work, on.report.contact_work);
    EXPECT_EQ(off.state.progress.limits.max_collider_speed,
              on.state.progress.limits.max_collider_speed);
    for (std::size_t c = 0; c < off.loads.size(); ++c) {
      EXPECT_EQ(off.loads[c].impulse, on.loads[c].impulse);
      EXPECT_EQ(off.loads[c].angular_impulse, on.loads[c].angular_impulse);
    }
    const auto& partition = off.state.particles.partition;
    EXPECT_EQ(partition.reached_node_blocks(off.state.particles.keys),
              on.state.particles.partition.reached_node_blocks(on.state.particles.keys));
    EXPECT_TRUE(on.state.particles.partition.spray().empty());
    for (const kernels::SprayCluster& cluster : partition.spray())
      spray += cluster.count[0] + cluster.count[1];
    if (::testing::Test::HasFailure()) break;
  }
  return spray / (steps * static_cast<double>(p.x.size()));
}

constexpr Transfer transfers[] = {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip,
                                  Transfer::asflip};

SolverSettings spray_settings(Transfer transfer, Kernel kernel) {
  SolverSettings s;
  s.cell_size = h;
  s.transfer = transfer;
  s.kernel = kernel;
  return s;
}

/// So few particles mostly share no nodes, and so many have neighbours of all kinds.
TEST(Spray, SprayHasTheBitsOfTheGrid) {
  const ParticleArrays p = cloud(700, 85);
  at_every_simd_level([&] {
    for (const Transfer transfer : transfers)
      for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic}) {
        SCOPED_TRACE(::testing::Message() << "transfer " << static_cast<int>(transfer) << " kernel "
                                          << static_cast<int>(kernel));
        const SolverSettings s = spray_settings(transfer, kernel);
        EXPECT_GT(expect_bits_of_the_grid<float>(s, {Material{}}, {}, p, 4, 3e-4), 0.5);
        EXPECT_GT(expect_bits_of_the_grid<double>(s, {Material{}}, {}, p, 4, 3e-4), 0.5);
      }
  });
}

TEST(Spray, SprayOfAllDensitiesHasTheBitsOfTheGrid) {
  for (const double side : {12.0, 30.0, 60.0, 300.0})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic}) {
      const ParticleArrays p = cloud(1000, side, static_cast<unsigned>(side));
      expect_bits_of_the_grid<float>(spray_settings(Transfer::flip, kernel), {Material{}}, {}, p,
                                     15, 3e-4);
    }
}

/// Contact at nodes and at particles, with what rests, moves and turns, far away and in the middle.
TEST(Spray, SprayAroundCollidersHasTheBitsOfTheGrid) {
  shapes::Collider ball = plane({0, 0, 0}, {0, 1, 0}, 0.3);
  ball.name = "ball";
  ball.shape.form = shapes::Sphere{{0.1, 0.2, 0}, 0.15};
  ball.velocity = {-2, 1, 0};
  ball.angular_velocity = {0, 30, 10};
  const std::vector<shapes::Collider> colliders{
      plane({0, -0.3, 0}, {0.1, 1, 0}, 0.5),
      plane({-0.5, 0, 0}, {1, 0, 0}, 0, shapes::Contact::sticky), plane({0, 0, -9}, {0, 0, 1}, 0),
      ball};
  const ParticleArrays p = cloud(1200, 100, 8);
  for (const Transfer transfer : transfers)
    for (const bool at_particles : {false, true})
      for (const bool push_out : {false, true}) {
        SolverSettings s = spray_settings(transfer, Kernel::cubic);
        s.contact_at = at_particles ? ContactAt::particles : ContactAt::nodes;
        s.push_out = push_out;
        EXPECT_GT(expect_bits_of_the_grid<float>(s, {Material{}}, colliders, p, 15, 3e-4), 0.2);
      }
}

TEST(Spray, SprayOfSeveralModelsHasTheBitsOfTheGrid) {
  std::vector<Material> materials(5);
  materials[1].model = laws::model::corotated;
  materials[2].model = laws::model::neo_hookean;
  materials[3].model = laws::model::cam_clay;
  materials[4].model = laws::model::sand;
  ParticleArrays p = cloud(1200, 60, 5);
  for (std::size_t q = 0; q < p.x.size(); ++q)
    p.material.push_back(static_cast<std::uint16_t>(q % 7 % 5));
  for (const Transfer transfer : transfers)
    expect_bits_of_the_grid<float>(spray_settings(transfer, Kernel::cubic), materials, {}, p, 8,
                                   3e-4);
}

TEST(Spray, SprayAroundAPeriodHasTheBitsOfTheGrid) {
  const ParticleArrays p = cloud(600, 90, 6);
  for (const sim::Vec3i& period :
       {sim::Vec3i(1, 0, 2), sim::Vec3i(20, 20, 20), sim::Vec3i(0, 9, 4)}) {
    SolverSettings s = spray_settings(Transfer::flip, Kernel::cubic);
    s.period = period;
    expect_bits_of_the_grid<float>(s, {Material{}}, {}, p, 12, 3e-4);
  }
}

/// Far from all others, a particle needs little more than its record.
TEST(Spray, SprayNeedsNoGrid) {
  ParticleArrays p = cloud(1000, 1, 9);
  for (std::size_t q = 0; q < p.x.size(); ++q)
    p.x[q] = 14 * h *
             Vec3d(static_cast<double>(q / 100), static_cast<double>(q / 10 % 10),
                   static_cast<double>(q % 10));
  for (const Transfer transfer : {Transfer::flip, Transfer::mls}) {
    Simulation simulation(spray_settings(transfer, Kernel::cubic), {Material{}}, {}, p, 1);
    for (int k = 0; k < 3; ++k) simulation.step(1e-4);
    EXPECT_LT(simulation.memory_bytes() / p.x.size(), 500u);
    EXPECT_EQ(simulation.summary().grid_blocks, 8 * p.x.size());
  }
}

}  // namespace
