/// The choice of an instruction set.

#include <gtest/gtest.h>

#include "tests/support/simd_levels.h"

namespace {

using namespace neve;
using namespace neve::sim;

/// Error of the choice if NEVE_SIMD is `value`; empty: no error.
std::string complaint_about(const char* value) {
  std::string complaint;
  const char* before = std::getenv("NEVE_SIMD");
  const std::string saved = before ? before : "";
  setenv("NEVE_SIMD", value, 1);
  try {
    kernels::chosen_simd_level();
  } catch (const kernels::SimdError& error) {
    complaint = error.what();
  }
  if (before)
    setenv("NEVE_SIMD", saved.c_str(), 1);
  else
    unsetenv("NEVE_SIMD");
  return complaint;
}

TEST(Simd, UnknownLevelsAreRefusedWithTheChoices) {
  for (const char* wrong : {"foo", "AVX2", " avx2", "avx", "avx2 ", "baseline,avx2"}) {
    const std::string complaint = complaint_about(wrong);
    EXPECT_TRUE(complaint.starts_with("NEVE_SIMD=" + std::string(wrong))) << complaint;
    const char* least =
        kernels::is_available(kernels::SimdLevel::baseline) ? "has baseline" : "has ";
    EXPECT_NE(complaint.find(std::string("this machine ") + least), std::string::npos) << complaint;
  }
}

TEST(Simd, LevelsThatTheMachineLacksAreRefused) {
  for (const kernels::SimdLevel level :
       {kernels::SimdLevel::baseline, kernels::SimdLevel::avx2, kernels::SimdLevel::avx512}) {
    const std::string complaint = complaint_about(kernels::name(level));
    EXPECT_EQ(complaint.empty(), kernels::is_available(level)) << complaint;
    // Another level's complaint lists exactly the levels that are here.
    const std::string list = complaint_about("foo").substr(std::string("NEVE_SIMD=foo").size());
    EXPECT_EQ(list.find(kernels::name(level)) != std::string::npos, kernels::is_available(level))
        << list;
  }
}

TEST(Simd, ChoiceIsTheWidestUnlessToldOtherwise) {
  test::at_every_simd_level(
      [] { EXPECT_STREQ(kernels::name(kernels::chosen_simd_level()), std::getenv("NEVE_SIMD")); });
  EXPECT_EQ(complaint_about(""), "");
}

}  // namespace
