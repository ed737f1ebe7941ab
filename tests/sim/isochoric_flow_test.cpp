/// Cam clay that flows at constant volume: what the rule keeps, where it ends, and what it shares
/// with the radial one.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "sim/simulation.h"
#include "tests/support/clay_sample.h"
#include "tests/support/simd_levels.h"
#include "tests/support/snow.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;
namespace cam_clay = laws::cam_clay;

Material isochoric_clay() {
  Material m = clay();
  m.own[cam_clay::flow] = cam_clay::isochoric;
  return m;
}

/// The pressure of a trial state, Pa.
double pressure(const Material& m, const Mat3d& F) {
  const double J = F.determinant();
  return 0.5 * bulk_modulus(m) * (1 - J * J);
}

/// States far out, on all sides of the surface.
Mat3d trial_state(std::mt19937& random, int trial) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double size = trial % 2 ? 0.03 : 0.2;
  return std::exp(0.2 * size * unit(random)) * (Mat3d::Identity() + size * random_entries(random));
}

/// J_P of the way to the centre, by its formula.
double history_of_flow(const Material& m, const Mat3d& F, double J_P) {
  const double top = cam_clay::p0(m, J_P), p = pressure(m, F);
  const double centre = 0.5 * (1 - m.own[cam_clay::cohesion]) * top;
  const double pulled = centre + (p - centre) / cam_clay::nearness_to_yield(m, F, J_P);
  return J_P * F.determinant() / std::sqrt(std::max(1 - 2 * pulled / bulk_modulus(m), 0.01));
}

/// @param tolerance  rounding: F_E and what it is taken apart into are of order 1, and the surface
///                   is a thirtieth of the stiffness
template <class Real>
void expect_flow(double tolerance) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Material m = isochoric_clay();
  const double M = laws::critical_slope(m.friction_angle), beta = m.own[cam_clay::cohesion];
  int flowing = 0, at_tips = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const double J_P = std::exp(0.1 * unit(random)), p0 = cam_clay::p0(m, J_P);
    const Mat3d F = trial_state(random, trial);
    const double p = pressure(m, F), r = cam_clay::nearness_to_yield(m, F, J_P);
    // Nothing is expected where rounding decides which case it is.
    const double to_tip = std::min(std::abs(p - p0), std::abs(p + beta * p0));
    if (std::abs(r - 1) < 1e-3 || to_tip < 1e-3 * p0) continue;
    Sample<Real> sample(m, J_P), radial(clay(), J_P);
    sample.set_F(F), radial.set_F(F);
    sample.settle(), radial.settle();
    if (p > p0 || p < -beta * p0 || r < 1) {
      EXPECT_EQ(sample.F(), radial.F());
      EXPECT_EQ(sample.J_P(), radial.J_P());
      at_tips += r > 1;
      continue;
    }
    ++flowing;
    EXPECT_NEAR(sample.J_E() / F.determinant(), 1, tolerance);
    EXPECT_NEAR(sample.p(), p, tolerance * m.youngs_modulus);
    EXPECT_NEAR((1 + 2 * beta) * sample.q() * sample.q(), M * M * (p + beta * p0) * (p0 - p),
                tolerance * M * p0 * (M * p0 + m.youngs_modulus));
    EXPECT_NEAR(sample.J_P() / history_of_flow(m, F, J_P), 1, 10 * tolerance);
    // The radial rule hardens and softens alike.
    EXPECT_NEAR(sample.J_P() / radial.J_P(), 1, 10 * tolerance);
    const double centre = 0.5 * (1 - beta) * p0;
    EXPECT_EQ(sample.J_P() < J_P, p > centre);
  }
  EXPECT_GT(flowing, 50);
  EXPECT_GT(at_tips, 50);
}

TEST(IsochoricFlow, ShearFallsToTheSurfaceAtItsPressureAndTheRestIsAsInRadialFlow) {
  at_every_simd_level([] {
    expect_flow<double>(1e-12);
    expect_flow<float>(3e-6);
  });
}

TEST(IsochoricFlow, ReturnIsIdempotentWhereTheSurfaceStays) {
  expect_idempotent_return(isochoric_clay());
}

/// Some of these angles of friction are ones at which the radial rule makes energy: `neve check`
/// doubts those of the radial rule, and not these.
TEST(IsochoricFlow, ReturnMakesNoEnergyWhateverTheFriction) {
  std::mt19937 random(9);
  for (const double angle : {0.5, 5.0, 39.0, 80.0}) {
    Material m = isochoric_clay();
    m.friction_angle = angle;
    for (int trial = 0; trial < 200; ++trial) {
      const Mat3d F = trial_state(random, trial);
      Sample<double> sample(m);
      sample.set_F(F);
      sample.settle();
      const double before = cam_clay::energy_density(m, F);
      EXPECT_LE(cam_clay::energy_density(m, sample.F()), before * (1 + 1e-9)) << angle;
    }
    std::vector<laws::Concern> found;
    laws::of(m).concerns(m, found);
    EXPECT_TRUE(found.empty()) << angle;
  }
}

