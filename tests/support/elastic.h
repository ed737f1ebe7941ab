#pragma once
/// Elastic bodies and how they ring.

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "sim/laws/list.h"
#include "sim/simulation.h"

namespace neve::test {

using sim::Kernel;
using sim::Mat3d;
using sim::ParticleArrays;
using sim::Transfer;
using sim::Vec3d;

inline std::string name(Transfer transfer) {
  static constexpr const char* names[] = {"FLIP", "APIC", "MLS", "AFLIP", "ASFLIP"};
  return names[static_cast<int>(transfer)];
}
inline std::string name(Kernel kernel) {
  return kernel == Kernel::cubic ? "cubic" : "quadratic";
}
inline std::string name(sim::Precision precision) {
  return precision == sim::Precision::single ? "float" : "double";
}

inline sim::Material elastic(double youngs_modulus, double poisson_ratio, double density,
                             sim::Model model = sim::laws::model::corotated) {
  sim::Material m;
  m.name = "elastic";
  m.model = model;
  m.youngs_modulus = youngs_modulus;
  m.poisson_ratio = poisson_ratio;
  m.density = density;
  m.hardening = 0;
  return m;
}

/// n particles in the centres of equal boxes that fill [min, max], at rest.
inline ParticleArrays lattice(const Vec3d& min, const Vec3d& max, const std::array<int, 3>& n,
                              double density) {
  ParticleArrays p;
  const Vec3d d = (max - min).cwiseQuotient(Vec3d(n[0], n[1], n[2]));
  for (int i = 0; i < n[0]; ++i)
    for (int j = 0; j < n[1]; ++j)
      for (int k = 0; k < n[2]; ++k)
        p.x.push_back(min + d.cwiseProduct(Vec3d(i + 0.5, j + 0.5, k + 0.5)));
  p.v.assign(p.x.size(), Vec3d::Zero());
  p.V0.assign(p.x.size(), d.prod());
  p.m.assign(p.x.size(), density * d.prod());
  return p;
}

/// A damped oscillation e^(-decay t) cos(omega t + phase).
struct Oscillation {
  double omega;  ///< rad/s
  double decay;  ///< 1/s
};

/// The oscillation in equally spaced samples (Prony's method with one pair of roots): samples that
/// are a sixteenth of a period apart obey y'' = p y' + q y, and p, q are fitted by least squares.
/// @param about_omega rad/s, for choosing that distance only
inline Oscillation fit_oscillation(const std::vector<double>& samples, double dt,
                                   double about_omega) {
  const auto stride = static_cast<std::size_t>(std::max(1.0, std::floor(0.4 / (about_omega * dt))));
  const auto rows = static_cast<Eigen::Index>(samples.size() - 2 * stride);
  Eigen::MatrixXd past(rows, 2);
  Eigen::VectorXd next(rows);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const auto n = static_cast<std::size_t>(r);
    past.row(r) << samples[n + stride], samples[n];
    next[r] = samples[n + 2 * stride];
  }
  const Eigen::Vector2d pq = past.colPivHouseholderQr().solve(next);
  const std::complex<double> root =
      0.5 * (pq[0] + std::sqrt(std::complex<double>(pq[0] * pq[0] + 4 * pq[1])));
  const std::complex<double> rate = std::log(root) / (static_cast<double>(stride) * dt);
  return {std::abs(rate.imag()), -rate.real()};
}

/// log2 of the ratio of two errors, the second at half the cell size.
inline double order(double coarse, double fine) {
  return std::log2(coarse / fine);
}

}  // namespace neve::test
