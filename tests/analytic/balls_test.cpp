/// Two elastic balls collide; every transfer in analytic_long.

#include "tests/support/balls_checks.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(ElasticBalls, BallsReboundAsInTheReferenceWithFlip) {
  check_balls({}, {.kinetic_at_rest = 0.001, .elastic = 0.924, .total = 0.825, .rebound = 0.908});
}

TEST(ElasticBalls, BallsReboundAsInTheReferenceWithMlsInFloat) {
  check_balls(
      {.transfer = Transfer::mls, .kernel = Kernel::quadratic, .precision = Precision::single},
      {.kinetic_at_rest = 0.001, .elastic = 0.864, .total = 0.725, .rebound = 0.850});
}

TEST(ElasticBalls, BallsGainNothingWithAflipAndAsflip) {
  for (const Transfer transfer : {Transfer::aflip, Transfer::asflip})
    check_that_balls_gain_nothing({.transfer = transfer});
}

TEST(ElasticBalls, BallsReboundWithoutDampingByTheDefaultTransfer) {
  check_undamped_rebound({.transfer = Transfer::asflip});
}

}  // namespace
