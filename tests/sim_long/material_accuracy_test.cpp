/// Material kernels of every SIMD level against Eigen in a wider type, on millions of matrices.

#include "tests/support/material_accuracy.h"

namespace neve::test {
namespace {

template <class Real>
void check_millions() {
  MaterialAccuracy<Real> accuracy;
  for (unsigned seed = 1; seed <= 20; ++seed) accuracy.check(seed, 100000);
  expect_accurate(accuracy, material_error_limit<Real>, true);
}

TEST(MaterialKernels, KernelsMatchTheReferenceOnMillionsOfMatricesInFloat) {
  check_millions<float>();
}
TEST(MaterialKernels, KernelsMatchTheReferenceOnMillionsOfMatricesInDouble) {
  check_millions<double>();
}

}  // namespace
}  // namespace neve::test
