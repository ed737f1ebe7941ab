#include "sim/kernels/simd.h"

#include <cstdlib>

#include "sim/base/cpu.h"

namespace neve::sim::kernels {

namespace {

constexpr SimdLevel levels[] = {SimdLevel::avx512, SimdLevel::avx2, SimdLevel::baseline};

}  // namespace

const Sweeps<float>& sweeps_for(SimdLevel level, int nodes, TransferKind transfer, float) {
  return kernels_at<KernelSet>(level, nodes, transfer, float());
}
const Sweeps<double>& sweeps_for(SimdLevel level, int nodes, TransferKind transfer, double) {
  return kernels_at<KernelSet>(level, nodes, transfer, double());
}

const char* name(SimdLevel level) {
  switch (level) {
    case SimdLevel::avx512:
      return "avx512";
    case SimdLevel::avx2:
      return "avx2";
    default:
      return "baseline";
  }
}

bool is_available(SimdLevel level) {
#ifdef NEVE_AVX512_KERNELS
  if (level == SimdLevel::avx512) return runs_x86_64_v4();
#endif
#ifdef NEVE_AVX2_KERNELS
  if (level == SimdLevel::avx2) return runs_x86_64_v3();
#endif
#ifdef NEVE_WITHOUT_BASELINE_KERNELS
  return false;
#else
  return level == SimdLevel::baseline;
#endif
}

SimdLevel chosen_simd_level() {
  const char* wanted = std::getenv("NEVE_SIMD");
  const bool is_free = wanted == nullptr || *wanted == '\0';
  std::string available;
  for (const SimdLevel level : levels) {
    const bool is_here = is_available(level);
    if (is_here && (is_free || std::string(wanted) == name(level))) return level;
    if (is_here) available = available.empty() ? name(level) : name(level) + (", " + available);
  }
  if (available.empty())
    throw SimdError(
        "this program was built for another machine's instruction set alone; build it "
        "here, or with NEVE_KERNEL_SETS=all");
  throw SimdError("NEVE_SIMD=" + std::string(wanted) +
                  " is not available; on this machine this build has " + available);
}

}  // namespace neve::sim::kernels
