/// Impulses of snow on colliders: sums over steps, forces and torques.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/meshes.h"
#include "tests/support/rest.h"
#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

struct LoadCase {
  Method method;
  std::string name;
};

std::vector<LoadCase> load_cases() {
  std::vector<LoadCase> cases;
  for (const ContactAt contact_at : {ContactAt::nodes, ContactAt::particles})
    for (const double beta : {0.0, 1.0})
      for (Method method : {flip_cubic(), mls_quadratic()}) {
        method.contact_at = contact_at;
        method.beta = beta;
        cases.push_back(
            {method, std::string(contact_at == ContactAt::nodes ? "nodes" : "particles") +
                         (beta > 0 ? ", semi-implicit" : ", explicit") +
                         (method.transfer == Transfer::flip ? ", FLIP" : ", MLS")});
      }
  return cases;
}

/// Force on the first collider over the next seconds, N.
ColliderLoad mean_load(Simulation& simulation, double seconds) {
  const AdvanceReport report = simulation.advance_to(simulation.time() + seconds);
  EXPECT_NEAR(report.seconds, seconds, 1e-9);
  ColliderLoad load = report.loads.at(0);
  load.impulse /= report.seconds;
  load.angular_impulse /= report.seconds;
  return load;
}

/// The snow lies on a box whose centre is beside the middle of the block: the weight turns it.
TEST(Loads, SnowAtRestPressesWithItsWeight) {
  for (const LoadCase& c : load_cases()) {
    SCOPED_TRACE(c.name);
    const RestingPlace place = tilted_place(0.3, 0);
    shapes::Collider box;
    const Vec3d aside(0.05, -0.2, -0.03);
    box.shape.form = shapes::Box{place.point + aside, {0.6, 0.4, 0.6}};
    box.friction = 0.5;
    Simulation simulation(rest_settings(c.method), {Material{}}, {box}, block_at(place, 0.1), 1);
    simulation.advance_to(0.4);
    const ColliderLoad load = mean_load(simulation, 0.1);
    const Summary s = simulation.summary();
    const Vec3d weight = s.mass * Vec3d(0, -9.81, 0);
    // It still moves by a hundredth of its weight, and rocks on its edges.
    EXPECT_LE((load.impulse - weight).norm(), 0.01 * weight.norm());
    const Vec3d torque = (s.centre_of_mass - (place.point + aside)).cross(weight);
    EXPECT_LE((load.angular_impulse - torque).norm(), 0.04 * torque.norm());
  }
}

/// Kernels count from the middle of a mesh that is far from its file's origin, the torque does not.
TEST(Loads, TheTorqueOnAMeshIsAboutTheOriginOfItsFile) {
  const TemporaryFolder folder;
  const RestingPlace place = tilted_place(0, 0);
  const Vec3d away(1000, 0, 0);
  const auto load_on = [&](const std::string& name, const Vec3d& shift) {
    folder.write(name, plate_obj({0.6, 0.4, 0.6}, 1, [&](double) { return shift; }));
    shapes::Collider box;
    box.shape.form =
        shapes::Mesh{(folder / name).string(), 1, place.point - Vec3d(0, 0.2, 0) - shift};
    Simulation simulation(rest_settings(flip_cubic()), {Material{}}, {box}, block_at(place, 0.1),
                          1);
    return mean_load(simulation, 0.02);
  };
  const ColliderLoad near = load_on("near.obj", Vec3d::Zero()), far = load_on("far.obj", away);
  ASSERT_LT(near.impulse.y(), -0.1);
  EXPECT_LT((far.impulse - near.impulse).norm(), 1e-3 * near.impulse.norm());
  const Vec3d expected = near.angular_impulse + away.cross(far.impulse);
  EXPECT_LT((far.angular_impulse - expected).norm(), 1e-5 * expected.norm());
}

/// Colliders get the momentum that snow loses. The bound is relative to the impulses: rounding of
/// some hundred sums of particles' momenta.
TEST(Loads, MomentumCloses) {
  for (const Precision precision : {Precision::real64, Precision::single})
    for (LoadCase c : load_cases()) {
      SCOPED_TRACE(c.name + (precision == Precision::single ? ", float" : ", double"));
      c.method.precision = precision;
      SolverSettings s = rest_settings(c.method);
      s.push_out = true;
      // The residual of a solve acts as a force that nobody counts.
      s.solve_tolerance = precision == Precision::single ? 1e-5 : 1e-9;
      s.solve_iterations = 500;
      shapes::Collider paddle;
      paddle.shape.form = shapes::Box{{-0.14, 0.1, 0}, {0.06, 0.5, 0.5}};
      paddle.velocity = {2, 0, 0.3};
      paddle.angular_velocity = {0, 1, 2};
      paddle.friction = 0.4;
      Simulation simulation(s, {Material{}}, {plane({0, 0.007, 0}, {0.1, 1, 0}, 0.5), paddle},
                            ball_of_snow({0, 0.11, 0}, 0.08, 0.01, {-1, -4, 0.5}), 1);
      const Summary before = simulation.summary();
      const AdvanceReport report = simulation.advance_to(0.03);
      ASSERT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
      const Vec3d gained = simulation.summary().momentum - before.momentum;
      Vec3d given = report.seconds * before.mass * s.gravity;
      double size = 0;
      for (const ColliderLoad& load : report.loads) {
        given -= load.impulse;
        size += load.impulse.norm();
      }
      EXPECT_GT(size, 0.5 * before.momentum.norm());
      EXPECT_LE((gained - given).norm(), (precision == Precision::single ? 1e-4 : 1e-6) * size);
    }
}

TEST(Loads, LoadsAreTheSameAtAnyNumberOfThreadsAndAddUp) {
  const auto loads = [](int threads, const std::vector<double>& stops) {
    SolverSettings s;
    s.cell_size = 0.02;
    Simulation simulation(
        s, {Material{}}, {plane({0, 0.005, 0}, {0, 1, 0}, 0.5), plane({0.05, 0, 0}, {-1, 0, 0}, 0)},
        ball_of_snow({0, 0.09, 0}, 0.07, 0.005, {1, -4, 0}), threads);
    AdvanceReport all;
    for (const double time : stops) all.append(simulation.advance_to(time));
    return all;
  };
  const AdvanceReport one = loads(1, {0.02}), three = loads(3, {0.02});
  ASSERT_EQ(one.loads.size(), 2u);
  EXPECT_LT(one.loads[0].impulse[1], 0);
  EXPECT_GT(one.loads[1].impulse[0], 0);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(one.loads[k].impulse, three.loads[k].impulse);
    EXPECT_EQ(one.loads[k].angular_impulse, three.loads[k].angular_impulse);
  }
  EXPECT_NEAR(loads(1, {0.01, 0.02}).seconds, 0.02, 1e-12);
}

}  // namespace
