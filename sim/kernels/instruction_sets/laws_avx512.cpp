/// The laws of materials, compiled for AVX-512 (x86-64-v4).

#define NEVE_LANES_ALONE
#include "sim/laws/table.h"

namespace neve::sim::kernels {

template <>
const LawKernels<float, Avx512Set>& LawSet<Avx512Set>::kernels(int model, float) {
  return laws::LawTable<float, Avx512Set>::at(model);
}
template <>
const LawKernels<double, Avx512Set>& LawSet<Avx512Set>::kernels(int model, double) {
  return laws::LawTable<double, Avx512Set>::at(model);
}

}  // namespace neve::sim::kernels
