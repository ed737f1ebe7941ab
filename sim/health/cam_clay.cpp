#include "sim/health/cam_clay.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/kernels/cam_clay.h"

namespace neve::sim::health::cam_clay {

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

/// det F_E, of an inverted one that of its mirror image, and the isochoric b.
struct Strain {
  double J;
  Mat3d b;

  explicit Strain(const Mat3d& F_E)
      : J(std::max(std::abs(F_E.determinant()), 1e-12)),
        b(std::pow(J, -2.0 / 3) * F_E * F_E.transpose()) {}
  double mean() const { return b.trace() / 3; }
  Mat3d deviator() const { return b - mean() * Mat3d::Identity(); }
};

double shear_modulus(const Material& m) {
  return lame(m.youngs_modulus, m.poisson_ratio).mu;
}

}  // namespace

double critical_slope(double friction_angle) {
  const double sine = std::sin(friction_angle * degree);
  return 6 * sine / (3 - sine);
}

double friction_angle(double critical_slope) {
  return std::asin(3 * critical_slope / (6 + critical_slope)) / degree;
}

double bulk_modulus(const Material& m) {
  const Lame l = lame(m.youngs_modulus, m.poisson_ratio);
  return l.lambda + 2.0 / 3 * l.mu;
}

double alpha0(const Material& m) {
  const double share = m.consolidation_pressure / bulk_modulus(m) - kernels::min_strength;
  return -std::asinh(std::max(share, 0.0)) / m.consolidation_hardening;
}

double p0(const Material& m, double J_P) {
  const double packed = std::max(-(alpha0(m) + std::log(J_P)), 0.0);
  const double x = std::min(m.consolidation_hardening * packed, kernels::max_consolidation);
  return m.strength * bulk_modulus(m) * (kernels::min_strength + std::sinh(x));
}

double nearness_to_yield(const Material& m, const Mat3d& F_E, double J_P) {
  const Strain strain(F_E);
  const double top = p0(m, J_P), beta = m.cohesion, M = critical_slope(m.friction_angle);
  const double p = 0.5 * bulk_modulus(m) * (1 - strain.J * strain.J);
  const double q = std::sqrt(1.5) * shear_modulus(m) * strain.deviator().norm();
  const double across = M * (p - 0.5 * (1 - beta) * top);
  return std::sqrt(across * across + (1 + 2 * beta) * q * q) / (M * 0.5 * (1 + beta) * top);
}

double energy_density(const Material& m, const Mat3d& F_E) {
  const Strain strain(F_E);
  return 0.5 * shear_modulus(m) * (strain.b.trace() - 3) +
         0.5 * bulk_modulus(m) * (0.5 * (strain.J * strain.J - 1) - std::log(strain.J));
}

Mat3d first_piola(const Material& m, const Mat3d& F_E) {
  const Strain strain(F_E);
  const Mat3d tau = shear_modulus(m) * strain.deviator() +
                    0.5 * bulk_modulus(m) * (strain.J * strain.J - 1) * Mat3d::Identity();
  return tau * F_E.inverse().transpose();
}

double wave_modulus(const Material& m, const Mat3d& F_E) {
  const Strain strain(F_E);
  const double least =
      Eigen::SelfAdjointEigenSolver<Mat3d>(strain.b, Eigen::EigenvaluesOnly).eigenvalues()[0];
  return 0.5 * bulk_modulus(m) * (1 + strain.J * strain.J) +
         shear_modulus(m) * (5 * strain.mean() - least) / 3;
}

Limits limits(const Material& m, double J_P) {
  const double K = bulk_modulus(m), top = p0(m, J_P), beta = m.cohesion;
  return {.pressure = std::min(top, 0.5 * K),
          .tension = beta * top,
          .deviator =
              critical_slope(m.friction_angle) * 0.5 * (1 + beta) * top / std::sqrt(1 + 2 * beta),
          .min_J = std::sqrt(std::max(1 - 2 * top / K, 0.0)),
          .max_J = std::sqrt(1 + 2 * beta * top / K)};
}

}  // namespace neve::sim::health::cam_clay