/// A path that keeps the volume, in steps.
struct Path {
  const char* name;
  Mat3d step;  ///< I + L, of determinant 1
};
std::vector<Path> paths_of_constant_volume() {
  Mat3d shear = Mat3d::Identity();
  shear(0, 1) = 1e-3;
  const auto axial = [](double stretch) {
    const double side = 1 / std::sqrt(stretch);
    return Mat3d(Vec3d(side, stretch, side).asDiagonal());
  };
  return {{"simple shear", shear},
          {"triaxial compression", axial(1 - 1e-3)},
          {"triaxial extension", axial(1 + 1e-3)}};
}

/// p never moves; p0 grows or falls until p is at the centre of the ellipse, where it neither
/// hardens nor softens: p0 = 2 p/(1 - beta), q = M (1 + beta)/((1 - beta) sqrt(1 + 2 beta)) p.
TEST(IsochoricFlow, EveryPathOfConstantVolumeEndsInTheCriticalState) {
  for (const double cohesion : {0.0, 0.3})
    for (const double start : {1000.0, 12000.0})
      for (const Path& path : paths_of_constant_volume()) {
        SCOPED_TRACE(path.name);
        Material m = isochoric_clay();
        m.own[cam_clay::cohesion] = cohesion;
        m.own[cam_clay::consolidation_hardening] = 1.5;
        m.consolidation_pressure = start;
        Sample<double> sample(m);
        sample.set_F(0.99 * Mat3d::Identity());
        const double p = 0.5 * bulk_modulus(m) * (1 - std::pow(0.99, 6));
        for (int k = 0; k < 4000; ++k) sample.strain(path.step - Mat3d::Identity());
        // Harder than p at first: it starts at a tip, which packs it.
        if (p < start) {
          EXPECT_NEAR(sample.J_E(), std::pow(0.99, 3), 1e-11);
        }
        const double M = laws::critical_slope(m.friction_angle), found = sample.p();
        EXPECT_NEAR(sample.p0() / (2 * found / (1 - cohesion)), 1, 5e-3);
        EXPECT_NEAR(sample.q() / found /
                        (M * (1 + cohesion) / ((1 - cohesion) * std::sqrt(1 + 2 * cohesion))),
                    1, 5e-3);
        const double J_P = sample.J_P();
        for (int k = 0; k < 100; ++k) sample.strain(path.step - Mat3d::Identity());
        EXPECT_NEAR(sample.J_P() / J_P, 1, 1e-4);
        EXPECT_NEAR(sample.p() / found, 1, 1e-9);
      }
}

/// The volume of F_E is kept step by step, so its rounding adds up. Were it of one sign, it would
/// be a third of an ulp or more each time, which is 2e-8.
TEST(IsochoricFlow, PressureDoesNotDriftInSinglePrecision) {
  Sample<float> sample(isochoric_clay());
  sample.set_F(0.99 * Mat3d::Identity());
  const double before = sample.J_E();
  constexpr int steps = 20000;
  for (int k = 0; k < steps; ++k)
    sample.strain(paths_of_constant_volume()[0].step - Mat3d::Identity());
  EXPECT_NEAR(sample.J_E() / before, 1, steps * 5e-9);
}

/// Such snow falls apart: without pressure shear only softens it, while the radial rule opens it.
TEST(IsochoricFlow, ShearWithoutPressureLeavesNoStrength) {
  Sample<double> isochoric(isochoric_clay()), radial(clay());
  const Mat3d L = paths_of_constant_volume()[0].step - Mat3d::Identity();
  for (int k = 0; k < 3000; ++k) {
    isochoric.strain(L);
    radial.strain(L);
  }
  const double start = clay().consolidation_pressure;
  EXPECT_LE(isochoric.q(), 1e-2 * start);
  EXPECT_NEAR(isochoric.p(), 0, 1e-9 * start);
  EXPECT_GT(radial.q(), 0.1 * start);
  EXPECT_GT(radial.p(), 0.1 * start);
}

/// At some strengths no pressure reaches the surface, so that crushed snow is not at a tip.
TEST(IsochoricFlow, ReturnIsFiniteForAnyFiniteDeformationAndStrengthAsInRadialFlow) {
  for (Material m : {clay(), isochoric_clay()})
    for (const double p0 : {1e-3, 4500.0, 10 * m.youngs_modulus})
      for (const double size : {1e-12, 1e-6, 1e-3, 1.0, 1e3})
        for (const Vec3d& s : {Vec3d(1, 1, 1), Vec3d(1, 0, 0), Vec3d(0, 0, 0), Vec3d(1, 1, -1),
                               Vec3d(1, 1e-9, 1), Vec3d(2, 0.5, -1e-4)}) {
          m.consolidation_pressure = p0;
          Sample<float> single(m);
          Sample<double> real(m);
          const Mat3d F = size * s.asDiagonal().toDenseMatrix();
          single.set_F(F), real.set_F(F);
          single.settle(), real.settle();
          EXPECT_TRUE(single.tau().allFinite() && single.F().allFinite()) << s.transpose() << size;
          EXPECT_TRUE(real.tau().allFinite() && real.F().allFinite()) << s.transpose() << size;
          EXPECT_GT(real.J_E(), 0);
        }
}

