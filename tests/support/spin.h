#pragma once
/// A cube that spins and vibrates in free flight.

#include <Eigen/Geometry>

#include "tests/support/elastic.h"

namespace neve::test {

struct SpinCase {
  Transfer transfer = Transfer::flip;
  Kernel kernel = Kernel::cubic;
  double flip_ratio = 1;
  double flip_reference_dt = 0;  ///< s
  double cfl = 0.2;              ///< c dt / h
  sim::Precision precision = sim::Precision::real64;

  std::string label() const {
    std::string text = name(transfer);
    if (transfer == Transfer::flip)
      text += std::string(flip_ratio == 1 ? " 1.0" : " 0.95") +
              (flip_reference_dt > 0 ? " per 0.5 ms" : "");
    return text + ", " + name(kernel) + (precision == sim::Precision::single ? ", float" : "");
  }
};

struct SpinResult {
  double energy;          ///< kinetic and elastic after 0.5 s, in units of the start's
  double largest_energy;  ///< on the way
  double momentum;        ///< angular, after 0.5 s, in units of the start's
  double momentum_error;  ///< largest change of the vector on the way, in the same unit
};

inline SpinResult spin_cube(const SpinCase& c) {
  sim::SolverSettings s;
  s.cell_size = 0.05;
  s.transfer = c.transfer;
  s.kernel = c.kernel;
  s.flip_ratio = c.flip_ratio;
  s.flip_reference_dt = c.flip_reference_dt;
  s.precision = c.precision;
  s.gravity.setZero();
  const sim::Material m = elastic(2e4, 0.3, 400);
  ParticleArrays p = lattice(Vec3d::Constant(-0.1), Vec3d::Constant(0.1), {8, 8, 8}, m.density);
  // Spins about x at 4 rad/s while it stretches along x and narrows.
  const Mat3d A{{3, 0, 0}, {0, -1.5, -4}, {0, 4, -1.5}};
  for (std::size_t q = 0; q < p.x.size(); ++q) p.v[q] = A * p.x[q];
  p.C.assign(p.x.size(), A);
  sim::Simulation simulation(s, {m}, {}, p, 1);
  const sim::Summary start = simulation.summary();
  const double dt = c.cfl * s.cell_size / sim::sound_speed(m);
  SpinResult r{1, 1, 1, 0};
  for (int n = 0, steps = static_cast<int>(0.5 / dt); n < steps; ++n) {
    simulation.step(dt);
    if (n % 8 != 0 && n != steps - 1) continue;
    const sim::Summary now = simulation.summary();
    r.energy = (now.kinetic_energy + now.elastic_energy) / start.kinetic_energy;
    r.largest_energy = std::max(r.largest_energy, r.energy);
    r.momentum = now.angular_momentum[0] / start.angular_momentum[0];
    r.momentum_error =
        std::max(r.momentum_error, (now.angular_momentum - start.angular_momentum).norm() /
                                       start.angular_momentum.norm());
  }
  return r;
}

}  // namespace neve::test
