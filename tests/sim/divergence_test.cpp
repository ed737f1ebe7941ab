/// A run that goes wrong stops, says which rule broke and at which particle; a healthy one does
/// not.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/laws/list.h"
#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

std::vector<shapes::Collider> floor_plane() {
  return {plane({0, 0.003, 0}, {0, 1, 0}, 0.5)};
}

ParticleArrays falling_ball(double speed) {
  return ball_of_snow({0, 0.13, 0}, 0.12, 0.02, {0, -speed, 0});
}

std::string rule_of(const SolverSettings& s, const Material& m, const ParticleArrays& p,
                    double until = 0.1) {
  Simulation simulation(s, {m}, floor_plane(), p, 1);
  simulation.advance_to(until);
  return simulation.divergence() ? simulation.divergence()->rule : "";
}

TEST(Divergence, HealthyImpactsPass) {
  for (const double speed : {0.0, 3.0, 10.0, 30.0, 80.0}) {
    SolverSettings s;
    s.cell_size = 0.03;
    EXPECT_EQ(rule_of(s, Material{}, falling_ball(speed), 0.05), "") << speed << " m/s";
  }
}

TEST(Divergence, HealthyImpactsOfElasticModelsPass) {
  for (const Model model : {laws::model::corotated, laws::model::neo_hookean}) {
    SolverSettings s;
    s.cell_size = 0.03;
    Material m;
    m.model = model;
    EXPECT_EQ(rule_of(s, m, falling_ball(3), 0.1), "");
  }
}

Material soft_snow() {
  Material m;
  m.youngs_modulus = 4.8e4;
  m.hardening = 5;
  return m;
}

/// Held nodes make the hardest impact. With the paper's transfer less than a tenth of the snow is
/// crushed; what moves as it is strained is crushed as a whole, and viscosity keeps it from that.
SolverSettings with_held_nodes() {
  SolverSettings s;
  s.transfer = Transfer::flip;
  s.shock_viscosity = 0;
  s.cell_size = 0.03;
  s.contact_at = ContactAt::nodes;
  return s;
}

TEST(Divergence, SoftSnowIsCrushedAndRunsOn) {
  Material m = soft_snow();
  Simulation simulation(with_held_nodes(), {m}, floor_plane(), falling_ball(30), 1);
  simulation.advance_to(0.1);
  ASSERT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  EXPECT_FLOAT_EQ(static_cast<float>(simulation.warnings().least_J_P), 0.1F);
  // Without the range of J_P the run ends here.
  m.min_J_P = 1e-6;
  EXPECT_EQ(rule_of(with_held_nodes(), m, falling_ball(30)), "J_P");
}

/// e^(xi (1 - J_P)) of a J_P that changed its sign would be more than float holds.
TEST(Divergence, TornParticleTurnedInsideOutPoisonsNoOther) {
  for (const Precision precision : {Precision::single, Precision::real64}) {
    SolverSettings s;
    s.cell_size = 0.03;
    s.precision = precision;
    ParticleArrays p = falling_ball(3);
    p.F_E.assign(p.x.size(), Mat3d::Identity());
    p.J_P.assign(p.x.size(), 1);
    p.J_P[7] = 20;
    p.F_E[7] = Vec3d(1, 1, -0.5).asDiagonal();
    EXPECT_EQ(rule_of(s, Material{}, p), "");
  }
}

TEST(Divergence, SnowWithoutRoomIsFound) {
  std::vector<shapes::Collider> press = floor_plane();
  press.push_back(plane({0, 0.27, 0}, {0, -1, 0}, 0.5));
  press.back().velocity = Vec3d(0, -8, 0);
  Simulation simulation(with_held_nodes(), {soft_snow()}, press, falling_ball(0), 1);
  simulation.advance_to(0.1);
  ASSERT_TRUE(simulation.divergence());
  const Divergence& d = *simulation.divergence();
  EXPECT_EQ(d.rule, "packed");
  EXPECT_NE(d.what.find("of the snow is packed to J_P = 0.1"), std::string::npos) << d.what;
}

