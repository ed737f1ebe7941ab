/// A column of the paper's snow between a floor and a plate that comes down.

#include "tests/support/compression.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(CompressedColumnLong, CompressedColumnFollowsTheStressStrainCurve) {
  // 16 cells high, endless to the sides, pressed at 0.1 m/s (sound: 20 m/s).
  constexpr double speed = 0.1;
  constexpr int cells = 16;
  SolverSettings s;
  s.cell_size = 0.02;
  s.transfer = Transfer::apic;
  s.contact_at = ContactAt::nodes;  // floor and plate begin on planes of nodes
  s.precision = Precision::real64;
  s.gravity.setZero();
  s.period = {1, 0, 1};
  const double height = cells * s.cell_size, width = 4 * s.cell_size;
  const ParticleArrays start = lattice({0, 0, 0}, {width, height, width}, {4, 2 * cells, 4}, 400);
  const shapes::Collider floor = plane({0, 1e-6, 0}, {0, 1, 0}, 0, shapes::Contact::slip);
  shapes::Collider plate = plane({0, height - 1e-6, 0}, {0, -1, 0}, 0, shapes::Contact::slip);
  plate.velocity = {0, -speed, 0};
  Simulation simulation(s, {Material{}}, {floor, plate}, start, 1);
  Curve curve("uniaxial_column",
              "stretch of the column, of its middle, axial stress in the middle (Pa), formula");
  for (const double stretch : {0.99, 0.98, 0.97, 0.95, 0.925, 0.9, 0.85, 0.8, 0.75, 0.7}) {
    const double end = (1 - stretch) * height / speed;
    while (simulation.time() < end * (1 - 1e-12))
      simulation.step(simulation.choose_dt(end - simulation.time()).dt);
    const ParticleArrays p = simulation.particles();
    const std::vector<Mat3d> tau = simulation.kirchhoff();
    double sigma = 0, middle = 0, n = 0;
    for (std::size_t q = 0; q < p.x.size(); ++q) {
      if (std::abs(start.x[q][1] / height - 0.5) > 0.2) continue;
      const double J = p.F_E[q].determinant() * p.J_P[q];
      sigma += tau[q](1, 1) / J, middle += J, n += 1;
    }
    sigma /= n, middle /= n;
    const double formula = uniaxial_formula(Material{}, middle).sigma;
    curve.add({stretch, middle, sigma, formula});
    const std::string line = "column at " + in_digits(stretch) + " of its height";
    // The middle is strained evenly, so its mean stress is that of its mean stretch; waves of the
    // plate (rho c v = 800 Pa at the start, damped later) and unevenness leave 3 %.
    verify_ratio({"uniaxial", line, "axial stress in the middle, Pa, at its own stretch"}, formula,
                 sigma, 0.03);
    // Its share of the compression: contact layers a cell thick at floor and plate yield first and
    // take up to 0.3 of a first cell's worth.
    verify_near({"uniaxial", line, "strain of the middle / of the column"}, 1,
                (1 - middle) / (1 - stretch), 0.3);
  }
}

}  // namespace
