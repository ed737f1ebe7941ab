/// Depth of snow in colliders: small by the paper's method, except at fast edges; and what
/// solver.push_out promises for these.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/checks/watch.h"
#include "sim/staged.h"
#include "tests/support/elastic.h"
#include "tests/support/meshes.h"
#include "tests/support/snow.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

constexpr double cell = 0.02;

shapes::Collider obstacle(const std::string& name, const shapes::Shape& shape,
                          double friction = 0.5) {
  shapes::Collider c;
  c.name = name;
  c.shape = shape;
  c.friction = friction;
  return c;
}

struct DeepScene {
  std::string name;
  std::vector<shapes::Collider> colliders;
  ParticleArrays particles;
  double seconds;
  Material snow{};
};

struct Deepest {
  double cells = 0;  ///< at the end of any step that was looked at
  Summary end;
  bool has_diverged = false;
  double energy_ratio = 0;  ///< the largest
};

/// Looking takes longer than a step; what is deep stays so for many steps.
constexpr int steps_between_looks = 7;

/// A step may move colliders by more than a cell, so that there is something to push; contact is at
/// nodes, since particles that are to follow such an edge would be crushed.
SolverSettings with_held_nodes(SolverSettings s = {}) {
  s.transfer = Transfer::flip;
  s.shock_viscosity = 0;
  s.contact_at = ContactAt::nodes;
  s.cfl = 2;
  return s;
}

Deepest run_deep(const DeepScene& scene, SolverSettings s, bool push_out) {
  s.cell_size = cell;
  s.push_out = push_out;
  Simulation simulation(s, {scene.snow}, scene.colliders, scene.particles, 1);
  Deepest found;
  while (simulation.time() < scene.seconds && !simulation.divergence()) {
    for (int k = 0; k < steps_between_looks && simulation.time() < scene.seconds; ++k)
      simulation.step(simulation.choose_dt(scene.seconds - simulation.time()).dt);
    found.end = simulation.summary();
    found.cells = std::max(found.cells, found.end.max_depth / cell);
    found.energy_ratio = std::max(found.energy_ratio, energy_account(simulation).ratio());
  }
  found.has_diverged = simulation.divergence().has_value();
  return found;
}

/// 8 m/s against a plate of two cells, the least that neve check does not warn about.
DeepScene fast_ball() {
  const shapes::Box plate{{0, -0.02, 0}, {0.6, 2 * cell, 0.6}};
  return {"fast ball, thin plate",
          {obstacle("plate", {plate, {0, 0, 0}})},
          ball_of_snow({0, 0.085, 0}, 0.08, cell / 2, {1, -8, 0}),
          0.03};
}

DeepScene corner() {
  return {"ball into a corner",
          {plane({0, 0, 0}, {0, 1, 0}, 0.3), plane({0.1, 0, 0}, {-1, 0, 0}, 0.3),
           obstacle("wall", {shapes::Box{{0, 0.2, 0.2}, {0.6, 0.6, 0.2}}, {0, 10, 0}})},
          ball_of_snow({0, 0.1, 0}, 0.08, cell / 2, {4, -4, 4}),
          0.06};
}

DeepScene plough() {
  shapes::Collider blade =
      obstacle("blade", {shapes::Box{{-0.2, 0.08, 0}, {0.04, 0.16, 0.4}}, {0, 25, -20}}, 0.2);
  blade.keyframes = {{0, std::nullopt, std::nullopt},
                     {0.15, Vec3d(0.1, 0.08, 0), Vec3d(0, 40, -20)}};
  return {"moving plough",
          {plane({0, 0.001, 0}, {0, 1, 0}, 0.5), blade},
          box_of_snow({-0.12, 0.002, -0.1}, {0.12, 0.08, 0.1}, cell / 2),
          0.15};
}

DeepScene press() {
  shapes::Collider upper =
      obstacle("upper", {shapes::Cylinder{{0, 0.15, 0}, 0.2, 0.06}, {0, 0, 0}});
  upper.keyframes = {{0, Vec3d(0, 0.15, 0), std::nullopt}, {0.12, Vec3d(0, 0.10, 0), std::nullopt}};
  shapes::Collider lower =
      obstacle("lower", {shapes::Box{{0, -0.03, 0}, {0.4, 0.06, 0.4}}, {0, 0, 0}});
  lower.keyframes = {{0, Vec3d(0, -0.03, 0), std::nullopt},
                     {0.12, Vec3d(0, -0.01, 0), std::nullopt}};
  return {"closing press",
          {upper, lower},
          box_of_snow({-0.08, 0.004, -0.08}, {0.08, 0.115, 0.08}, cell / 2),
          0.12};
}

