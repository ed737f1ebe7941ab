#pragma once
/// The instruction set that the kernels use.

#include <stdexcept>
#include <string>

#include "sim/kernels/kernels.h"
#include "sim/kernels/row.h"

namespace neve::sim::kernels {

/// NEVE_SIMD asks for something that does not exist or that this machine cannot run.
struct SimdError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const char* name(SimdLevel level);

/// Can this build on this machine run it?
bool is_available(SimdLevel level);

/// The widest available one, or what the environment variable NEVE_SIMD (baseline, avx2, avx512)
/// asks for.
/// @throws SimdError
SimdLevel chosen_simd_level();

/// Set<Avx2Set>::sweeps(given...), for the instruction set of a level.
template <template <class> class Set, class... Given>
const auto& kernels_at(SimdLevel level, Given... given) {
#ifdef NEVE_AVX512_KERNELS
  if (level == SimdLevel::avx512) return Set<Avx512Set>::sweeps(given...);
#endif
#ifdef NEVE_AVX2_KERNELS
  if (level == SimdLevel::avx2) return Set<Avx2Set>::sweeps(given...);
#endif
  (void)level;
#ifndef NEVE_WITHOUT_BASELINE_KERNELS
  return Set<BaselineSet>::sweeps(given...);
#elif defined(NEVE_AVX512_KERNELS)
  return Set<Avx512Set>::sweeps(given...);
#else
  return Set<Avx2Set>::sweeps(given...);
#endif
}

}  // namespace neve::sim::kernels
