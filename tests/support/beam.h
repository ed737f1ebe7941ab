#pragma once
/// An elastic beam that sags by its weight.

#include <cmath>
#include <vector>

#include "tests/support/elastic.h"
#include "tests/support/snow.h"

namespace neve::test {

/// It sticks out from a sticky wall.
struct Beam {
  double root = 0.06;  ///< m inside the wall; 0: only its end is glued to it
  double cell_size = 0.03;
  double length = 0.3, thickness = 0.12, density = 400, youngs_modulus = 5e5;

  /// Returns the sag of the middle of its last cell by Timoshenko, m: bending and shear of a square
  /// section (shear factor 5/6), nu = 0.
  double sag() const {
    const double T2 = thickness * thickness, q = density * 9.81 * T2;
    const double x = length - cell_size / 2, x2 = x * x, L = length;
    const double bending = q * x2 * (x2 - 4 * L * x + 6 * L * L) / (2 * youngs_modulus * T2 * T2);
    return bending + q * x * (L - x / 2) / (5.0 / 6 * youngs_modulus / 2 * T2);
  }
};

/// Sag of the last cell of the beam at each of some times, m.
inline std::vector<double> sags(const Beam& beam, const std::vector<double>& times) {
  sim::SolverSettings s;
  s.cell_size = beam.cell_size;
  s.transfer = Transfer::flip;
  s.flip_ratio = 0.5;  // at rest soon
  const double half = beam.thickness / 2;
  const double spacing = s.cell_size / 2;
  const int across = static_cast<int>(std::lround(beam.thickness / spacing));
  const int along = static_cast<int>(std::lround((beam.length + beam.root) / spacing));
  const ParticleArrays p = lattice({-beam.root, -half, -half}, {beam.length, half, half},
                                   {along, across, across}, beam.density);
  sim::Simulation simulation(s, {elastic(beam.youngs_modulus, 0, beam.density)},
                             {plane({0, 0, 0}, {1, 0, 0}, 0, sim::shapes::Contact::sticky)}, p, 1);
  std::vector<double> found;
  for (const double time : times) {
    simulation.advance_to(time);
    const ParticleArrays now = simulation.particles();
    double sag = 0, count = 0;
    for (std::size_t q = 0; q < p.x.size(); ++q) {
      if (p.x[q][0] < beam.length - s.cell_size) continue;
      sag += p.x[q][1] - now.x[q][1];
      ++count;
    }
    found.push_back(sag / count);
  }
  return found;
}

}  // namespace neve::test
