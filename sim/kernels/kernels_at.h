#pragma once
/// The kernels of an instruction set.

#include "sim/kernels/kernels.h"
#include "sim/kernels/row.h"

namespace neve::sim::kernels {

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
