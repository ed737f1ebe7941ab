/// A stiff ball between two plates: the force of Hertz.

#include <cmath>

#include "tests/support/elastic.h"
#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// F = 4/3 E/(1 - nu^2) sqrt(R) d^1.5 at both plates, each d into the ball. Particles touch at
/// three eighths of their spacing, and those of a ball lie up to its radius, so where contact
/// begins is good to that; F^(2/3) over the way of the plate grows by a slope that does not depend
/// on it.
TEST(Hertz, ABallPressesBackWithTheForceOfHertz) {
  constexpr double h = 0.02, R = 10 * h, E = 1e6, nu = 0.2, speed = 0.1;
  for (const Transfer transfer : {Transfer::asflip, Transfer::apic}) {
    SolverSettings s;
    s.cell_size = h;
    s.transfer = transfer;
    s.gravity.setZero();
    const double reach = R + 0.375 * h / 2;
    shapes::Collider press = plane({0, reach, 0}, {0, -1, 0}, 0);
    press.velocity = {0, -speed, 0};
    Simulation simulation(s, {elastic(E, nu, 400)}, {plane({0, -reach, 0}, {0, 1, 0}, 0), press},
                          ball_of_snow({0.003, 0, 0.004}, R, h / 2, Vec3d::Zero()), 2);
    const auto force_at = [&](double depth) {
      const double time = 2 * depth / speed, mean_over = 0.02;
      simulation.advance_to(time - mean_over);
      return simulation.advance_to(time).loads[1].impulse[1] / mean_over;
    };
    const double k = 4.0 / 3 * E / (1 - nu * nu) * std::sqrt(R), begin = 0.03 * R, end = 0.09 * R;
    const double first = force_at(begin), last = force_at(end);
    const std::string line = name(transfer) + ", radius of ten cells";
    // The patch is three to six cells wide, the mean of a fiftieth of a second has 4 % of the
    // ball's own ringing, and at 0.09 R the exact force is a few per cent above that of small
    // strains.
    verify_ratio({"hertz", line, "slope of F^(2/3) from 0.03 R to 0.09 R, of the exact one"}, 1,
                 (std::pow(last / k, 2.0 / 3) - std::pow(first / k, 2.0 / 3)) / (end - begin), 0.1);
    verify_ratio({"hertz", line, "force at 0.09 R, N"}, k * std::pow(end, 1.5), last, 0.15);
  }
}

}  // namespace
