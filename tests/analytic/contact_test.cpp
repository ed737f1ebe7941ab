/// Friction, sticking and slipping on a plane.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/laws/list.h"
#include "tests/support/elastic.h"
#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// Acceleration of an elastic block along a slope, from rest: the slope of a straight line through
/// its mean velocity between 0.1 and 0.4 s, as the reference measures it.
double acceleration_on_slope(Transfer transfer, double degrees, double friction,
                             Precision precision = Precision::real64,
                             ContactAt contact_at = ContactAt::particles) {
  const double angle = degrees * std::numbers::pi / 180;
  SolverSettings s;
  s.cell_size = 0.05;
  s.precision = precision;
  s.transfer = transfer;
  s.contact_at = contact_at;
  s.flip_reference_dt = 0;
  // The plane is level and gravity leans: the same physics, and the block starts aligned.
  s.gravity = 9.81 * Vec3d(std::sin(angle), -std::cos(angle), 0);
  const Material m = elastic(2e5, 0.2, 400);
  const ParticleArrays p = lattice({-0.1, 0, -0.1}, {0.1, 0.1, 0.1}, {8, 4, 8}, 400);
  // The block touches from the start: its particles are a quarter of a cell above y = 0, and touch
  // at 3/8 of their spacing. Nodes on the plane are free, so it lies a little above them.
  const double top = contact_at == ContactAt::particles ? 0.0625 * s.cell_size : 1e-6;
  Simulation simulation(s, {m}, {plane({0, top, 0}, {0, 1, 0}, friction)}, p, 1);
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

double exact_acceleration(double degrees, double friction) {
  const double t = degrees * std::numbers::pi / 180;
  return std::max(0.0, 9.81 * (std::sin(t) - friction * std::cos(t)));
}

/// A block of snow is let down on a slope that friction holds it on, from a millimetre above where
/// it touches. It slides while it bounces on its own elasticity, and stays when that has died away:
/// friction is bounded by the impulse along the normal, which rattling snow has no less of on
/// average.
TEST(SlidingBlock, BelowTheAngleOfFrictionABlockThatIsLetDownComesToRest) {
  const double angle = 24 * std::numbers::pi / 180, mu = 0.5;  // up to 26.6 degrees
  for (const Transfer transfer :
       {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip}) {
    SolverSettings s;
    s.cell_size = 0.02;
    s.transfer = transfer;
    s.gravity = 9.81 * Vec3d(std::sin(angle), -std::cos(angle), 0);
    const double touching = 0.375 * s.cell_size / 2;
    const Vec3d low{0.003, touching + 0.001, 0.005}, high = low + Vec3d(0.2, 0.2, 0.2);
    Simulation simulation(s, {Material{}}, {plane({0, 0, 0}, {0, 1, 0}, mu)},
                          box_of_snow(low, high, s.cell_size / 2), 1);
    const auto place_at = [&](double time) {
      simulation.advance_to(time);
      return 1e3 * simulation.summary().centre_of_mass[0];
    };
    const double start = simulation.summary().centre_of_mass[0] * 1e3;
    const double middle = place_at(0.5), end = place_at(1);
    const std::string line = "block let down on 24°, mu = 0.5, " + name(transfer);
    keep_number({"incline", line, "way in the first half second, mm"}, middle - start);
    // The last of its swinging, by rounding; a block that hops on would slide by 15 mm.
    verify_near({"incline", line, "way in the second, mm"}, 0, end - middle, 0.5);
  }
}

/// One particle comes down through loose snow that rests on the floor. The floor takes what it
/// comes with: it must not throw back the snow around it, which got 13 times its energy. Without
/// friction of the grid flip keeps its energy to rounding, which is of what it began with; aflip
/// and asflip gain a few per cent while the particle flies.
TEST(LooseSnow, WhatComesThroughItToTheFloorThrowsNothingBack) {
  for (const Transfer transfer : {Transfer::flip, Transfer::aflip, Transfer::asflip}) {
    SolverSettings s;
    s.cell_size = 0.05;
    s.transfer = transfer;
    s.gravity = {0, 0, 0};
    s.flip_ratio = 1;
    ParticleArrays p = lattice({-0.1, 0, -0.1}, {0.1, 0.05, 0.1}, {8, 2, 8}, 400);
    const auto is_lower = [](const Vec3d& a, const Vec3d& b) {
      return a.y() + a.norm() < b.y() + b.norm();
    };
    const auto lowest = std::min_element(p.x.begin(), p.x.end(), is_lower);
    p.v[static_cast<std::size_t>(lowest - p.x.begin())] = {0.6, -3, 0};
    Simulation simulation(s, {Material{}}, {plane({0, 0.003, 0}, {0, 1, 0}, 0.4)}, p, 1);
    const double start = simulation.summary().kinetic_energy;
    const double gain = transfer == Transfer::flip ? 1e-6 : 0.05;
    for (int step = 0; step < 20; ++step) {
      simulation.step(1e-4);
      const Summary now = simulation.summary();
      EXPECT_LE(now.kinetic_energy + now.elastic_energy, start * (1 + gain))
          << static_cast<int>(transfer) << " in step " << step;
    }
  }
}

TEST(SlidingBlock, SlidingBlockAcceleratesByGravityLessFriction) {
  // a = g (sin t - mu cos t), 0 where mu >= tan t. The reference meets it within 2e-4; the bounce
  // of the block on its own elasticity is what is left.
  const double cases[][2] = {{30, 0}, {30, 0.2}, {30, 0.4}, {30, 0.7}, {20, 0.3}};
  for (const auto& [degrees, mu] : cases) {
    const std::string slope = in_digits(degrees) + "°, mu = " + in_digits(mu);
    for (const Transfer transfer : {Transfer::flip, Transfer::apic}) {
      if (transfer == Transfer::apic && mu < 0.4) continue;
      verify_near({"incline", slope + ", " + name(transfer) + ", double", "acceleration, m/s²"},
                  exact_acceleration(degrees, mu), acceleration_on_slope(transfer, degrees, mu),
                  1e-3);
    }
  }
  // Float: velocities of 1 m/s known to 1e-7, 1000 steps.
  verify_near({"incline", "30°, mu = 0.4, FLIP, float", "acceleration, m/s²"},
              exact_acceleration(30, 0.4),
              acceleration_on_slope(Transfer::flip, 30, 0.4, Precision::single), 2e-3);
  verify_near({"incline", "30°, mu = 0.4, FLIP, double, held nodes", "acceleration, m/s²"},
              exact_acceleration(30, 0.4),
              acceleration_on_slope(Transfer::flip, 30, 0.4, Precision::real64, ContactAt::nodes),
              1e-3);
}

TEST(StickyFloor, StickyFloorBringsSnowToRest) {
  SolverSettings s;
  s.cell_size = 0.03;
  Simulation simulation(s, {Material{}},
                        {plane({0, 0.003, 0}, {0, 1, 0}, 0, shapes::Contact::sticky)},
                        ball_of_snow({0, 0.14, 0}, 0.12, 0.02, {1, -3, 0}), 1);
  simulation.advance_to(1.2);
  const Summary end = simulation.summary();
  EXPECT_FALSE(simulation.divergence());
  // The reference finds the same. The ball does not rebound: it ends lower than it was thrown from.
  verify_at_most({"contact", "snowball on a sticky floor", "rms speed after 1.2 s, m/s"}, 0.05,
                 std::sqrt(2 * end.kinetic_energy / end.mass));
  verify_at_most({"contact", "snowball on a sticky floor", "height of its centre after 1.2 s, m"},
                 0.14, end.centre_of_mass[1]);
}

/// Fastest rise of an elastic ball of 5 cells after it met the floor at 5 m/s.
/// @param dt  of semi-implicit steps, 0: explicit ones
double speed_of_rebound(double dt) {
  SolverSettings s;
  s.cell_size = 0.03;
  if (dt > 0) {
    s.beta = 1;
    s.time_step = TimeStep::fixed;
    s.dt = dt;
  }
  Material m;
  m.model = laws::model::corotated;
  Simulation simulation(s, {m}, {plane({0, 0, 0}, {0, 1, 0}, 0.5)},
                        ball_of_snow({0, 0.17, 0}, 0.15, 0.015, {0, -5, 0}), 1);
  double fastest = 0;
  for (int k = 1; k <= 20; ++k) {
    simulation.advance_to(0.005 * k);
    const Summary now = simulation.summary();
    fastest = std::max(fastest, now.momentum[1] / now.mass);
  }
  return fastest;
}

TEST(ElasticRebound, ContactInsideTheSolveGivesBackWhatItTook) {
  // Sound passes a third of a cell in a step. Backward steps damp what rings: 5 % of the speed.
  verify_near({"contact", "elastic ball, beta = 1, dt = 0.5 ms", "speed of rebound / explicit"}, 1,
              speed_of_rebound(5e-4) / speed_of_rebound(0), 0.07);
}

TEST(SlipFloor, SlipFloorKeepsTangentialMomentumAndHoldsOnTo) {
  SolverSettings s;
  s.cell_size = 0.03;
  const auto end_of = [&](shapes::Contact contact, double v_y) {
    Material m;
    m.model = laws::model::corotated;
    Simulation simulation(s, {m}, {plane({0, 0.003, 0}, {0, 1, 0}, 0, contact)},
                          ball_of_snow({0, 0.125, 0}, 0.12, 0.015, {2, v_y, 0}), 1);
    simulation.advance_to(0.12);  // about when the one that bounces is highest
    return simulation.summary();
  };
  const Summary slip = end_of(shapes::Contact::slip, -1),
                separate = end_of(shapes::Contact::separate, -1);
  // Frictionless: float sums over 2000 steps.
  verify_near({"contact", "elastic ball on a slippery floor", "tangential velocity, m/s"}, 2,
              slip.momentum[0] / slip.mass, 1e-4);
  // An elastic ball bounces off; held by the floor it cannot.
  EXPECT_GT(separate.centre_of_mass[1], slip.centre_of_mass[1] + 0.02);
}

// ---- several surfaces at one place --------------------------------------------------------------

/// A block that comes down aslant on floors in one place, after an impact of fifty steps.
ParticleArrays fallen_on(std::size_t floors, shapes::Contact contact, double friction,
                         double beta) {
  SolverSettings s;
  s.cell_size = 0.04;
  s.precision = Precision::real64;
  s.beta = beta;
  s.solve_tolerance = 1e-10;
  s.solve_iterations = 500;
  ParticleArrays p = box_of_snow({-0.12, 0.02, -0.12}, {0.12, 0.26, 0.12}, 0.02);
  for (Vec3d& v : p.v) v = {1, -3, 0};
  const std::vector<shapes::Collider> planes(floors,
                                             plane({0, 0.003, 0}, {0, 1, 0}, friction, contact));
  Simulation simulation(s, {Material{}}, planes, p, 1);
  for (int step = 0; step < 50 && !simulation.divergence(); ++step) simulation.step(4e-4);
  return simulation.particles();
}

/// Each floor takes what the others left of a particle's own velocity. Three of them took it three
/// times: sticky ones threw it back twice as fast as it came.
TEST(SeveralSurfaces, FloorsInOnePlaceAreOne) {
  for (const shapes::Contact contact :
       {shapes::Contact::separate, shapes::Contact::slip, shapes::Contact::sticky})
    for (const double beta : {0.0, 1.0}) {
      // In the first solution rounding decides whether the bound of friction sticks or slides: it
      // is 0.
      const double friction = beta > 0 ? 0 : 0.5;
      const ParticleArrays one = fallen_on(1, contact, friction, beta);
      const ParticleArrays three = fallen_on(3, contact, friction, beta);
      double apart = 0, faster = 0;
      for (std::size_t q = 0; q < one.x.size(); ++q) {
        apart = std::max(apart, (three.x[q] - one.x[q]).norm());
        faster = std::max(faster, (three.v[q] - one.v[q]).norm());
      }
      // Rounding of thirds, over fifty steps: 1e-16 m and 1e-13 m/s.
      EXPECT_LE(apart, 1e-14) << static_cast<int>(contact) << ", beta " << beta;
      EXPECT_LE(faster, 1e-11) << static_cast<int>(contact) << ", beta " << beta;
    }
}

/// A block let down on the corner where four boxes meet. Sticky ones threw it off with 260 m/s.
TEST(SeveralSurfaces, TilesThatMeetBearSnowAsOneFloorDoes) {
  for (const shapes::Contact contact :
       {shapes::Contact::separate, shapes::Contact::slip, shapes::Contact::sticky}) {
    const auto fallen_on_tiles = [&](int per_side) {
      std::vector<shapes::Collider> tiles;
      const double side = 2.0 / per_side;
      for (int i = 0; i < per_side; ++i)
        for (int k = 0; k < per_side; ++k) {
          shapes::Collider tile;
          tile.shape.form =
              shapes::Box{{(i + 0.5) * side - 1, -0.5, (k + 0.5) * side - 1}, {side, 1, side}};
          tile.contact = contact;
          tile.friction = 0.5;
          tiles.push_back(tile);
        }
      SolverSettings s;
      s.cell_size = 0.04;
      ParticleArrays p = box_of_snow({-0.12, 0.01, -0.12}, {0.12, 0.25, 0.12}, 0.02);
      for (Vec3d& v : p.v) v = {0, -2, 0};
      Simulation simulation(s, {Material{}}, tiles, p, 1);
      simulation.advance_to(0.5);
      EXPECT_FALSE(simulation.divergence());
      return simulation.summary();
    };
    const Summary one = fallen_on_tiles(1), four = fallen_on_tiles(2);
    // Normals lean at the edges of tiles and particles there lie differently: 7e-5 m at most in the
    // mean of all.
    EXPECT_NEAR(four.centre_of_mass[1], one.centre_of_mass[1], 2e-4);
    // Both still ring, at 3 cm/s.
    EXPECT_LE(four.max_speed, 0.06);
  }
}

}  // namespace