/// The sand beside the snow does not count.
TEST(Summary, SharesAreOfTheSnow) {
  ParticleArrays p = falling_ball(0);
  const std::size_t snow = p.x.size();
  for (int copy = 0; copy < 20; ++copy)
    for (std::size_t k = 0; k < snow; ++k) {
      p.x.push_back(p.x[k] + Vec3d(2.0 + copy, 0, 0));
      p.v.push_back(Vec3d::Zero());
      p.m.push_back(3 * p.m[k]);
      p.V0.push_back(p.V0[k]);
    }
  p.J_P.assign(p.x.size(), 1);
  p.material.assign(p.x.size(), 1);
  for (std::size_t k = 0; k < snow; ++k) p.J_P[k] = k < snow / 4 ? 0.1 : 0.9, p.material[k] = 0;
  const auto summary_of = [&](const ParticleArrays& particles) {
    Material sand;
    sand.model = laws::model::sand;
    sand.density = 1500;
    return Simulation(with_held_nodes(), {soft_snow(), sand}, floor_plane(), particles, 1)
        .summary();
  };
  const double share = static_cast<double>(snow / 4) / static_cast<double>(snow);
  const Summary mixed = summary_of(p);
  EXPECT_NEAR(mixed.packed, share, 1e-6);
  EXPECT_NEAR(mixed.denser_than_ice, share, 1e-6);
  p.material.assign(p.x.size(), 1);
  EXPECT_EQ(summary_of(p).packed, 0);
  EXPECT_EQ(summary_of(p).denser_than_ice, 0);
}

/// A plate that moves slowly does work on every step, mostly against stress that slows the nodes
/// down by more than the plate's speed.
TEST(Divergence, SlowPressesAreHealthy) {
  SolverSettings s;
  s.cell_size = 0.03;
  s.gravity.setZero();
  const shapes::Contact slip = shapes::Contact::slip;
  for (const Model model : {laws::model::snow, laws::model::corotated}) {
    Material m;
    m.model = model;
    std::vector<shapes::Collider> box = {
        plane({0, 0, 0}, {0, 1, 0}, 0, slip),     plane({0, 0, 0}, {1, 0, 0}, 0, slip),
        plane({0.18, 0, 0}, {-1, 0, 0}, 0, slip), plane({0, 0, 0}, {0, 0, 1}, 0, slip),
        plane({0, 0, 0.18}, {0, 0, -1}, 0, slip), plane({0, 0.36, 0}, {0, -1, 0}, 0, slip)};
    box.back().velocity = Vec3d(0, -0.1, 0);
    Simulation simulation(s, {m}, box, box_of_snow({0, 0, 0}, {0.18, 0.36, 0.18}, 0.015), 1);
    simulation.advance_to(0.15);
    EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
    EXPECT_GT(simulation.summary().elastic_energy, 0);
  }
}

TEST(Divergence, StepOfAWholeFrameIsNamed) {
  SolverSettings s;
  s.cell_size = 0.03;
  s.time_step = TimeStep::fixed;
  s.dt = 1.0 / 24;
  Simulation simulation(s, {Material{}}, floor_plane(), falling_ball(5), 1);
  simulation.advance_to(0.5);
  ASSERT_TRUE(simulation.divergence());
  const Divergence& d = *simulation.divergence();
  EXPECT_EQ(d.rule, "speed_cfl");
  EXPECT_GE(d.particle, 0);
  EXPECT_FALSE(d.culprits.empty());
  EXPECT_GT(d.dt_that_holds, 1e-5);
  EXPECT_LT(d.dt_that_holds, 3e-3);
  EXPECT_NE(d.sentence.find("diverged at step"), std::string::npos) << d.sentence;
  EXPECT_NE(d.sentence.find("would have held"), std::string::npos) << d.sentence;
}

TEST(Divergence, AFixedStepTooLongForTheStiffnessIsFound) {
  SolverSettings s;
  s.cell_size = 0.03;
  s.time_step = TimeStep::fixed;
  s.dt = 1e-3;
  Material m;
  m.model = laws::model::corotated;
  m.youngs_modulus = 1e8;
  EXPECT_NE(rule_of(s, m, falling_ball(5)), "");
}

TEST(Divergence, NanIsFoundInTheStepThatItAppears) {
  SolverSettings s;
  s.cell_size = 0.03;
  ParticleArrays p = falling_ball(0);
  p.v[17][1] = std::numeric_limits<double>::quiet_NaN();
  Simulation simulation(s, {Material{}}, {}, p, 1);
  simulation.step(1e-4);
  ASSERT_TRUE(simulation.divergence());
  EXPECT_EQ(simulation.divergence()->rule, "not_finite");
  EXPECT_EQ(simulation.divergence()->step, 1u);
}

TEST(Divergence, FarFlightIsAnOverflowNotACrash) {
  SolverSettings s;
  s.cell_size = 0.03;
  s.time_step = TimeStep::fixed;
  s.dt = 1.0;
  s.precision = Precision::real64;  // in float, the rounding of such a speed alone tears F apart
  ParticleArrays p = falling_ball(0);
  for (Vec3d& v : p.v) v = {1e7, 0, 0};
  Simulation simulation(s, {Material{}}, {}, p, 1);
  simulation.advance_to(10);
  ASSERT_TRUE(simulation.divergence());
  EXPECT_EQ(simulation.divergence()->rule, "overflow");
}

