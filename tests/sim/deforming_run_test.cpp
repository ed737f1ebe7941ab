/// Snow on meshes that deform: contact, friction, work, saved states.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/simulation.h"
#include "sim/staged.h"
#include "tests/support/elastic.h"
#include "tests/support/meshes.h"
#include "tests/support/snow.h"
#include "tests/support/temporary_folder.h"

namespace neve::sim {
namespace {

constexpr double cell = 0.04;

struct Way {
  ContactAt contact_at;
  double beta;
  std::string name;
};
const std::vector<Way> ways{{ContactAt::nodes, 0, "nodes, explicit"},
                            {ContactAt::particles, 0, "particles, explicit"},
                            {ContactAt::nodes, 1, "nodes, semi-implicit"},
                            {ContactAt::particles, 1, "particles, semi-implicit"}};

class DeformingRun : public testing::Test {
 protected:
  DeformingRun() {
    settings_.cell_size = cell;
    snow_.hardening = 1;  // stays soft however it is packed
  }

  static shapes::Collider collider(const shapes::MeshSequence& sequence, double friction) {
    shapes::Collider c;
    c.name = "plate";
    c.shape.form = sequence;
    c.friction = friction;
    return c;
  }

  SolverSettings settings_for(const Way& way) const {
    SolverSettings s = settings_;
    s.contact_at = way.contact_at;
    s.beta = way.beta;
    return s;
  }

  Simulation made(const SolverSettings& settings, const shapes::Collider& collider,
                  const ParticleArrays& snow, int threads = 2) const {
    return Simulation(settings, {snow_}, {collider}, snow, threads);
  }

  /// A slab of snow at rest on what ends at height 0.
  static ParticleArrays slab() {
    return test::box_of_snow({-0.2, 0.005, -0.2}, {0.2, 0.125, 0.2}, 0.02);
  }

  test::TemporaryFolder folder_;
  SolverSettings settings_;
  Material snow_;
};

/// A thick plate rises and carries the snow up, once as a rigid mesh with a velocity and once as
/// files of it. Vertices on straight lines are the motion itself, both lattices have their samples
/// half a cell apart, and the plate is flat where the snow is: distances are exact in both. Only
/// rounding of distances to float differs, 1e-7 m of 0.04 m, in contact that switches on and off:
/// thousandths of the impulse after a hundred steps.
TEST_F(DeformingRun, FilesOfARigidMotionAreTheRigidMotion) {
  const Vec3d size(1.3, 0.32, 1.3), velocity(0.3, 0.8, 0);
  const auto sequence = test::written_sequence(folder_, "rigid", 6, 20, [&](int k) {
    return test::plate_obj(size, 3, [&](double) { return Vec3d(k / 20.0 * velocity); });
  });
  shapes::MeshSequence moved = sequence;
  moved.center = {0, -0.16, 0};
  shapes::Collider rigid;
  rigid.friction = 0.5;
  rigid.velocity = velocity;
  rigid.shape.form = shapes::Mesh{(folder_ / "rigid_0000.obj").string(), 1, {0, -0.16, 0}};
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    Simulation by_files = made(settings_for(way), collider(moved, 0.5), slab());
    Simulation by_motion = made(settings_for(way), rigid, slab());
    const AdvanceReport a = by_files.advance_to(0.2), b = by_motion.advance_to(0.2);
    ASSERT_FALSE(by_files.divergence()) << by_files.divergence()->sentence;
    const Summary found = by_files.summary(), expected = by_motion.summary();
    const Vec3d impulse = b.loads.at(0).impulse;
    EXPECT_GT(impulse.norm(), 0.8 * expected.mass * 0.8) << "it was carried up";
    EXPECT_LT((a.loads.at(0).impulse - impulse).norm(), 5e-3 * impulse.norm());
    EXPECT_LT((found.momentum - expected.momentum).norm(), 5e-3 * expected.momentum.norm());
    EXPECT_LT((found.centre_of_mass - expected.centre_of_mass).norm(), 0.02 * cell);
    // The potential of gravity is the same in both.
    const double work = energy_account(by_motion).explained;
    EXPECT_NEAR(energy_account(by_files).explained, work, 5e-3 * work);
  }
}

/// Files of a paddle that turns hold chords of the circle, (w / rate)^2 / 8 of the radius within
/// it: 2e-4 m at the rim, a two-hundredth of a cell. Snow that is pressed into it meets the
/// velocity of the nearest place: less than that of a rigid body by w times the depth, half a cell.
/// That is 5 % of the speed at the rim.
TEST_F(DeformingRun, FilesOfARotationAreNearlyTheRotation) {
  const Vec3d size(0.8, 0.16, 0.8), spin(0, 0, 4);
  shapes::MeshSequence sequence = test::written_sequence(folder_, "turn", 8, 60, [&](int k) {
    return test::box_obj(size, rotation_from_vector(k / 60.0 * spin));
  });
  sequence.center = {0, -0.08, 0};
  shapes::Collider rigid;
  rigid.friction = 0.5;
  rigid.angular_velocity = spin;
  rigid.shape.form = shapes::Mesh{(folder_ / "turn_0000.obj").string(), 1, sequence.center};
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    Simulation by_files = made(settings_for(way), collider(sequence, 0.5), slab());
    Simulation by_motion = made(settings_for(way), rigid, slab());
    const AdvanceReport a = by_files.advance_to(0.1), b = by_motion.advance_to(0.1);
    const Summary found = by_files.summary(), expected = by_motion.summary();
    const Vec3d turned = b.loads.at(0).angular_impulse;
    EXPECT_GT(expected.kinetic_energy, 0.1 * expected.mass);
    EXPECT_NEAR(found.kinetic_energy, expected.kinetic_energy, 0.05 * expected.kinetic_energy);
    EXPECT_LT((a.loads.at(0).angular_impulse - turned).norm(), 0.05 * turned.norm());
    EXPECT_LT((found.centre_of_mass - expected.centre_of_mass).norm(), 0.1 * cell);
  }
}

