/// Snow that hits a wall: the jump conditions say how far it is packed and with which pressure, and
/// the viscosity that spreads its shock over cells is a closed formula.

#include <algorithm>

#include "tests/support/compression.h"
#include "tests/support/elastic.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// The state behind a shock, from the conservation of mass and momentum across it: p = rho0 v^2 /
/// (1 - s), with the pressure p of uniaxial compression to s. The shock runs through the snow at v
/// / (1 - s).
struct Shock {
  double v, s, J_P, p;
  double speed() const { return v / (1 - s); }
};

Shock exact_shock(const Material& snow, double v) {
  double low = 0.15, high = 1 - snow.critical_compression;
  for (int round = 0; round < 60; ++round) {
    const double s = 0.5 * (low + high);
    (-uniaxial_formula(snow, s).sigma > snow.density * v * v / (1 - s) ? low : high) = s;
  }
  const UniaxialState behind = uniaxial_formula(snow, low);
  return {v, low, behind.J_P, -behind.sigma};
}

struct Impact {
  double J_P = 1;      ///< behind the shock, median
  double p = 0;        ///< Pa, on the wall, mean while the shock crosses half of the snow
  double fastest = 0;  ///< m/s, of snow that comes back from the wall
};

/// A column of 40 cells, periodic across: uniaxial strain without walls beside it.
Impact hit_wall(SolverSettings s, const Material& snow, const Shock& shock) {
  constexpr int cells = 40, across = 4;
  s.cell_size = 0.0125;
  s.gravity.setZero();
  s.period = {1, 0, 1};
  const double width = across * s.cell_size, length = cells * s.cell_size;
  ParticleArrays p =
      lattice({0, 0, 0}, {width, length, width}, {2 * across, 2 * cells, 2 * across}, snow.density);
  for (Vec3d& v : p.v) v = {0, -shock.v, 0};
  Simulation simulation(s, {snow}, {plane({0, 0, 0}, {0, 1, 0}, 0)}, p, 1);
  const double crossing = length / shock.speed();
  simulation.advance_to(0.3 * crossing);
  const AdvanceReport report = simulation.advance_to(0.8 * crossing);
  EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  Impact found;
  found.p = -report.loads.at(0).impulse[1] / (0.5 * crossing) / (width * width);
  const ParticleArrays now = simulation.particles();
  std::vector<double> J_P;
  for (std::size_t q = 0; q < p.x.size(); ++q)
    if (p.x[q][1] > 0.2 * length && p.x[q][1] < 0.6 * length) J_P.push_back(now.J_P[q]);
  const auto middle = J_P.begin() + static_cast<std::ptrdiff_t>(J_P.size() / 2);
  std::nth_element(J_P.begin(), middle, J_P.end());
  found.J_P = *middle;
  simulation.advance_to(2 * crossing);
  for (const Vec3d& v : simulation.particles().v) found.fastest = std::max(found.fastest, v[1]);
  return found;
}

struct Scheme {
  Transfer transfer;
  Kernel kernel;
};

std::vector<Scheme> schemes() {
  return {{Transfer::asflip, Kernel::cubic},
          {Transfer::asflip, Kernel::quadratic},
          {Transfer::flip, Kernel::cubic},
          {Transfer::apic, Kernel::cubic},
          {Transfer::mls, Kernel::quadratic}};
}

TEST(Shock, ImpactsPackSnowAsTheJumpConditionsSay) {
  for (const double v : {5.0, 20.0, 40.0}) {
    const Shock exact = exact_shock(Material{}, v);
    for (const auto& [transfer, kernel] : schemes()) {
      SolverSettings s;
      s.transfer = transfer;
      s.kernel = kernel;
      const Impact found = hit_wall(s, Material{}, exact);
      const std::string line = name(transfer) + " " + name(kernel) + ", " + in_digits(v) + " m/s";
      // The profile of the shock is three cells of the 16 that count. Without viscosity J_P is 2 to
      // 14 % too small.
      verify_ratio({"shock", line, "J_P behind the shock"}, exact.J_P, found.J_P, 0.015);
      // FLIP's pressure on the wall swings by a tenth, and the mean keeps some of it.
      verify_ratio({"shock", line, "pressure on the wall, kPa"}, exact.p / 1e3, found.p / 1e3,
                   transfer == Transfer::flip ? 0.05 : 0.025);
    }
  }
}