/// A drum with two paddles through its axis, snow falling on it, and a ring that snow gets through.
DeepScene drum() {
  const Vec3d spin(0, 0, -12);
  shapes::Collider drum =
      obstacle("drum", {shapes::Cylinder{{0, 0, 0}, 0.1, 0.3}, {90, 0, 0}}, 0.8);
  shapes::Collider paddles =
      obstacle("paddles", {shapes::Box{{0, 0, 0}, {0.32, 0.045, 0.3}}, {0, 0, 0}}, 0.8);
  drum.angular_velocity = paddles.angular_velocity = spin;
  return {
      "spinning drum",
      {drum, paddles, obstacle("ring", {shapes::Torus{{0, -0.2, 0}, 0.15, 0.04}, {0, 0, 0}}),
       obstacle("cone", {shapes::Cone{{0.22, -0.1, 0}, 0.08, 0.2}, {0, 0, 20}}),
       obstacle("bar", {shapes::Capsule{{-0.22, 0, -0.1}, {-0.18, 0.02, 0.1}, 0.04}, {0, 0, 0}})},
      box_of_snow({-0.06, 0.17, -0.06}, {0.06, 0.27, 0.06}, cell / 2),
      0.3};
}

/// No node is in the edge before particles are, and soft snow takes long steps: it gets in at full
/// speed, a good part of a cell in one step.
DeepScene quick_edge() {
  shapes::Collider edge = obstacle("edge", {shapes::Box{{0, 0.2, 0}, {0.1, 0.1, 0.4}}, {0, 0, 45}});
  edge.velocity = {0, -30, 0};
  DeepScene scene{"edge at 30 m/s in soft snow",
                  {edge},
                  box_of_snow({-0.1, 0, -0.06}, {0.1, 0.12, 0.06}, cell / 2),
                  0.006};
  scene.snow.youngs_modulus = 5e3;
  scene.snow.max_hardening = 30;  // or steps look ahead, and the edge moves by a third of a cell
  return scene;
}

TEST(Depth, DepthIsAtMostATenthOfACell) {
  for (const DeepScene& scene : {fast_ball(), corner(), plough(), press(), drum()}) {
    SCOPED_TRACE(scene.name);
    const Deepest held = run_deep(scene, with_held_nodes(), false);
    EXPECT_FALSE(held.has_diverged);
    for (const Transfer transfer : {Transfer::flip, Transfer::aflip, Transfer::asflip}) {
      SolverSettings s;
      s.transfer = transfer;
      const Deepest found = run_deep(scene, s, false);
      EXPECT_FALSE(found.has_diverged);
      EXPECT_LT(found.energy_ratio, health::limits_of(health::Law::energy).stop);
      const std::string by = transfer == Transfer::flip ? "" : ", " + name(transfer);
      verify_at_most({"depth in colliders", scene.name + ", contact at particles" + by, "cells"},
                     0.1, found.cells);
    }
    verify_at_most({"depth in colliders", scene.name + ", the paper's method", "cells"}, 0.1,
                   held.cells);
  }
}

TEST(Depth, DepthOfAQuickEdgeIsATenthOfACellWithPushOut) {
  const DeepScene scene = quick_edge();
  const Deepest paper = run_deep(scene, with_held_nodes(), false),
                pushed = run_deep(scene, with_held_nodes(), true);
  EXPECT_FALSE(paper.has_diverged || pushed.has_diverged);
  verify_at_most({"depth in colliders", scene.name + ", push_out", "cells"}, 0.1, pushed.cells);
  // The depth is stated so that it can be read, and to know that there is something to push.
  verify_at_most({"depth in colliders", scene.name + ", the paper's method", "cells"}, 0.5,
                 paper.cells);
  EXPECT_GT(paper.cells, 0.15);
  // Nothing is gained: the watch allows 1.1.
  EXPECT_LT(pushed.energy_ratio, health::limits_of(health::Law::energy).stop);
}

