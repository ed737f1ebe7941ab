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

TEST(ElasticBallsLong, BallsReboundWithoutDampingWhereTheGridMovesThem) {
  check_undamped_rebound({.transfer = Transfer::aflip});
  check_undamped_rebound({.advect = Advect::pic});
}

TEST(ElasticBallsLong, BallsFallApartWithUndampedFlip) {
  // FLIP with alpha = 1 is known for it: velocities that the grid does not see are never damped.
  check_that_balls_gain_nothing({.flip_ratio = 1});
}

}  // namespace
