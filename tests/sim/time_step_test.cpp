/// The limit that rules dt, and frames that end on time.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/laws/law.h"
#include "sim/types/time_step.h"
#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

StateLimits slow() {
  return {0.1, 1.0, 0.1, 10, 100};
}

TEST(TimeStep, SmallestLimitRules) {
  SolverSettings s;  // h = 0.02
  EXPECT_EQ(choose_dt(s, slow(), 1).limit, DtLimit::max_dt);
  EXPECT_EQ(choose_dt(s, slow(), 1).dt, s.max_dt);
  StateLimits fast = slow();
  fast.max_speed = 100;
  fast.max_xi = 0;
  EXPECT_EQ(choose_dt(s, fast, 1).limit, DtLimit::cfl);
  EXPECT_NEAR(choose_dt(s, fast, 1).dt, 0.4 * 0.02 / 100, 1e-15);
  StateLimits stiff = slow();
  stiff.max_sound_speed = 40;
  EXPECT_EQ(choose_dt(s, stiff, 1).limit, DtLimit::acoustic);
  EXPECT_NEAR(choose_dt(s, stiff, 1).dt, 0.5 * 0.02 / 40, 1e-15);
  StateLimits strained = slow();
  strained.max_strain_rate = 3000;
  EXPECT_EQ(choose_dt(s, strained, 1).limit, DtLimit::strain);
  EXPECT_NEAR(choose_dt(s, strained, 1).dt, 0.3 / 3000, 1e-15);
}

/// 50 000 steps of 1e-8 s leave 1.6e-16 s of a frame: a step of that, one too many.
TEST(TimeStep, FixedStepsOfALongFrameEndWithoutASliver) {
  SolverSettings s;
  s.time_step = TimeStep::fixed;
  for (const double dt : {1e-8, 1e-7, 3e-7, 1e-4}) {
    s.dt = dt;
    for (const int count : {1, 7, 5000, 50000, 100000}) {
      const double whole = count * dt;
      double done = 0, shortest = whole;
      int steps = 0;
      while (done < whole && steps < 2 * count) {
        const DtChoice choice = choose_dt(s, slow(), whole - done, 1, done);
        shortest = std::min(shortest, choice.dt);
        done = choice.limit == DtLimit::frame_end ? whole : done + choice.dt;
        ++steps;
      }
      EXPECT_EQ(steps, count) << dt;
      EXPECT_NEAR(shortest / dt, 1, 1e-4) << dt << " " << count;
    }
  }
  // A step that is short because the frame is no multiple of dt stays.
  s.dt = 1e-4;
  EXPECT_NEAR(choose_dt(s, slow(), 1e-7, 1, 0.01).dt, 1e-7, 1e-20);
  EXPECT_EQ(choose_dt(s, slow(), 1.001e-4, 1, 0.01).limit, DtLimit::fixed);
}

/// A plate at 80 m/s crosses four cells in the longest step; it hits a block within 0.5 ms.
TEST(TimeStep, FastCollidersLimitTheStepOfSnowThatTheyMeet) {
  const auto collider_limit = static_cast<std::size_t>(DtLimit::collider);
  for (const ContactAt contact_at : {ContactAt::nodes, ContactAt::particles})
    for (const double beta : {0.0, 1.0}) {
      SolverSettings s;
      s.contact_at = contact_at;
      s.beta = beta;
      shapes::Collider plate;
      plate.shape.form = shapes::Box{{-0.15, 0.1, 0}, {0.04, 0.6, 0.6}};
      plate.velocity = {80, 0, 0};
      Simulation simulation(s, {Material{}}, {plate},
                            box_of_snow({-0.1, 0, -0.1}, {0.1, 0.2, 0.1}, 0.01), 1);
      EXPECT_NEAR(simulation.step_limits().dt[collider_limit], 0.4 * 0.02 / 80, 1e-12);
      const AdvanceReport report = simulation.advance_to(4.0 / 240);
      EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
      EXPECT_GT(report.ruled[collider_limit], 0u);
      EXPECT_GT(simulation.summary().momentum[0], 60 * simulation.summary().mass);
    }
}