/// A plate two cells thick that flaps under snow: 0.1 m up and down, twice a second, at up to
/// 1.3 m/s, six times its thickness in half a period of four files.
class FlappingPlate : public DeformingRun {
 protected:
  static constexpr double width = 0.8, thick = 2 * cell, rate = 16;

  static double height(double x, double k) {
    const double along = std::cos(M_PI * x / width);
    return 0.1 * std::sin(2 * M_PI * 2 * k / rate) * along - thick / 2;
  }
  shapes::MeshSequence plate() const {
    return test::written_sequence(folder_, "flap", 10, rate, [&](int k) {
      return test::plate_obj({width, thick, width}, 24,
                             [&](double x) { return Vec3d(0, height(x, k), 0); });
    });
  }
  /// Returns the height of the plate's middle surface; its vertices are on straight lines.
  static double middle_at(double x, double time) {
    const double k = std::min(time * rate, 9.0), first = std::floor(k);
    return height(x, first) +
           (k - first) * (height(x, std::min(first + 1, 9.0)) - height(x, first));
  }
};

TEST_F(FlappingPlate, LetsNoSnowThrough) {
  const shapes::MeshSequence sequence = plate();
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    SolverSettings settings = settings_for(way);
    settings.push_out = true;
    Simulation simulation = made(settings, collider(sequence, 0.6), slab());
    double fastest = 0;
    for (int frame = 1; frame <= 24; ++frame) {
      simulation.advance_to(frame / 40.0);
      ASSERT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
      const ParticleArrays now = simulation.particles();
      std::size_t below = 0;
      for (const Vec3d& x : now.x)
        below += std::abs(x[0]) < width / 2 && x[1] < middle_at(x[0], simulation.time());
      EXPECT_EQ(below, 0u) << "at " << simulation.time() << " s";
      // Positions are floats of cells; push_out leaves a tenth.
      EXPECT_LT(simulation.summary().max_depth, 0.101 * cell);
      for (const Vec3d& v : now.v) fastest = std::max(fastest, v[1]);
    }
    EXPECT_GT(fastest, 0.8) << "it was thrown up";
  }
}

/// The plate gets the momentum that snow loses, as rigid colliders do.
TEST_F(FlappingPlate, GetsTheMomentumThatSnowLoses) {
  const shapes::MeshSequence sequence = plate();
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    SolverSettings settings = settings_for(way);
    settings.precision = Precision::real64;
    settings.solve_tolerance = 1e-9;
    settings.solve_iterations = 500;
    Simulation simulation = made(settings, collider(sequence, 0.6), slab());
    const Summary before = simulation.summary();
    const AdvanceReport report = simulation.advance_to(0.06);
    const Vec3d gained = simulation.summary().momentum - before.momentum;
    const Vec3d given =
        report.seconds * before.mass * settings.gravity - report.loads.at(0).impulse;
    EXPECT_GT(report.loads.at(0).impulse.norm(), before.mass);
    EXPECT_LE((gained - given).norm(), 1e-6 * report.loads.at(0).impulse.norm());
  }
}

