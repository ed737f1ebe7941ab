#pragma once
/// Two equal elastic balls head on (Sulsky's discs in three dimensions).

#include "tests/support/elastic.h"

namespace neve::test {

struct BallsCase {
  Transfer transfer = Transfer::flip;
  Kernel kernel = Kernel::cubic;
  double flip_ratio = 0.95;
  sim::Precision precision = sim::Precision::real64;
  sim::Advect advect = sim::Advect::particle;

  std::string label() const {
    const bool has_ratio = transfer != Transfer::apic && transfer != Transfer::mls;
    return name(transfer) + (has_ratio ? (flip_ratio == 1 ? " 1.0" : " 0.95") : "") + ", " +
           name(kernel) + (advect == sim::Advect::pic ? ", moved by the grid" : "") +
           (precision == sim::Precision::single ? ", float" : "");
  }
};

/// Energies in units of the kinetic energy at the start.
struct BallsHistory {
  struct Sample {
    double time, kinetic, elastic;
  };
  std::vector<Sample> samples;
  double largest_momentum = 0;  ///< of the pair, in units of one ball's at the start
  double min_kinetic = 1;       ///< at the turning point
  double largest_elastic = 0;   ///< somewhere near it
  double largest_total = 1;     ///< energy from nowhere?
  double final_total = 0;       ///< kinetic and elastic, after 0.6 s
  double rebound = 0;           ///< final velocity of the right ball / speed of approach
};

inline BallsHistory collide_balls(const BallsCase& c) {
  constexpr double density = 1000, R = 0.2, speed = 0.5, dt = 1e-3;
  sim::SolverSettings s;
  s.cell_size = 0.05;
  s.transfer = c.transfer;
  s.kernel = c.kernel;
  s.flip_ratio = c.flip_ratio;
  s.advect = c.advect;
  s.flip_reference_dt = 0;
  s.precision = c.precision;
  s.gravity.setZero();
  const ParticleArrays cube =
      lattice(Vec3d::Constant(-R), Vec3d::Constant(R), {16, 16, 16}, density);
  ParticleArrays p;
  for (const double side : {-1.0, 1.0})
    for (std::size_t q = 0; q < cube.x.size(); ++q) {
      if (!(cube.x[q].squaredNorm() < R * R)) continue;
      p.x.push_back(cube.x[q] + Vec3d(side * 0.26, 0, 0));
      p.v.push_back(Vec3d(-side * speed, 0, 0));
      p.m.push_back(cube.m[q]);
      p.V0.push_back(cube.V0[q]);
    }
  sim::Simulation simulation(s, {elastic(2e4, 0.3, density)}, {}, p, 1);
  const sim::Summary start = simulation.summary();
  const double energy = start.kinetic_energy, momentum = 0.5 * start.mass * speed;
  BallsHistory history;
  history.samples.push_back({0, 1, 0});
  for (int n = 0; n < 600; ++n) {
    simulation.step(dt);
    if (n % 5 != 4) continue;
    const sim::Summary now = simulation.summary();
    const double kinetic = now.kinetic_energy / energy, elastic = now.elastic_energy / energy;
    history.samples.push_back({now.time, kinetic, elastic});
    history.largest_momentum = std::max(history.largest_momentum, now.momentum.norm() / momentum);
    history.min_kinetic = std::min(history.min_kinetic, kinetic);
    history.largest_elastic = std::max(history.largest_elastic, elastic);
    history.largest_total = std::max(history.largest_total, kinetic + elastic);
    history.final_total = kinetic + elastic;
  }
  const std::vector<Vec3d> v = simulation.particles().v;
  double sum = 0;
  for (std::size_t q = v.size() / 2; q < v.size(); ++q) sum += v[q][0];
  history.rebound = sum / (0.5 * static_cast<double>(v.size())) / speed;
  return history;
}

}  // namespace neve::test