TEST(Divergence, InitialCompressionBeyondTheRuleIsFound) {
  SolverSettings s;
  s.cell_size = 0.03;
  ParticleArrays p = falling_ball(0);
  p.J_P.assign(p.x.size(), 0.05);
  EXPECT_EQ(rule_of(s, Material{}, p, 0.01), "J_P");
}

TEST(Divergence, ElasticMatterTurnedInsideOutIsFound) {
  SolverSettings s;
  s.cell_size = 0.03;
  Material m;
  m.model = laws::model::neo_hookean;
  ParticleArrays p = falling_ball(0);
  p.F_E.assign(p.x.size(), Mat3d::Identity());
  p.F_E[5](2, 2) = -1;
  EXPECT_EQ(rule_of(s, m, p, 0.01), "inverted");
}

/// A ball of one cell's radius: half of the energy of its spin is in affine velocities, and aflip
/// and asflip make 0.28 of that half when the two settle, at any dt. It then only falls.
TEST(Divergence, AThinBodyMaySpinInEveryTransfer) {
  const double h = 0.05, R = 1.08 * h;
  for (const Transfer transfer :
       {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip})
    for (const double acoustic_cfl : {0.5, 0.05}) {
      SolverSettings s;
      s.cell_size = h;
      s.gravity.setZero();
      s.transfer = transfer;
      s.acoustic_cfl = acoustic_cfl;
      Material m;
      m.model = laws::model::corotated;
      ParticleArrays p = ball_of_snow({0.2, 0.2, 0.2}, R, h / 2, Vec3d::Zero());
      const Vec3d spin(-8, 6, 9);
      for (std::size_t q = 0; q < p.x.size(); ++q)
        p.v[q] = spin.cross(p.x[q] - Vec3d(0.2, 0.2, 0.2));
      Simulation simulation(s, {m}, {}, p, 1);
      simulation.advance_to(0.02);
      const double settled = energy_account(simulation).found;
      simulation.advance_to(0.1);
      ASSERT_FALSE(simulation.divergence())
          << static_cast<int>(transfer) << simulation.divergence()->sentence;
      EXPECT_LT(energy_account(simulation).found, settled * 1.001) << static_cast<int>(transfer);
    }
}

TEST(Divergence, EnergyFromNowhereIsFound) {
  // A compressed elastic ball at rest whose step is so long that its release overshoots: fixed
  // steps report sound, they do not stop for it, so the sum of energies has to notice.
  SolverSettings s;
  s.cell_size = 0.03;
  s.time_step = TimeStep::fixed;
  s.gravity.setZero();
  s.transfer = Transfer::flip;
  s.flip_ratio = 1;
  Material m;
  m.model = laws::model::corotated;
  m.hardening = 0;
  s.dt = 2.2 * s.cell_size / sound_speed(m);
  ParticleArrays p = ball_of_snow({0, 0.13, 0}, 0.12, 0.015, {0, 0, 0});
  p.F_E.assign(p.x.size(), 0.999 * Mat3d::Identity());
  Simulation simulation(s, {m}, {}, p, 1);
  for (int frame = 1; frame <= 60 && !simulation.divergence(); ++frame)
    simulation.advance_to(frame * 10 * s.dt);
  ASSERT_TRUE(simulation.divergence());
  EXPECT_TRUE(simulation.divergence()->rule == "energy" ||
              simulation.divergence()->rule == "speed_cfl" ||
              simulation.divergence()->rule == "inverted")
      << simulation.divergence()->rule;
}

TEST(Simulation, SimulationRefusesArraysThatDoNotFit) {
  const SolverSettings s;
  ParticleArrays p = falling_ball(0);
  p.v.pop_back();
  EXPECT_THROW(Simulation(s, {Material{}}, {}, p), std::invalid_argument);
  p = falling_ball(0);
  p.m[3] = 0;
  EXPECT_THROW(Simulation(s, {Material{}}, {}, p), std::invalid_argument);
  p = falling_ball(0);
  p.x[3][0] = 1e30;
  EXPECT_THROW(Simulation(s, {Material{}}, {}, p), std::invalid_argument);
  p = falling_ball(0);
  p.material.assign(p.x.size(), 1);
  EXPECT_THROW(Simulation(s, {Material{}}, {}, p), std::invalid_argument);
}

TEST(Simulation, AStepWithoutParticlesOnlyTakesTime) {
  Simulation simulation(SolverSettings{}, {Material{}}, {}, {}, 1);
  simulation.advance_to(0.1);
  EXPECT_EQ(simulation.time(), 0.1);
  EXPECT_EQ(simulation.summary().particles, 0u);
}

}  // namespace
