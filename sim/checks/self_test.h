#pragma once
/// Start-up self-tests of the physics: small states whose answer is known, taken through the real
/// kernels of the running instruction set. A wrong sign, factor, index or initial value shows here
/// in milliseconds, before anything explodes (docs/mistakes.md says which test notices which).

#include <span>
#include <string>
#include <vector>

#include "sim/types/settings.h"

namespace neve::sim::checks {

struct SelfTestResult {
  std::string name;  ///< one word or a few, for scripts: weights, affine_field, ...
  std::string what;  ///< claim under test, for the user
  bool passed = true;
  std::string detail;  ///< the claim, the worst value found, the tolerance, and the place
};

/// One way to run the step.
struct SelfTestCase {
  Kernel kernel;
  Transfer transfer;
  Precision precision;
};

/// Every kernel, transfer and precision.
std::vector<SelfTestCase> all_self_test_cases();

/// The tests, each over all cases; always the same list in the same order. Never throws for wrong
/// physics: a test that cannot be computed has failed.
std::vector<SelfTestResult> self_tests(std::span<const SelfTestCase> cases);

}  // namespace neve::sim::checks