/// Elastic snow in weightlessness is thrown by a plate that bulges: its energy is the work of the
/// plate, less what the transfer damps, and never more.
TEST_F(FlappingPlate, DoesTheWorkThatSnowGains) {
  const auto sequence = test::written_sequence(folder_, "bulge", 5, 20, [](int k) {
    return test::plate_obj({width, thick, width}, 24, [&](double x) {
      return Vec3d(0, 0.02 * k * std::cos(M_PI * x / width) - thick / 2, 0);
    });
  });
  snow_ = test::elastic(1e5, 0.2, 400);
  for (const Way& way : ways) {
    if (way.beta > 0) continue;  // its steps damp waves by themselves
    SCOPED_TRACE(way.name);
    SolverSettings settings = settings_for(way);
    settings.gravity.setZero();
    settings.precision = Precision::real64;
    Simulation simulation = made(settings, collider(sequence, 0.2), slab());
    simulation.advance_to(0.25);
    const EnergyAccount account = energy_account(simulation);
    EXPECT_GT(account.explained, 0.02 * simulation.summary().mass);
    EXPECT_LE(account.found, 1.01 * account.explained);
    EXPECT_GE(account.found, 0.6 * account.explained);
  }
}

/// A plate that slides under snow: mu g t, until the snow moves along.
TEST_F(DeformingRun, FrictionOfFilesCarriesSnowAlong) {
  const auto sequence = test::written_sequence(folder_, "belt", 5, 10, [](int k) {
    return test::plate_obj({2, 0.16, 1}, 8, [&](double) { return Vec3d(0.1 * k, -0.08, 0); });
  });
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    const auto speed_after = [&](double friction) {
      Simulation simulation = made(settings_for(way), collider(sequence, friction), slab());
      simulation.advance_to(0.2);
      const Summary s = simulation.summary();
      return s.momentum[0] / s.mass;
    };
    // Snow settles onto the plate in the first hundredths of a second.
    EXPECT_NEAR(speed_after(0.3), 0.3 * 9.81 * 0.2, 0.1 * 0.3 * 9.81 * 0.2);
    if (way.beta > 0) continue;
    // It still rocks on the feet that it was caught by.
    EXPECT_NEAR(speed_after(5), 1, 0.06);
    EXPECT_NEAR(speed_after(0), 0, 1e-3);
  }
}

/// 70 steps pass from a file to the next; the state is saved before.
TEST_F(FlappingPlate, HasTheSameBitsOnAnyThreadsAndFromASavedState) {
  const shapes::MeshSequence sequence = plate();
  const ParticleArrays snow = test::box_of_snow({-0.1, 0.005, -0.1}, {0.1, 0.125, 0.1}, 0.02);
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    const shapes::Collider c = collider(sequence, 0.5);
    const auto step = [](Simulation& simulation, int count) {
      for (int k = 0; k < count; ++k) simulation.step(1e-3);
    };
    Simulation whole = made(settings_for(way), c, snow, 1);
    step(whole, 50);
    const std::vector<std::uint8_t> saved = whole.save();
    step(whole, 20);
    ASSERT_FALSE(whole.divergence());
    Simulation again = made(settings_for(way), c, snow, 3);
    again.restore(saved);
    step(again, 20);
    EXPECT_EQ(again.state_hash(), whole.state_hash());
    Simulation looked = made(settings_for(way), c, snow, 2);
    step(looked, 30);
    staged_step(looked, 1e-3);  // a copy that moves by itself
    step(looked, 40);
    EXPECT_EQ(looked.state_hash(), whole.state_hash());
  }
}

/// Steps that leave colliders where they are leave their shape as well.
TEST_F(FlappingPlate, WaitsWhileStepsDoNotMoveColliders) {
  const shapes::Collider c = collider(plate(), 0.5);
  Simulation simulation = made(settings_, c, slab());
  simulation.advance_to(0.1);
  const auto top = [&] {
    return shapes::bounds_at(simulation.colliders()[0], simulation.time()).max.y();
  };
  const double before = top();
  SolverSettings waiting = settings_;
  waiting.bypass = {Stage::colliders};
  simulation.apply(waiting, {snow_}, {c});
  simulation.advance_to(0.15);
  EXPECT_NEAR(top(), before, 1e-9);
  simulation.apply(settings_, {snow_}, {c});
  simulation.advance_to(0.17);
  EXPECT_NEAR(top(), shapes::bounds_at(c, 0.12).max.y(), 1e-9);
}

TEST_F(FlappingPlate, ShortensTheStepsBySpeedOfItsFastestVertex) {
  const shapes::Collider c = collider(plate(), 0.5);
  // 0.1 m sin(2 pi 2 / 16) in the first sixteenth of a second.
  const double speed = 0.1 * std::sin(2 * M_PI * 2 / rate) * rate;
  EXPECT_NEAR(shapes::largest_speed(c), speed, 1e-9);
  settings_.max_dt = 1;
  const Simulation simulation = made(settings_, c, slab());
  EXPECT_NEAR(simulation.step_limits().dt[static_cast<std::size_t>(DtLimit::collider)],
              settings_.cfl * cell / speed, 1e-9);
}

}  // namespace
}  // namespace neve::sim
