/// A stiff ball that slips down a slope.

#include <cmath>
#include <numbers>

#include "tests/support/elastic.h"
#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(SlippingBallLong, SlippingBallAcceleratesByGravityLessFriction) {
  // mu < 2/7 tan t: it slips, a = g (sin t - mu cos t). The ball also should spin up, by alpha =
  // 5 mu g cos t / (2 R); that it does not is the price of contact at nodes: within a cell of the
  // plane the ball rests on a flat of 4 cells' radius, which resists rolling. So rolling is no
  // case for a grid as coarse as R = 6 h.
  const double t = 20 * std::numbers::pi / 180, mu = 0.05, R = 0.3;
  SolverSettings s;
  s.cell_size = R / 6;
  s.contact_at = ContactAt::nodes;
  s.transfer = Transfer::flip;
  s.flip_ratio = 0.99;
  s.flip_reference_dt = 1e-3;
  s.gravity = 9.81 * Vec3d(std::sin(t), -std::cos(t), 0);
  const Material m = elastic(1e6, 0.2, 400);
  const ParticleArrays cube =
      lattice(Vec3d::Constant(-R), Vec3d::Constant(R), {24, 24, 24}, m.density);
  ParticleArrays p;
  for (std::size_t q = 0; q < cube.x.size(); ++q) {
    if (!(cube.x[q].norm() < R)) continue;
    p.x.push_back(cube.x[q] + Vec3d(0, R, 0));
    p.v.push_back(Vec3d::Zero());
    p.m.push_back(cube.m[q]);
    p.V0.push_back(cube.V0[q]);
  }
  Simulation simulation(s, {m}, {plane({0, 1e-6, 0}, {0, 1, 0}, mu)}, p, 1);
  const double dt = 0.4 * s.cell_size / sound_speed(m);
  struct Motion {
    double time, v, spin;
  };
  const auto run_to = [&](double time) {
    while (simulation.time() < time) simulation.step(dt);
    const Summary now = simulation.summary();
    const Vec3d own = now.angular_momentum - now.centre_of_mass.cross(now.momentum);
    return Motion{now.time, now.momentum[0] / now.mass, -own[2] / (0.4 * now.mass * R * R)};
  };
  const Motion a = run_to(0.1), b = run_to(0.4);
  const std::string line = "stiff ball slipping down 20°, mu = 0.05, float";
  // It bounces a little on its own elasticity, and friction with it: 1 %.
  verify_ratio({"incline", line, "acceleration, m/s²"}, 9.81 * (std::sin(t) - mu * std::cos(t)),
               (b.v - a.v) / (b.time - a.time), 0.01);
  keep_number({"incline", line, "angular acceleration / that of a rigid ball"},
              (b.spin - a.spin) / (b.time - a.time) / (5 * mu * 9.81 * std::cos(t) / (2 * R)));
}

constexpr double rolling_cell = 0.02;

/// Eight particles in a cell, at random.
ParticleArrays rough_ball(double cells, unsigned seed) {
  const double h = rolling_cell, R = cells * h;
  return ball_of_snow({0.003, R + 0.375 * h / 2, 0.004}, R, h / 2, Vec3d::Zero(), seed);
}

/// The same in shells, the outermost as far from the centre everywhere. Particles of a shell lie on
/// a spiral that the golden angle winds.
ParticleArrays smooth_ball(double cells) {
  const double d = rolling_cell / 2, R = cells * rolling_cell;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const Vec3d center{0.003, R - 0.125 * d, 0.004};
  ParticleArrays p;
  for (double r = R - d / 2; r > 0; r -= d) {
    const double count = std::round(4 * std::numbers::pi * r * r / (d * d));
    const double volume =
        4 * std::numbers::pi / 3 * (std::pow(r + d / 2, 3) - std::pow(r - d / 2, 3)) / count;
    for (double k = 0; k < count; ++k) {
      const double z = 1 - (2 * k + 1) / count, around = std::sqrt(1 - z * z);
      p.x.push_back(center +
                    r * Vec3d(around * std::cos(golden * k), around * std::sin(golden * k), z));
      p.v.push_back(Vec3d::Zero());
      p.m.push_back(400 * volume);
      p.V0.push_back(volume);
    }
  }
  return p;
}

