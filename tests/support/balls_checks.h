#pragma once
/// Checks of a collision of balls, and its curves.

#include "tests/support/balls.h"
#include "tests/support/verification.h"

namespace neve::test {

/// Shares of the kinetic energy at the start, and of the speed of approach.
struct BallsExpectation {
  double kinetic_at_rest, elastic, total, rebound;
};

inline BallsHistory recorded_balls(const BallsCase& c) {
  const BallsHistory h = collide_balls(c);
  Curve curve("balls_" + file_name(c.label()), "time (s), kinetic / start, elastic / start, total");
  for (const auto& s : h.samples) curve.add({s.time, s.kinetic, s.elastic, s.kinetic + s.elastic});
  return h;
}

/// Undamped, they rebound nearly as fast as they came where what strains them moves them: nine
/// tenths (Sulsky et al. 1994, two discs), the rest rings in them and spins off at their rims.
inline void check_undamped_rebound(BallsCase c) {
  c.flip_ratio = 1;
  verify_near({"balls", c.label(), "speed of rebound / of approach"}, 0.9,
              recorded_balls(c).rebound, 0.1);
}

/// Checks a case without a reference: momentum must hold, and energy must not come from nowhere.
inline void check_that_balls_gain_nothing(const BallsCase& c) {
  const BallsHistory h = recorded_balls(c);
  verify_at_most({"balls", c.label(), "momentum of the pair / of one ball"}, 1e-12,
                 h.largest_momentum);
  verify_at_most({"balls", c.label(), "largest total energy / start"}, 1.001, h.largest_total);
  keep_number({"balls", c.label(), "total energy / start after 0.6 s"}, h.final_total);
  keep_number({"balls", c.label(), "speed of rebound / of approach"}, h.rebound);
}

inline void check_balls(const BallsCase& c, const BallsExpectation& e) {
  const BallsHistory h = recorded_balls(c);
  const std::string line = c.label();
  const bool is_float = c.precision == sim::Precision::single;
  // Sums of 4000 terms over 600 steps: 1e-13 in double, rounding of 1e-7 a particle in float.
  verify_at_most({"balls", line, "momentum of the pair / of one ball"}, is_float ? 1e-5 : 1e-12,
                 h.largest_momentum);
  // Energy may only be lost; 1e-3 for the splitting of the explicit step.
  verify_at_most({"balls", line, "largest total energy / start"}, 1.001, h.largest_total);
  verify_at_most({"balls", line, "least kinetic energy / start"}, 5 * e.kinetic_at_rest,
                 h.min_kinetic);
  // The run is not chaotic, so the reference's numbers, known to three digits, must come out; 0.01
  // leaves room for float.
  verify_near({"balls", line, "largest elastic energy / start"}, e.elastic, h.largest_elastic,
              0.01);
  verify_near({"balls", line, "total energy / start after 0.6 s"}, e.total, h.final_total, 0.01);
  verify_near({"balls", line, "speed of rebound / of approach"}, e.rebound, h.rebound, 0.01);
}

}  // namespace neve::test
