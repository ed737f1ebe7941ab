#pragma once
/// Uniaxial strain of the paper's snow: the formula, the material alone, a column in the solver.

#include <Eigen/LU>

#include "tests/support/elastic.h"
#include "tests/support/snow.h"

namespace neve::test {

struct UniaxialState {
  double J_P, hardening, sigma;  ///< axial Cauchy stress, Pa
};

/// F = diag(1, s, 1), s < 1, reached by compression only. Elastic down to 1 - theta_c; then F_E
/// stays there, and J_P = s / (1 - theta_c) hardens.
inline UniaxialState uniaxial_formula(const sim::Material& m, double s) {
  const sim::Lame l = sim::lame(m.youngs_modulus, m.poisson_ratio);
  const double s_E = std::max(s, 1 - m.critical_compression), J_P = s / s_E;
  const double hardening = std::exp(m.hardening * (1 - J_P));
  return {J_P, hardening,
          hardening / s * (2 * l.mu * (s_E - 1) * s_E + l.lambda * (s_E - 1) * s_E)};
}

/// Compresses particles without moving them: APIC carries the affine velocity exactly, and within
/// 1e-9 s no force changes it. So each step multiplies F by diag(1, ratio, 1), then the material
/// projects and hardens.
class Press {
 public:
  Press(const sim::Material& m, sim::Precision precision) : material_(m) {
    settings_.cell_size = 1;
    settings_.transfer = Transfer::apic;
    settings_.shock_viscosity = 0;  // the law alone
    settings_.precision = precision;
    settings_.gravity.setZero();
    particles_ = lattice(Vec3d::Zero(), Vec3d::Constant(2), {4, 4, 4}, m.density);
    x_ = particles_.x;
  }

  void compress(double ratio) {
    const double dt = 1e-9;
    const Mat3d A = Vec3d(0, (ratio - 1) / dt, 0).asDiagonal();
    particles_.x = x_;
    for (std::size_t q = 0; q < x_.size(); ++q) particles_.v[q] = A * (x_[q] - Vec3d::Ones());
    particles_.C.assign(x_.size(), A);
    sim::Simulation simulation(settings_, {material_}, {}, particles_, 1);
    simulation.step(dt);
    particles_ = simulation.particles();
    tau_ = simulation.kirchhoff();
    stretch_ *= ratio;
  }

  double stretch() const { return stretch_; }
  UniaxialState state() const {
    const double J_P = particles_.J_P[0], J = particles_.F_E[0].determinant() * J_P;
    return {J_P, std::exp(material_.hardening * (1 - J_P)), tau_[0](1, 1) / J};
  }

 private:
  sim::Material material_;
  sim::SolverSettings settings_;
  ParticleArrays particles_;
  std::vector<Vec3d> x_;
  std::vector<Mat3d> tau_;
  double stretch_ = 1;
};

}  // namespace neve::test
