/// What snow keeps for long: the pieces of a broken ball that lie for ten seconds.

#include <algorithm>

#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

double radius_of_share(const ParticleArrays& p, double share) {
  std::vector<double> r;
  for (const Vec3d& x : p.x) r.push_back(std::hypot(x[0], x[2]));
  const auto at = r.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(r.size()));
  std::nth_element(r.begin(), at, r.end());
  return *at;
}

/// Pieces of a ball that broke on a floor lie still: what moves by its own velocity creeps out by a
/// tenth in that time.
TEST(LongRest, ABrokenBallLiesWhereItFellForTenSeconds) {
  SolverSettings s;
  s.cell_size = 0.02;
  const double R = 5 * s.cell_size;
  Simulation simulation(
      s, {Material{}}, {plane({0, 0, 0}, {0, 1, 0}, 0.5)},
      ball_of_snow({0.003, R + 0.3 * s.cell_size, 0.004}, R, s.cell_size / 2, {0, -4, 0}), 2);
  simulation.advance_to(2);
  const ParticleArrays before = simulation.particles();
  simulation.advance_to(12);
  const ParticleArrays after = simulation.particles();
  const std::string line = "default transfer, ball of 5 cells at 4 m/s";
  const auto J_P = [](const ParticleArrays& p) {
    std::vector<double> values = p.J_P;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  // One hundredth is a fifth of a cell at the rim: nobody sees it.
  verify_ratio({"ten seconds", line, "radius of 99 % of the snow, m"},
               radius_of_share(before, 0.99), radius_of_share(after, 0.99), 0.01);
  verify_near({"ten seconds", line, "median of J_P"}, J_P(before), J_P(after), 0.01);
}

}  // namespace
