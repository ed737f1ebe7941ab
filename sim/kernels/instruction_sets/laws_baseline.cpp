/// The laws of materials, compiled for what every machine of the architecture has.

#define NEVE_LANES_ALONE
#include "sim/laws/table.h"

namespace neve::sim::kernels {

template <>
const LawKernels<float, BaselineSet>& LawSet<BaselineSet>::kernels(int model, float) {
  return laws::LawTable<float, BaselineSet>::at(model);
}
template <>
const LawKernels<double, BaselineSet>& LawSet<BaselineSet>::kernels(int model, double) {
  return laws::LawTable<double, BaselineSet>::at(model);
}

}  // namespace neve::sim::kernels