TEST(Depth, NoParticlePassesTheThinPlate) {
  SolverSettings s;
  s.cell_size = cell;
  s.push_out = true;
  const DeepScene scene = fast_ball();
  Simulation simulation(s, {Material{}}, scene.colliders, scene.particles, 2);
  simulation.advance_to(scene.seconds);
  const double middle = -cell;
  for (const Vec3d& x : simulation.particles().x) {
    const bool is_over_plate = x.cwiseAbs().maxCoeff() < 0.25;
    EXPECT_TRUE(!is_over_plate || x.y() > middle) << x.transpose();
  }
}

TEST(Depth, DepthIsTheSameInEveryDriverTransferAndPrecision) {
  for (const Transfer transfer :
       {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip})
    for (const Precision precision : {Precision::single, Precision::real64}) {
      SolverSettings s = with_held_nodes();
      s.transfer = transfer;
      s.precision = precision;
      s.kernel = transfer == Transfer::mls ? Kernel::quadratic : Kernel::cubic;
      s.advect = transfer == Transfer::apic ? Advect::pic : Advect::particle;
      EXPECT_LE(run_deep(quick_edge(), s, true).cells, 0.1);
      s.resting_mass = 1e-300;  // takes the staged driver, and leaves every node as it is
      EXPECT_LE(run_deep(quick_edge(), s, true).cells, 0.1);
    }
  SolverSettings implicit;
  implicit.beta = 1;
  EXPECT_LE(run_deep(quick_edge(), implicit, true).cells, 0.1);
}

TEST(Depth, StagedAndFusedStepsPushAlike) {
  SolverSettings s = with_held_nodes();
  s.cell_size = cell;
  s.push_out = true;
  const DeepScene scene = quick_edge();
  Simulation simulation(s, {scene.snow}, scene.colliders, scene.particles, 1);
  bool has_pushed = false;
  for (int k = 0; k < 30; ++k) {
    const double dt = simulation.choose_dt(1).dt;
    const StagedStep looked = staged_step(simulation, dt);
    SolverSettings off = s;
    off.push_out = false;
    Simulation paper(off, {scene.snow}, scene.colliders, scene.particles, 1);
    paper.restore(simulation.save());
    paper.step(dt);
    simulation.step(dt);
    EXPECT_EQ(looked.state_hash, simulation.state_hash());
    has_pushed = has_pushed || paper.state_hash() != simulation.state_hash();
    // Only places differ: neither velocity nor deformation was touched.
    EXPECT_EQ(paper.summary().kinetic_energy, simulation.summary().kinetic_energy);
    EXPECT_EQ(paper.summary().elastic_energy, simulation.summary().elastic_energy);
  }
  EXPECT_TRUE(has_pushed);
}

/// A block that was put far inside the floor is let out slowly, in every transfer: at the speed
/// with which a tenth of a cell would be, 5 cells a second, however deep it lies. It was thrown out
/// at 25 m/s. 8 cells a second are allowed for the elastic quiver of its lowest layer.
TEST(Depth, SnowThatBeginsInsideIsNotThrownOut) {
  for (const Transfer transfer :
       {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::asflip}) {
    SolverSettings s;
    s.cell_size = cell;
    s.transfer = transfer;
    s.kernel = transfer == Transfer::mls ? Kernel::quadratic : Kernel::cubic;
    shapes::Plane floor;
    floor.point = {0, 0.5, 0};
    const ParticleArrays p = lattice({-0.1, 0, -0.1}, {0.1, 0.2, 0.1}, {20, 20, 20}, 400);
    Simulation simulation(s, {Material{}}, {obstacle("floor", {floor, {0, 0, 0}})}, p, 1);
    simulation.advance_to(0.05);
    const Summary now = simulation.summary();
    EXPECT_FALSE(simulation.divergence());
    EXPECT_LE(now.max_speed, 8 * cell) << static_cast<int>(transfer);
    EXPECT_NEAR(now.max_depth, 0.5 - 0.005 - 5 * cell * 0.05, 0.1 * cell)
        << static_cast<int>(transfer);
  }
}