TEST(TimeStep, CollidersOutOfReachAndThoseThatRestLimitNothing) {
  const auto collider_limit = static_cast<std::size_t>(DtLimit::collider);
  const auto limit_of = [&](const Vec3d& velocity, double x) {
    shapes::Collider ball;
    ball.shape.form = shapes::Sphere{{x, 0.1, 0}, 0.05};
    ball.velocity = velocity;
    const Simulation simulation(SolverSettings{}, {Material{}}, {ball},
                                box_of_snow({-0.1, 0, -0.1}, {0.1, 0.2, 0.1}, 0.01), 1);
    return simulation.step_limits().dt[collider_limit];
  };
  EXPECT_EQ(limit_of({0, 0, 0}, -0.16), std::numeric_limits<double>::infinity());
  EXPECT_EQ(limit_of({40, 0, 0}, -2), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(limit_of({40, 0, 0}, -0.16), 0.4 * 0.02 / 40, 1e-12);
}

/// The first step after a birth: of a body that appears in a scene without snow, and of a stream.
TEST(TimeStep, FastCollidersLimitTheStepOfSnowThatIsBorn) {
  shapes::Collider belt = plane({0, 0, 0}, {0, 1, 0}, 0.5);
  belt.velocity = {80, 0, 0};
  seeding::Emitter e;
  e.name = "tap";
  e.material = "snow";
  e.shape.form = shapes::Box{{0, 0.05, 0}, {0.1, 0.08, 0.1}};
  e.velocity = {0, -1, 0};
  for (const double rate : {0.0, 3.0}) {
    e.rate = rate;
    Simulation simulation(SolverSettings{}, {Material{}}, {belt}, {}, 1, neve::sim::Vec3i::Zero(),
                          {{e}, {}, 1});
    while (simulation.particle_count() == 0) simulation.step(1e-3);
    EXPECT_EQ(simulation.step_limits().max_collider_speed, 80) << rate;
  }
}

TEST(TimeStep, FastSnowTakesStepsThatItsHardeningCannotOutrun) {
  SolverSettings s;
  StateLimits impact{20, 19.7, 0, 10, 1970};
  const double dt = choose_dt(s, impact, 1).dt;
  const double c_after = 19.7 * std::exp(0.5 * 10 * 0.7 * 20 * dt / s.cell_size);
  EXPECT_LE(c_after * dt, 1.0 * s.cell_size);
}

/// Snow whose material ends hardening cannot become stiffer than that: its steps are those of the
/// speed of sound, however fast it moves.
TEST(TimeStep, FastSnowThatHardlyHardensKeepsItsLongSteps) {
  SolverSettings s;
  s.cfl = 10;
  Material material;
  material.max_hardening = 3;
  StateLimits impact{20, 19.7};
  laws::include_hardening(material, impact);
  EXPECT_EQ(impact.max_xi, 10);
  EXPECT_NEAR(impact.max_hardened_speed, std::sqrt(3) * sound_speed(material), 1e-12);
  // 1.74 of 19.7 m/s: sound crosses 0.87 of a cell after the step.
  EXPECT_NEAR(choose_dt(s, impact, 1).dt, 0.5 * 0.02 / 19.7, 1e-15);
  impact.max_hardened_speed = 3 * 19.7;
  const double dt = choose_dt(s, impact, 1).dt;
  EXPECT_LE(3 * 19.7 * dt, s.cell_size);
  EXPECT_GE(3 * 19.7 * dt, 0.8 * s.cell_size) << "shorter than it must be";
}

TEST(TimeStep, FixedIsTakenAsItIs) {
  SolverSettings s;
  s.time_step = TimeStep::fixed;
  s.dt = 7e-3;
  StateLimits impact{20, 190, 900, 10, 1970};
  EXPECT_EQ(choose_dt(s, impact, 1).dt, 7e-3);
  EXPECT_EQ(choose_dt(s, impact, 1).limit, DtLimit::fixed);
  EXPECT_EQ(choose_dt(s, impact, 2e-3).dt, 2e-3);
  EXPECT_EQ(choose_dt(s, impact, 2e-3).limit, DtLimit::frame_end);
}

TEST(TimeStep, LastStepsOfAFrameShareWhatIsLeft) {
  SolverSettings s;
  const DtChoice choice = choose_dt(s, slow(), 1.5e-3);
  EXPECT_EQ(choice.limit, DtLimit::frame_end);
  EXPECT_NEAR(choice.dt, 0.75e-3, 1e-15);
}

TEST(TimeStep, FramesEndExactlyAndCountTheirSteps) {
  for (const TimeStep kind : {TimeStep::adaptive, TimeStep::fixed}) {
    SolverSettings s;
    s.time_step = kind;
    s.dt = 1e-4;
    Simulation simulation(s, {Material{}}, {}, box_of_snow({0, 0, 0}, {0.1, 0.1, 0.1}, 0.01), 1);
    std::size_t steps = 0;
    for (int frame = 1; frame <= 10; ++frame) {
      const AdvanceReport report = simulation.advance_to(frame / 24.0);
      EXPECT_EQ(simulation.time(), frame / 24.0);
      steps += report.steps;
      std::size_t ruled = 0;
      for (const std::size_t n : report.ruled) ruled += n;
      EXPECT_EQ(ruled, report.steps);
      // 1/24 s in steps of 1e-4 s: 416 whole ones and a shortened one.
      if (kind == TimeStep::fixed) {
        EXPECT_EQ(report.steps, 417u);
        EXPECT_EQ(report.limit(), DtLimit::fixed);
      }
      EXPECT_GT(report.dt_min, 1e-6);
    }
    EXPECT_EQ(simulation.steps(), steps);
  }
}

TEST(FlipShare, FlipShareDampsByTimeNotBySteps) {
  SolverSettings s;
  EXPECT_NEAR(flip_share(s, 5e-4), 0.95, 1e-15);
  EXPECT_NEAR(std::pow(flip_share(s, 1e-4), 5), 0.95, 1e-14);
  s.flip_reference_dt = 0;
  EXPECT_EQ(flip_share(s, 1e-5), 0.95);
}

TEST(Interruption, InterruptionEndsAfterAStep) {
  SolverSettings s;
  Simulation simulation(s, {Material{}}, {}, box_of_snow({0, 0, 0}, {0.1, 0.1, 0.1}, 0.01), 1);
  const AdvanceReport report = simulation.advance_to(1, [] { return true; });
  EXPECT_EQ(report.steps, 1u);
  EXPECT_LT(simulation.time(), 0.01);
}

}  // namespace
