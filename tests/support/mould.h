#pragma once
/// Snow pressed in a mould without friction, and held there: uniaxial compression by contact alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "sim/kernels/particle_contact.h"
#include "tests/support/compression.h"
#include "tests/support/elastic.h"
#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace neve::test {

struct Mould {
  sim::SolverSettings settings;
  int cells = 6;          ///< width and height of the snow
  double stretch = 0.6;   ///< of its height, at the end of the press
  double seconds = 0.12;  ///< that the press takes
  sim::Material snow{};

  double side() const { return cells * settings.cell_size; }
  /// Returns the distance of the outermost particles on opposite sides, m.
  double height() const { return side() - 0.5 * settings.cell_size; }
};

inline Mould mould_of(sim::Transfer transfer, sim::Kernel kernel, sim::Advect advect) {
  Mould mould;
  mould.settings.transfer = transfer;
  mould.settings.kernel = kernel;
  mould.settings.advect = advect;
  mould.settings.gravity.setZero();
  return mould;
}

inline std::string in_words(const sim::SolverSettings& s) {
  return name(s.transfer) + " " + name(s.kernel) +
         (s.transfer == Transfer::flip && s.advect == sim::Advect::pic ? ", moved by the grid"
                                                                       : "") +
         (s.beta > 0 ? ", beta = " + in_digits(s.beta) : "");
}

/// Returns all moulds; in the semi-implicit one, sound crosses three cells in a step.
inline std::vector<Mould> moulds() {
  std::vector<Mould> list{mould_of(Transfer::apic, Kernel::cubic, sim::Advect::particle),
                          mould_of(Transfer::asflip, Kernel::cubic, sim::Advect::particle),
                          mould_of(Transfer::mls, Kernel::quadratic, sim::Advect::particle),
                          mould_of(Transfer::flip, Kernel::cubic, sim::Advect::pic)};
  list.push_back(list.front());
  list.back().settings.beta = 1;
  list.back().settings.max_dt = 5e-4;
  return list;
}

/// Floor, four walls and a plate that comes down. All of them just touch the snow at the start, so
/// that it is strained by what the plate moves, and along y alone. The snow's first corner is 0.3
/// cells off the nodes along each axis.
inline std::vector<sim::shapes::Collider> walls_of(const Mould& mould) {
  const double h = mould.settings.cell_size, side = mould.side();
  const double inside = 0.25 * h - sim::kernels::touching_share * 0.25 * h;
  const double low = 0.3 * h + inside, high = 0.3 * h + side - inside;
  std::vector<sim::shapes::Collider> walls{
      plane({0, low, 0}, {0, 1, 0}, 0), plane({low, 0, 0}, {1, 0, 0}, 0),
      plane({high, 0, 0}, {-1, 0, 0}, 0), plane({0, 0, low}, {0, 0, 1}, 0),
      plane({0, 0, high}, {0, 0, -1}, 0)};
  const double thick = 5 * h, middle = 0.5 * (low + high);
  const sim::Vec3d above{middle, high + thick / 2, middle};
  const sim::Vec3d down = above - sim::Vec3d(0, (1 - mould.stretch) * mould.height(), 0);
  sim::shapes::Collider plate;
  plate.friction = 0;
  plate.shape.form = sim::shapes::Box{above, {3 * side, thick, 3 * side}};
  plate.keyframes = {
      {0, above, std::nullopt}, {mould.seconds, down, std::nullopt}, {9, down, std::nullopt}};
  walls.push_back(plate);
  return walls;
}

/// Eight a cell, on a lattice.
inline ParticleArrays snow_in(const Mould& mould) {
  const Vec3d low = Vec3d::Constant(0.3 * mould.settings.cell_size);
  const int n = 2 * mould.cells;
  return lattice(low, low + Vec3d::Constant(mould.side()), {n, n, n}, mould.snow.density);
}

struct Pressed {
  double J_P = 1;    ///< median of the middle half of the height
  double sigma = 0;  ///< Pa, mean axial Cauchy stress there
  double force = 0;  ///< N, on the plate along y, mean since the last look
};

inline Pressed pressed(const sim::Simulation& simulation) {
  const ParticleArrays p = simulation.particles();
  const std::vector<Mat3d> tau = simulation.kirchhoff();
  double low = 1e300, high = -1e300;
  for (const Vec3d& x : p.x) low = std::min(low, x[1]), high = std::max(high, x[1]);
  std::vector<double> J_P;
  Pressed out;
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    const double at = (p.x[q][1] - low) / (high - low);
    if (at < 0.25 || at > 0.75) continue;
    J_P.push_back(p.J_P[q]);
    out.sigma += tau[q](1, 1) / (p.F_E[q].determinant() * p.J_P[q]);
  }
  out.sigma /= static_cast<double>(J_P.size());
  std::nth_element(J_P.begin(), J_P.begin() + static_cast<std::ptrdiff_t>(J_P.size() / 2),
                   J_P.end());
  out.J_P = J_P[J_P.size() / 2];
  return out;
}

/// Presses a mould and returns its snow at each of some times.
inline std::vector<Pressed> run_mould(const Mould& mould, const std::vector<double>& times,
                                      int threads = 1) {
  sim::Simulation simulation(mould.settings, {mould.snow}, walls_of(mould), snow_in(mould),
                             threads);
  std::vector<Pressed> found;
  double before = 0;
  for (const double time : times) {
    const sim::AdvanceReport report = simulation.advance_to(time);
    EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
    found.push_back(pressed(simulation));
    if (!report.loads.empty()) found.back().force = report.loads[5].impulse[1] / (time - before);
    before = time;
  }
  return found;
}

}  // namespace neve::test
