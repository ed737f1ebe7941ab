/// Powder that is poured on a floor: the slope of its heap.

#include <algorithm>

#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

constexpr double cell = 0.02;

/// A second of pouring from a ball of 2.5 cells, 0.3 m above the floor, and half a second of rest.
ParticleArrays poured_heap(SolverSettings s) {
  s.cell_size = cell;
  Material powder;
  powder.density = 150;
  powder.youngs_modulus = 4e4;
  powder.hardening = 7;
  powder.critical_compression = 0.015;
  powder.critical_stretch = 0.002;
  seeding::Emitter emitter;
  emitter.material = powder.name;
  emitter.shape.form = shapes::Sphere{{0.003, 0.3, 0.004}, 2.5 * cell};
  emitter.velocity = {0, -1, 0};
  emitter.J_P = 1.5;  // newborn snow that is packed clogs
  emitter.rate = 0.6;
  emitter.end = 1;
  Simulation simulation(s, {powder}, {plane({0, 0, 0}, {0, 1, 0}, 0.5)}, {}, 2, Vec3i::Zero(),
                        {{emitter}, {}, 1});
  simulation.advance_to(1.5);
  return simulation.particles();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Degrees: of the even cone with the same medians. Half of a cone is within half of its radius,
/// and half below 1 - 0.5^(1/3) of its height.
double flank(const ParticleArrays& p) {
  std::vector<double> r, y;
  for (const Vec3d& x : p.x) {
    r.push_back(std::hypot(x[0], x[2]));
    y.push_back(x[1]);
  }
  const double height = median(y) / (1 - std::cbrt(0.5)), radius = 2 * median(r);
  return std::atan(height / radius) * 180 / 3.14159265358979;
}

/// Sieved snow heaps at 37 (coarse grains) to 53 degrees (fluffy ones). Seeds differ by a tenth of
/// one.
TEST(Heap, PowderIsAsSteepAsSnow) {
  verify_near({"heap", "default transfer", "flank, degrees"}, 45, flank(poured_heap({})), 8);
}

}  // namespace
