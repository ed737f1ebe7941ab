/// Longitudinal vibration of an elastic bar, free or held at one end.

#include <numbers>

#include "tests/support/elastic.h"
#include "tests/support/plane_wave.h"
#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

constexpr double bar_modulus = 1e5, bar_density = 1000;  // c = 10 m/s without lateral strain
const double bar_c = std::sqrt(bar_modulus / bar_density);

/// Period of the lowest mode of a bar of 1 m, nu = 0, FLIP with alpha = 1, cubic.
double bar_period(int cells, bool is_held, Precision precision = Precision::real64) {
  SolverSettings s;
  s.cell_size = 1.0 / cells;
  s.transfer = Transfer::flip;
  s.flip_ratio = 1;
  s.precision = precision;
  s.gravity.setZero();
  const double w = s.cell_size, k = (is_held ? 0.5 : 1) * std::numbers::pi;
  ParticleArrays p = lattice({0, -w, -w}, {1, w, w}, {2 * cells, 4, 4}, bar_density);
  std::vector<double> shape;
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    shape.push_back(is_held ? std::sin(k * p.x[q][0]) : -std::cos(k * p.x[q][0]));
    p.v[q][0] = 1e-3 * bar_c * shape[q];
  }
  // The wall is a plane of nodes, and holds them.
  s.contact_at = ContactAt::nodes;
  std::vector<shapes::Collider> wall;
  if (is_held) wall.push_back(plane({1e-6, 0, 0}, {1, 0, 0}, 0, shapes::Contact::sticky));
  Simulation simulation(s, {elastic(bar_modulus, 0, bar_density)}, wall, p, 1);
  const double dt = 0.2 * s.cell_size / bar_c, about_omega = k * bar_c;
  std::vector<double> samples;
  for (double t = 0; t < 1.5 * 2 * std::numbers::pi / about_omega; t += dt) {
    simulation.step(dt);
    const std::vector<Vec3d> v = simulation.particles().v;
    double sum = 0;
    for (std::size_t q = 0; q < v.size(); ++q) sum += v[q][0] * shape[q];
    samples.push_back(sum);
  }
  return 2 * std::numbers::pi / fit_oscillation(samples, dt, about_omega).omega;
}

TEST(FreeBar, FreeBarRingsAtTwoLengthsPerWaveSpeed) {
  // T = 2 L / c, longer by the dispersion of a wave of 2 L: the free ends add next to nothing. The
  // reference has 1.033 and 1.008 T.
  const double exact = 2 / bar_c;
  Curve curve("bar_free", "h (m), period / exact, period / exact by dispersion");
  std::vector<double> errors;
  for (const int cells : {10, 20, 40}) {
    const double period = bar_period(cells, false), kh = std::numbers::pi / cells;
    const double predicted = 1 / flip_dispersion(Kernel::cubic, kh);
    errors.push_back(period / exact - 1);
    curve.add({1.0 / cells, period / exact, predicted});
    verify_near({"bar", "free, h = L/" + std::to_string(cells), "period / (2 L/c)"}, predicted,
                period / exact, 0.002);
  }
  verify_at_least({"bar", "free, L/10 to L/20", "order"}, 1.8, order(errors[0], errors[1]));
  verify_at_least({"bar", "free, L/20 to L/40", "order"}, 1.8, order(errors[1], errors[2]));
  // Float: strains of 1e-3 known to 6e-8, summed over 600 steps.
  verify_near({"bar", "free, h = L/20, float", "period / (2 L/c)"}, 1 + errors[1],
              bar_period(20, false, Precision::single) / exact, 1e-3);
}

TEST(HeldBar, HeldBarRingsAtFourLengthsPerWaveSpeed) {
  // T = 4 L / c. B-splines do not interpolate: particles in the cell at the wall are slowed by it,
  // the bar behaves as if longer by a share of h. So the order is 1. The reference's periods, known
  // to half of a thousandth, are used where it has them; beyond, they follow from order 1.
  const double exact = 4 / bar_c;
  Curve curve("bar_held", "h (m), period / exact");
  std::vector<double> errors;
  struct Reference {
    int cells;
    double period, tolerance;
  };
  for (const Reference& r :
       {Reference{10, 1.055, 0.001}, {20, 1.0245, 0.001}, {40, 1.012, 0.003}}) {
    const double period = bar_period(r.cells, true);
    errors.push_back(period / exact - 1);
    curve.add({1.0 / r.cells, period / exact});
    verify_near({"bar", "held at one end, h = L/" + std::to_string(r.cells), "period / (4 L/c)"},
                r.period, period / exact, r.tolerance);
  }
  verify_at_least({"bar", "held at one end, L/10 to L/20", "order"}, 0.9,
                  order(errors[0], errors[1]));
  verify_at_least({"bar", "held at one end, L/20 to L/40", "order"}, 0.9,
                  order(errors[1], errors[2]));
}

}  // namespace
