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

/// No reference has these: momentum and energy are what must hold.
TEST(ElasticBalls, BallsGainNothingWithAflipAndAsflip) {
  for (const Transfer transfer : {Transfer::aflip, Transfer::asflip}) {
    const BallsCase c{.transfer = transfer};
    const BallsHistory h = recorded_balls(c);
    verify_at_most({"balls", c.label(), "momentum of the pair / of one ball"}, 1e-12,
                   h.largest_momentum);
    verify_at_most({"balls", c.label(), "largest total energy / start"}, 1.001, h.largest_total);
    keep_number({"balls", c.label(), "total energy / start after 0.6 s"}, h.final_total);
    keep_number({"balls", c.label(), "speed of rebound / of approach"}, h.rebound);
  }
}

}  // namespace
