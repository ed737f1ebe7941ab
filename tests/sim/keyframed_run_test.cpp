/// Runs with colliders on keyframes: saved, changed, and with steps that do not move them.

#include <gtest/gtest.h>

#include <vector>

#include "sim/simulation.h"
#include "tests/support/meshes.h"
#include "tests/support/snow.h"
#include "tests/support/temporary_folder.h"

namespace neve::sim {
namespace {

/// Snow on a floor and a ram that comes down on it, as a mesh.
class KeyframedRun : public testing::Test {
 protected:
  KeyframedRun() {
    settings_.cell_size = 0.04;
    settings_.push_out = true;
    snow_.hardening = 1;  // fixed steps stay stable however it is packed
    sim::shapes::Collider ram;
    ram.name = "ram";
    ram.shape.form = sim::shapes::Mesh{
        folder_.write("ram.obj", test::box_obj({0.4, 0.2, 0.4})).string(), 1, {0, 0.3, 0}};
    ram.keyframes = {{0, std::nullopt, std::nullopt},
                     {0.1, Vec3d(0.02, 0.2, 0), Vec3d(0, 30, 0)},
                     {0.2, std::nullopt, std::nullopt}};
    colliders_ = {test::plane({0, 0.001, 0}, {0, 1, 0}, 0.5), ram};
  }

  Simulation made() const {
    return Simulation(settings_, {snow_}, colliders_,
                      test::box_of_snow({-0.1, 0.01, -0.1}, {0.1, 0.17, 0.1}, 0.02), 2);
  }
  static void step(Simulation& simulation, int count) {
    for (int k = 0; k < count; ++k) simulation.step(5e-4);
  }

  test::TemporaryFolder folder_;
  SolverSettings settings_;
  Material snow_;
  std::vector<sim::shapes::Collider> colliders_;
};

TEST_F(KeyframedRun, KeyframedRunContinuesBitForBitFromASavedState) {
  Simulation whole = made();
  step(whole, 120);
  const std::vector<std::uint8_t> half = whole.save();
  step(whole, 120);
  EXPECT_FALSE(whole.divergence());
  Simulation again = made();
  again.restore(half);
  step(again, 120);
  EXPECT_EQ(again.state_hash(), whole.state_hash());
  Simulation untouched = made();
  colliders_[1].keyframes.clear();
  Simulation still = made();
  step(untouched, 240);
  step(still, 240);
  EXPECT_EQ(untouched.state_hash(), whole.state_hash());
  EXPECT_NE(still.state_hash(), whole.state_hash()) << "the ram never met the snow";
}

TEST_F(KeyframedRun, StepsThatDoNotMoveCollidersDelayThem) {
  Simulation simulation = made();
  step(simulation, 60);
  SolverSettings waiting = settings_;
  waiting.bypass = {Stage::colliders};
  simulation.apply(waiting, {snow_}, colliders_);
  step(simulation, 40);
  const Vec3d held = sim::shapes::pose_at(simulation.colliders()[1], simulation.time()).point;
  EXPECT_LT((held - sim::shapes::pose_at(colliders_[1], 60 * 5e-4).point).norm(), 1e-12);
  simulation.apply(settings_, {snow_}, colliders_);
  step(simulation, 30);
  const Vec3d moved = sim::shapes::pose_at(simulation.colliders()[1], simulation.time()).point;
  EXPECT_LT((moved - sim::shapes::pose_at(colliders_[1], 90 * 5e-4).point).norm(), 1e-12);
  // A saved state also knows how long colliders have waited.
  Simulation again = made();
  again.restore(simulation.save());
  EXPECT_EQ(sim::shapes::pose_at(again.colliders()[1], again.time()).point, moved);
}

TEST_F(KeyframedRun, KeyframedRunTakesOtherKeyframesShapesAndMeshesWhileItRuns) {
  Simulation simulation = made();
  step(simulation, 60);
  std::vector<sim::shapes::Collider> other = colliders_;
  other[1].keyframes = {{0, Vec3d(0.5, 0.5, 0), std::nullopt}};
  simulation.apply(settings_, {snow_}, other);
  EXPECT_EQ(sim::shapes::pose_at(simulation.colliders()[1], simulation.time()).point,
            Vec3d(0.5, 0.5, 0));
  step(simulation, 20);
  other[1].shape.form = sim::shapes::Torus{{0.5, 0.5, 0}, 0.2, 0.08};
  simulation.apply(settings_, {snow_}, other);
  step(simulation, 20);
  other[1].shape.form = sim::shapes::Mesh{
      folder_.write("slab.obj", test::box_obj({0.6, 0.2, 0.6})).string(), 1, {0, 0, 0}};
  simulation.apply(settings_, {snow_}, other);
  step(simulation, 20);
  EXPECT_FALSE(simulation.divergence());
  // Unreadable states change nothing.
  const std::uint64_t before = simulation.state_hash();
  other[1].shape.form = sim::shapes::Mesh{(folder_ / "none.obj").string(), 1, {0, 0, 0}};
  EXPECT_THROW(simulation.apply(settings_, {snow_}, other), ShapeError);
  EXPECT_EQ(simulation.state_hash(), before);
  step(simulation, 5);
  EXPECT_FALSE(simulation.divergence());
}

/// Snow is brought out of the floor also in the step in which another collider, before it in the
/// list, comes into the reach of the lattice, or leaves it.
TEST(PushOut, KnowsCollidersThatComeAndGo) {
  constexpr double dt = 5e-4;
  for (const double way : {5e5, -5e5}) {
    SolverSettings settings;
    settings.push_out = true;
    shapes::Collider passing;
    passing.name = "passing";
    passing.shape.form = shapes::Box{{-1000 - (way > 0 ? way : 0), 0, 0}, {1, 1, 1}};
    passing.velocity = {way / dt, 0, 0};
    Simulation simulation(settings, {Material{}},
                          {passing, test::plane({0, 0.05, 0}, {0, 1, 0}, 0.5)},
                          test::box_of_snow({0, 0, 0}, {0.1, 0.1, 0.1}, 0.01), 1);
    EXPECT_GT(simulation.summary().max_depth, 0.04);
    simulation.step(dt);
    // Slightly less than the tenth of a cell that settings.h promises, and places are floats.
    EXPECT_LT(simulation.summary().max_depth, 0.1 * settings.cell_size) << way;
  }
}

}  // namespace
}  // namespace neve::sim