/// Way and spin of a ball that rolls down a slope for 0.8 s, of a rigid one.
struct Rolling {
  double way, spin_over_speed;
  double slipping_spin;  ///< of that which friction gives a ball that slips
};
Rolling roll(double cells, double friction, const ParticleArrays& ball,
             Transfer transfer = Transfer::asflip) {
  const double t = 20 * std::numbers::pi / 180, R = cells * rolling_cell, seconds = 0.8;
  SolverSettings s;
  s.cell_size = rolling_cell;
  s.transfer = transfer;
  s.gravity = 9.81 * Vec3d(std::sin(t), -std::cos(t), 0);
  Simulation simulation(s, {elastic(1e6, 0.2, 400)}, {plane({0, 0, 0}, {0, 1, 0}, friction)}, ball,
                        2);
  const double begin = simulation.summary().centre_of_mass[0];
  simulation.advance_to(seconds);
  const Summary now = simulation.summary();
  const Vec3d own = now.angular_momentum - now.centre_of_mass.cross(now.momentum);
  const double down = std::sin(t), held = friction * std::cos(t);
  const bool slips = friction < 2.0 / 7 * std::tan(t);
  const double exact = 0.5 * 9.81 * (slips ? down - held : down / 1.4) * seconds * seconds;
  return {(now.centre_of_mass[0] - begin) / exact, -own[2] / (0.4 * R) / now.momentum[0],
          -own[2] / (now.mass * R * 9.81 * held * seconds)};
}

/// Particles that come to touch in front are stopped, those that leave behind are not: rolling has
/// a resistance of a fifth of a cell over the radius, which shrinks with the cells.
TEST(RollingBallLong, ABallRollsTheBetterTheFinerItsCells) {
  for (const double cells : {6.0, 12.0}) {
    const Rolling found = roll(cells, 0.3, rough_ball(cells, 1));
    const std::string line = "ball rolling down 20°, radius of " + in_digits(cells) + " cells";
    verify_ratio({"incline", line, "way in 0.8 s / that of a rigid ball"}, 1, found.way,
                 0.8 / cells);
    // It rocks on its particles while it rolls.
    verify_near({"incline", line, "spin times radius / speed"}, 1, found.spin_over_speed, 0.1);
  }
}

/// The ball gets a tenth to two thirds of the spin at six cells, by how its particles lie. It is
/// pressed in by 0.07 cells, its outermost particles are up to half a cell uneven: it lies on a few
/// of them, and friction, whose lever is mu R = 0.3 cells, has to tilt it over them. At twelve
/// cells, with twice the lever, the resistance of a smooth surface is left, a twelfth of a cell:
/// 0.89.
TEST(RollingBallLong, ABallAtLowFrictionSpinsUpTheBetterTheFinerItsCells) {
  const auto line = [](double cells, unsigned seed) {
    return "ball slipping down 20°, mu = 0.05, radius of " + in_digits(cells) + " cells, seed " +
           in_digits(seed);
  };
  const std::string way = "way in 0.8 s / that of a rigid ball",
                    spin = "spin after 0.8 s / that of a rigid ball";
  double coarse = 0;
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Rolling found = roll(6, 0.05, rough_ball(6, seed));
    verify_ratio({"incline", line(6, seed), way}, 1, found.way, 0.02);
    keep_number({"incline", line(6, seed), spin}, found.slipping_spin);
    coarse += found.slipping_spin / 3;
  }
  const Rolling fine = roll(12, 0.05, rough_ball(12, 1));
  verify_ratio({"incline", line(12, 1), way}, 1, fine.way, 0.02);
  verify_near({"incline", line(12, 1), spin}, 0.89, fine.slipping_spin, 0.1);
  EXPECT_GT(fine.slipping_spin, coarse + 0.1);
}

/// A ball with a smooth surface meets only a resistance of a twelfth of a cell, where mu R is 0.3
/// cells (twelve cells: 0.89 with APIC).
TEST(RollingBallLong, ABallWithASmoothSurfaceSpinsUp) {
  const std::string spin = "spin after 0.8 s / that of a rigid ball";
  for (const Transfer transfer :
       {Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip}) {
    const Rolling found = roll(6, 0.05, smooth_ball(6), transfer);
    const std::string line =
        "smooth ball slipping down 20°, mu = 0.05, radius of 6 cells, " + name(transfer);
    verify_near({"incline", line, spin}, 0.72, found.slipping_spin, 0.1);
  }
}

}  // namespace