TEST(Depth, DepthOfPlacedParticlesIsTheirDistance) {
  const TemporaryFolder folder;
  const shapes::Mesh mesh{folder.write("box.obj", box_obj({0.4, 0.4, 0.4})).string(), 1, {2, 0, 0}};
  ParticleArrays p;
  for (const double x : {0.3, 0.45, 1.85}) {
    p.x.emplace_back(x, 0.013, 0.002);
    p.v.emplace_back(0, 0, 0);
    p.m.push_back(1e-3);
    p.V0.push_back(1e-6);
  }
  SolverSettings s;
  s.cell_size = cell;
  const std::vector<shapes::Collider> both{
      obstacle("ball", {shapes::Sphere{{0, 0, 0}, 0.4}, {0, 0, 0}}),
      obstacle("mesh", {mesh, {0, 0, 0}})};
  const auto depth = [&](const ParticleArrays& particles) {
    return Simulation(s, {Material{}}, both, particles, 1).summary().max_depth;
  };
  // Float places: 6e-8 of a cell. The ball's is the deepest, then that of the mesh, 0.05 inside.
  EXPECT_NEAR(depth(p), 0.4 - p.x[0].norm(), 1e-8);
  p.x[0].x() = 1;
  EXPECT_NEAR(depth(p), 0.05, 1e-7);
  p.x[2].x() = 1.5;
  EXPECT_EQ(depth(p), 0);
  EXPECT_FALSE(std::signbit(depth(p))) << "run.json would say -0.0";
}

/// A block on the level top of what has one, gravity leaning as in SlidingBlock, on other shapes.
double acceleration_on(const shapes::Shape& shape, double degrees, double friction,
                       shapes::Contact contact) {
  const double angle = degrees * M_PI / 180;
  SolverSettings s;
  s.cell_size = 0.05;
  s.precision = Precision::real64;
  s.transfer = Transfer::flip;
  s.flip_reference_dt = 0;
  s.gravity = 9.81 * Vec3d(std::sin(angle), -std::cos(angle), 0);
  const ParticleArrays p = lattice({-0.1, 0, -0.1}, {0.1, 0.1, 0.1}, {8, 4, 8}, 400);
  shapes::Collider c = obstacle("top", shape, friction);
  c.contact = contact;
  Simulation simulation(s, {elastic(2e5, 0.2, 400)}, {c}, p, 1);
  double n = 0, t1 = 0, t2 = 0, v1 = 0, tv = 0;
  for (int step = 1; step <= 1000; ++step) {
    simulation.step(4e-4);
    if (step < 250 || step % 5 != 0) continue;
    const double t = simulation.time();
    const Summary now = simulation.summary();
    const double v = now.momentum[0] / now.mass;
    n += 1, t1 += t, t2 += t * t, v1 += v, tv += t * v;
  }
  return (n * tv - t1 * v1) / (n * t2 - t1 * t1);
}

TEST(SlidingBlock, SlidingBlockHasTheSameFrictionOnEveryFlatTop) {
  const TemporaryFolder folder;
  const std::string file = folder.write("box.obj", box_obj({4, 0.4, 4})).string();
  // All end where the block touches them: see SlidingBlock. Turned upside down, a cone's
  // base is up; a box lies on its side.
  const double top = 0.0625 * 0.05;
  const std::vector<std::pair<std::string, shapes::Shape>> shapes{
      {"box", {shapes::Box{{0, top - 2, 0}, {4, 3, 4}}, {0, 0, 90}}},
      {"cylinder", {shapes::Cylinder{{0, top - 0.2, 0}, 2, 0.4}, {0, 33, 0}}},
      {"cone", {shapes::Cone{{0, top - 1, 0}, 3, 2}, {180, 0, 0}}},
      {"mesh", {shapes::Mesh{file, 1, {0, 1e-7 - 0.2, 0}}, {0, 0, 0}}}};
  const double degrees = 30, mu = 0.4, t = degrees * M_PI / 180;
  const double exact = 9.81 * (std::sin(t) - mu * std::cos(t));
  for (const auto& [name, shape] : shapes) {
    // The bounce of the block on its own elasticity is all that is left, as on planes.
    verify_near({"incline", "30°, mu = 0.4, on a " + name + ", FLIP, double", "acceleration, m/s²"},
                exact, acceleration_on(shape, degrees, mu, shapes::Contact::separate), 1e-3);
  }
  EXPECT_NEAR(acceleration_on(shapes[1].second, degrees, 0.9, shapes::Contact::slip),
              9.81 * std::sin(t), 1e-3);
  EXPECT_NEAR(acceleration_on(shapes[1].second, degrees, 0, shapes::Contact::sticky), 0, 1e-3);
}

}  // namespace
