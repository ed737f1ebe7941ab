/// The laws of materials, compiled for AVX2 with fma (x86-64-v3).

#define NEVE_LANES_ALONE
#include "sim/laws/table.h"

namespace neve::sim::kernels {

template <>
const LawKernels<float, Avx2Set>& LawSet<Avx2Set>::kernels(int model, float) {
  return laws::LawTable<float, Avx2Set>::at(model);
}
template <>
const LawKernels<double, Avx2Set>& LawSet<Avx2Set>::kernels(int model, double) {
  return laws::LawTable<double, Avx2Set>::at(model);
}

}  // namespace neve::sim::kernels
