#pragma once
/// A cube that spins and vibrates in free flight.

#include <Eigen/Geometry>

#include "tests/support/elastic.h"
#include "tests/support/snow.h"

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
    if (transfer != Transfer::apic && transfer != Transfer::mls)
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

struct BallSpin {
  double momentum;        ///< angular, about the axis, after half a second, in units of the start's
  double largest_energy;  ///< kinetic and elastic, on the way, in units of the start's
};

/// A ball of the paper's snow that turns at 8 rad/s in free flight, as a scene would have it:
/// adaptive steps, float.
inline BallSpin spin_ball(Transfer transfer, Kernel kernel, double radius_in_cells) {
  constexpr double cell = 0.02;
  sim::SolverSettings s;
  s.cell_size = cell;
  s.transfer = transfer;
  s.kernel = kernel;
  s.gravity.setZero();
  const double R = radius_in_cells * cell;
  ParticleArrays p = ball_of_snow({0.003, 0.604, -0.002}, R, cell / 2, {0, 0, 0});
  for (std::size_t q = 0; q < p.x.size(); ++q)
    p.v[q] = Vec3d(0, 0, 8).cross(p.x[q] - Vec3d(0.003, 0.604, -0.002));
  sim::Simulation simulation(s, {sim::Material{}}, {}, p, 1);
  const sim::Summary start = simulation.summary();
  BallSpin r{1, 1};
  for (int k = 1; k <= 10; ++k) {
    simulation.advance_to(0.05 * k);
    const sim::Summary now = simulation.summary();
    r.momentum = now.angular_momentum[2] / start.angular_momentum[2];
    r.largest_energy = std::max(r.largest_energy,
                                (now.kinetic_energy + now.elastic_energy) / start.kinetic_energy);
  }
  return r;
}

}  // namespace neve::test
