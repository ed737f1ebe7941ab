/// Two elastic balls collide, every transfer.

#include "tests/support/balls_checks.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(ElasticBallsLong, BallsReboundAsInTheReferenceWithEveryTransfer) {
  check_balls({.precision = Precision::single},
              {.kinetic_at_rest = 0.001, .elastic = 0.924, .total = 0.825, .rebound = 0.908});
  check_balls({.transfer = Transfer::apic},
              {.kinetic_at_rest = 0.001, .elastic = 0.770, .total = 0.53, .rebound = 0.726});
  check_balls({.transfer = Transfer::mls, .kernel = Kernel::quadratic},
              {.kinetic_at_rest = 0.001, .elastic = 0.864, .total = 0.725, .rebound = 0.850});
}

TEST(ElasticBallsLong, BallsFallApartWithUndampedFlip) {
  // Known of FLIP with alpha = 1: velocities that the grid does not see are never damped. Momentum
  // must hold all the same, and energy must not come from nowhere.
  const BallsCase c{.flip_ratio = 1};
  const BallsHistory h = recorded_balls(c);
  verify_at_most({"balls", c.label(), "momentum of the pair / of one ball"}, 1e-12,
                 h.largest_momentum);
  verify_at_most({"balls", c.label(), "largest total energy / start"}, 1.001, h.largest_total);
  keep_number({"balls", c.label(), "total energy / start after 0.6 s"}, h.final_total);
  keep_number({"balls", c.label(), "speed of rebound / of approach"}, h.rebound);
}

}  // namespace
