#pragma once
/// The manufactured solution: u = A sin(2 pi X) sin(pi c t) in a periodic neo-Hookean medium, held
/// in motion by the body force that it needs.

#include <numbers>

#include "sim/laws/list.h"
#include "tests/support/elastic.h"

namespace neve::test {

struct ManufacturedCase {
  Transfer transfer = Transfer::flip;
  Kernel kernel = Kernel::cubic;
  sim::Advect advect = sim::Advect::particle;
  double flip_ratio = 1;
  double amplitude = 0.05;  ///< A, m: strains up to 2 pi A = 31 %
  sim::Precision precision = sim::Precision::real64;

  std::string label() const {
    std::string text = name(transfer);
    if (transfer == Transfer::flip) {
      text += flip_ratio == 1 ? " 1.0" : " 0.95";
      text += advect == sim::Advect::pic ? ", moved by the grid" : ", moved by v_p";
    }
    return text + ", " + name(kernel);
  }
};

/// Applies a body force of v = dt b on the nodes to FLIP particles: P2G, then G2P. A PIC step
/// without stress does just that.
inline std::vector<Vec3d> smoothed_by_grid(sim::SolverSettings settings, const sim::Material& m,
                                           const ParticleArrays& p, const std::vector<Vec3d>& v) {
  settings.flip_ratio = 0;
  ParticleArrays unstressed = p;
  unstressed.v = v;
  unstressed.F_E.assign(p.x.size(), Mat3d::Identity());
  sim::Simulation simulation(settings, {m}, {}, unstressed, 1);
  simulation.step(1e-9);
  return simulation.particles().v;
}

/// One step with a body force b per mass, dt b given for each particle. It enters as v += dt b in a
/// simulation that is rebuilt from the particles: nothing but their rounding (1e-16) is lost.
/// FLIP particles then get back what they would have gathered from the nodes instead.
inline ParticleArrays forced_step(const sim::SolverSettings& s, const sim::Material& material,
                                  ParticleArrays p, const std::vector<Vec3d>& dt_b, double dt) {
  std::vector<Vec3d> correction(p.x.size(), Vec3d::Zero());
  if (s.transfer == Transfer::flip) {
    const std::vector<Vec3d> gathered = smoothed_by_grid(s, material, p, dt_b);
    for (std::size_t q = 0; q < p.x.size(); ++q)
      correction[q] = s.flip_ratio * (gathered[q] - dt_b[q]);
  }
  for (std::size_t q = 0; q < p.x.size(); ++q) p.v[q] += dt_b[q];
  sim::Simulation simulation(s, {material}, {}, p, 1);
  simulation.step(dt);
  p = simulation.particles();
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    p.v[q] += correction[q];
    if (s.advect == sim::Advect::particle) p.x[q] += dt * correction[q];
  }
  return p;
}

/// Largest rms error of the displacement over half a period, in units of A.
inline double manufactured_error(const ManufacturedCase& c, int cells) {
  constexpr double density = 1000, E = 1e4, nu = 0.3, k = 2 * std::numbers::pi;
  const sim::Material material = elastic(E, nu, density, sim::laws::model::neo_hookean);
  const sim::Lame l = sim::lame(E, nu);
  const double speed = std::sqrt(E / density), omega = std::numbers::pi * speed, A = c.amplitude;
  sim::SolverSettings s;
  s.cell_size = 1.0 / cells;
  s.kernel = c.kernel;
  s.transfer = c.transfer;
  s.advect = c.advect;
  s.flip_ratio = c.flip_ratio;
  s.flip_reference_dt = 0;
  s.precision = c.precision;
  s.gravity.setZero();
  s.period = {cells / 4, 1, 1};
  const double width = 4 * s.cell_size;
  ParticleArrays p = lattice(Vec3d::Zero(), {1, width, width}, {2 * cells, 4, 4}, density);
  const std::vector<Vec3d> X = p.x;
  p.C.assign(X.size(), Mat3d::Zero());
  for (std::size_t q = 0; q < X.size(); ++q) {
    p.v[q][0] = A * omega * std::sin(k * X[q][0]);
    p.C[q](0, 0) = A * omega * k * std::cos(k * X[q][0]);
  }
  const double end = 1 / speed;
  const int steps =
      static_cast<int>(std::ceil(end / (0.1 * s.cell_size / sim::sound_speed(material))));
  const double dt = end / steps;
  std::vector<Vec3d> dt_b(X.size(), Vec3d::Zero());
  double worst = 0;
  for (int n = 0; n < steps; ++n) {
    const double now = std::sin(omega * n * dt), then = std::sin(omega * (n + 1) * dt);
    for (std::size_t q = 0; q < X.size(); ++q) {
      // b = u_tt - dP/dX / rho0, with P = mu (F - 1/F) + lambda ln F / F.
      const double sine = std::sin(k * X[q][0]);
      const double F = 1 + A * k * std::cos(k * X[q][0]) * now;
      const double slope = l.mu * (1 + 1 / (F * F)) + l.lambda * (1 - std::log(F)) / (F * F);
      dt_b[q][0] = dt * A * sine * now * (slope * k * k / density - omega * omega);
    }
    p = forced_step(s, material, std::move(p), dt_b, dt);
    double sum = 0;
    for (std::size_t q = 0; q < X.size(); ++q) {
      const double error = p.x[q][0] - X[q][0] - A * std::sin(k * X[q][0]) * then;
      sum += error * error;
    }
    worst = std::max(worst, std::sqrt(sum / static_cast<double>(X.size())) / A);
  }
  return worst;
}

}  // namespace neve::test