/// Steps that sound crosses 0.85 cells in, as of fast looks, leave less room for viscosity.
TEST(Shock, LongStepsAreStableAndNearlyAsRight) {
  const Shock exact = exact_shock(Material{}, 40);
  for (const auto& [transfer, kernel] : schemes()) {
    SolverSettings s;
    s.transfer = transfer;
    s.kernel = kernel;
    s.acoustic_cfl = 0.85;
    const Impact found = hit_wall(s, Material{}, exact);
    const std::string line = name(transfer) + " " + name(kernel) + ", acoustic_cfl = 0.85, 40 m/s";
    verify_ratio({"shock", line, "J_P behind the shock"}, exact.J_P, found.J_P, 0.025);
    // Snow leaves a wall by what is elastic of its strain, 5.9 m/s.
    verify_at_most({"shock", line, "fastest snow after it, m/s"}, 12, found.fastest);
  }
}

TEST(Shock, WithoutViscosityItIsPackedTooFar) {
  const Shock exact = exact_shock(Material{}, 20);
  SolverSettings s;
  s.shock_viscosity = 0;
  EXPECT_LT(hit_wall(s, Material{}, exact).J_P, 0.95 * exact.J_P);
}

/// tau(share 1) - tau(share 0) of particles in a uniform velocity gradient, one small step.
Mat3d viscous_part(const Material& material, const Mat3d& grad_v, double dt, double J_P) {
  std::vector<Mat3d> tau[2];
  for (const int share : {0, 1}) {
    SolverSettings s;
    s.cell_size = 0.5;
    s.transfer = Transfer::apic;
    s.precision = Precision::real64;
    s.gravity.setZero();
    s.shock_viscosity = share;
    ParticleArrays p = lattice(Vec3d::Zero(), Vec3d::Constant(1), {4, 4, 4}, material.density);
    p.J_P.assign(p.x.size(), J_P);
    p.C.assign(p.x.size(), grad_v);
    for (std::size_t q = 0; q < p.x.size(); ++q) p.v[q] = grad_v * (p.x[q] - Vec3d::Constant(0.5));
    Simulation simulation(s, {material}, {}, p, 1);
    simulation.step(dt);
    tau[share] = simulation.kirchhoff();
  }
  return tau[1][0] - tau[0][0];
}

TEST(ShockViscosity, ItIsThePressureOfVonNeumannAndLandshoff) {
  Material snow;
  snow.critical_compression = 0.5;  // elastic in this step
  const double h = 0.5, J_P = 0.9, dt = 1e-5, hardening = std::exp(snow.hardening * (1 - J_P));
  const Mat3d grad_v = Vec3d(-3, -8, 1).asDiagonal();
  const double D = grad_v.trace(), c = sound_speed(snow) * std::sqrt(hardening);
  const double q = snow.density * h * (2.25 * h * D * D + 0.5 * c * std::abs(D));
  const Mat3d found = viscous_part(snow, grad_v, dt, J_P);
  // c is a bound of the fastest wave at strains of 1e-4.
  EXPECT_LT((found + q * Mat3d::Identity()).norm(), 2e-3 * q) << found;
}

TEST(ShockViscosity, ALongStepTakesWhatIsStable) {
  Material snow;
  snow.critical_compression = 0.5;
  const double h = 0.5, dt = 0.3 * h / sound_speed(snow), d = 0.01 / dt;
  const Mat3d grad_v = Vec3d(0, -40 * d, 0).asDiagonal();
  const double bound = snow.density * h * h / dt * 0.5 * 40 * d;
  const double found = -viscous_part(snow, grad_v, dt, 1)(1, 1);
  EXPECT_GT(found, 0.5 * bound);
  EXPECT_LT(found, bound);
}

TEST(ShockViscosity, WhatExpandsShearsOrIsElasticFeelsNone) {
  Mat3d shear = Mat3d::Zero();
  shear(0, 1) = 5;
  const Mat3d expanding = Vec3d(3, -1, -1).asDiagonal(), pressed = -2 * Mat3d::Identity();
  EXPECT_EQ(viscous_part(Material{}, expanding, 1e-5, 1).norm(), 0);
  // The trace of a sheared lattice is rounding.
  EXPECT_LT(viscous_part(Material{}, shear, 1e-5, 1).norm(), 1e-6);
  EXPECT_EQ(viscous_part(elastic(1e5, 0.2, 400), pressed, 1e-5, 1).norm(), 0);
}

}  // namespace