/// A ball of it that hits a floor.
class FallingBall {
 public:
  explicit FallingBall(int threads = 1)
      : simulation_(settings(), {material_}, floor(), ball(), threads) {}

  void advance(int steps) {
    for (int k = 0; k < steps; ++k) simulation_.step(simulation_.choose_dt(1).dt);
  }
  void flow(double rule) {
    material_.own[cam_clay::flow] = rule;
    simulation_.apply(settings(), {material_}, floor());
  }
  Simulation& simulation() { return simulation_; }

 private:
  /// The viscosity of shocks is part of a step's stress, and not of a state's.
  static SolverSettings settings() {
    SolverSettings s;
    s.shock_viscosity = 0;
    return s;
  }
  static std::vector<shapes::Collider> floor() { return {plane({0, 0, 0}, {0, 1, 0}, 0.5)}; }
  static ParticleArrays ball() { return ball_of_snow({0, 0.11, 0}, 0.1, 0.01, {0.3, -4, 0.1}); }

  Material material_ = isochoric_clay();
  Simulation simulation_;
};

/// J_P is the history of both rules, so the flow may change at any time, and stress stays.
TEST(IsochoricFlow, FlowChangesDuringARun) {
  FallingBall left_alone, changed, there_and_back;
  for (FallingBall* ball : {&left_alone, &changed, &there_and_back}) ball->advance(60);
  const std::vector<Mat3d> tau = changed.simulation().kirchhoff();
  const std::uint64_t before = left_alone.simulation().state_hash();
  changed.flow(cam_clay::radial);
  there_and_back.flow(cam_clay::radial), there_and_back.flow(cam_clay::isochoric);
  EXPECT_EQ(changed.simulation().state_hash(), before);
  // It is computed again, perhaps with another last bit of J.
  const std::vector<Mat3d> now = changed.simulation().kirchhoff();
  for (std::size_t q = 0; q < tau.size(); ++q)
    EXPECT_LE((now[q] - tau[q]).norm(), 1e-6 * isochoric_clay().youngs_modulus);
  for (FallingBall* ball : {&left_alone, &changed, &there_and_back}) ball->advance(20);
  EXPECT_FALSE(changed.simulation().divergence());
  const auto apart = [&](FallingBall& other) {
    double most = 0;
    const ParticleArrays a = left_alone.simulation().particles(),
                         b = other.simulation().particles();
    for (std::size_t q = 0; q < a.x.size(); ++q) most = std::max(most, (a.x[q] - b.x[q]).norm());
    return most;
  };
  EXPECT_GT(apart(changed), 1e-4);
  EXPECT_LE(apart(there_and_back), 1e-6);
}

TEST(IsochoricFlow, SavedStatesContinueToTheBit) {
  FallingBall through(1), resumed(2);
  through.advance(60);
  resumed.simulation().restore(through.simulation().save());
  through.advance(30), resumed.advance(30);
  EXPECT_EQ(resumed.simulation().state_hash(), through.simulation().state_hash());
  EXPECT_FALSE(through.simulation().divergence());
}

/// Its J_P is no volume: snow that was sheared under pressure is not taken for ice.
TEST(IsochoricFlow, HardSnowIsNotTakenForDenseSnow) {
  for (const double rule : {cam_clay::radial, cam_clay::isochoric}) {
    Material m = clay();
    m.own[cam_clay::flow] = rule;
    ParticleArrays p = ball_of_snow({0, 0.11, 0}, 0.05, 0.01, {0, 0, 0});
    p.J_P.assign(p.x.size(), 0.3);
    const Simulation simulation(SolverSettings{}, {m}, {}, p, 1);
    EXPECT_EQ(simulation.summary().denser_than_ice > 0, rule == cam_clay::radial);
  }
}

/// Walls press to 60 %: the isochoric rule packs only where the ellipse has followed the pressure
/// to its tip, where no shear is left, so walls bear what the plate bears. The radial one keeps the
/// shear of its flow; real snow has 0.3 to 0.5 of the axial stress sideways.
TEST(IsochoricFlow, PressedSnowBearsAsMuchSidewaysAsDown) {
  Sample<double> isochoric(isochoric_clay()), radial(clay());
  const Mat3d press = Vec3d(0, -5e-4, 0).asDiagonal();
  for (int k = 0; k < 1000; ++k) {
    isochoric.strain(press);
    radial.strain(press);
  }
  const auto sideways = [](const Mat3d& tau) { return tau(0, 0) / tau(1, 1); };
  EXPECT_NEAR(sideways(isochoric.tau()), 1, 0.05);
  EXPECT_NEAR(sideways(radial.tau()), 0.31, 0.02);
}

}  // namespace
