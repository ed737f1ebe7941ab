/// The start-up self-tests pass in every instruction set; that they fail for mistakes is what
/// tests/mutation shows.

#include "sim/checks/self_test.h"

#include <gtest/gtest.h>

#include "sim/checks/self_test_bodies.h"
#include "sim/checks/self_test_measure.h"
#include "tests/support/simd_levels.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(SelfTests, PassWithEveryKernelTransferPrecisionAndInstructionSet) {
  at_every_simd_level([] {
    const std::vector<checks::SelfTestCase> cases = checks::all_self_test_cases();
    ASSERT_EQ(cases.size(), 20u);
    for (const checks::SelfTestResult& result : checks::self_tests(cases))
      EXPECT_TRUE(result.passed) << result.name << ": " << result.detail;
  });
}

TEST(SelfTests, ResultsHaveValueToleranceAndPlace) {
  const checks::SelfTestCase one[] = {{Kernel::quadratic, Transfer::mls, Precision::single}};
  for (const checks::SelfTestResult& result : checks::self_tests(one)) {
    EXPECT_NE(result.detail.find("allowed"), std::string::npos) << result.detail;
    EXPECT_NE(result.detail.find("(mls quadratic float)"), std::string::npos) << result.detail;
  }
}

TEST(SelfTests, NanFailsASelfTest) {
  checks::self_test::Measure measure({Kernel::cubic, Transfer::flip, Precision::real64});
  measure.zero("a", 0, checks::self_test::rounding);
  EXPECT_LE(measure.worst(), 1);
  measure.zero("b", std::nan(""), checks::self_test::rounding);
  measure.zero("c", 1e-12, checks::self_test::rounding);
  EXPECT_GT(measure.worst(), 1);
  EXPECT_NE(measure.detail().find("b is off"), std::string::npos) << measure.detail();
}

TEST(SelfTests, SelfTestsHaveWeightsOfTheirOwnThatAreRight) {
  for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic}) {
    const double h = checks::self_test::cell_size;
    const Vec3d x(0.3 * h, 0.8 * h, 0.5 * h);
    double sum = 0;
    Mat3d moment = Mat3d::Zero();
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j)
        for (int k = -3; k <= 3; ++k) {
          const Vec3d d = checks::self_test::place({i, j, k}) - x;
          sum += checks::self_test::weight(kernel, d);
          moment += d * checks::self_test::weight_gradient(kernel, Transfer::flip, d).transpose();
        }
    // Sums of 64 terms in double.
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_LE((moment - Mat3d::Identity()).cwiseAbs().maxCoeff(), 1e-13);
  }
}

}  // namespace
