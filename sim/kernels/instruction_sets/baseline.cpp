/// The sweeps, compiled for what every machine of the architecture has.

#include "sim/kernels/kernels.h"
#include "sim/kernels/sweep_table.h"

namespace neve::sim::kernels {

template <>
const Sweeps<float>& KernelSet<BaselineSet>::sweeps(int nodes, TransferKind transfer, float) {
  return choose_sweeps<float, BaselineSet>(nodes, transfer);
}
template <>
const Sweeps<double>& KernelSet<BaselineSet>::sweeps(int nodes, TransferKind transfer, double) {
  return choose_sweeps<double, BaselineSet>(nodes, transfer);
}

}  // namespace neve::sim::kernels
