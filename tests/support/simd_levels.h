#pragma once
/// Running a check at every SIMD level that this machine has.

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "sim/kernels/simd.h"

namespace neve::test {

/// body() with NEVE_SIMD set to each level in turn; a simulation built in it uses that level.
template <class Body>
void at_every_simd_level(const Body& body) {
  const char* before = std::getenv("NEVE_SIMD");
  const std::string saved = before ? before : "";
  for (const sim::kernels::SimdLevel level :
       {sim::kernels::SimdLevel::baseline, sim::kernels::SimdLevel::avx2,
        sim::kernels::SimdLevel::avx512}) {
    if (!sim::kernels::is_available(level)) continue;
    SCOPED_TRACE(sim::kernels::name(level));
    setenv("NEVE_SIMD", sim::kernels::name(level), 1);
    body();
  }
  if (before)
    setenv("NEVE_SIMD", saved.c_str(), 1);
  else
    unsetenv("NEVE_SIMD");
}

}  // namespace neve::test
