/// The sweeps, compiled for AVX2 with fma (x86-64-v3).

#include "sim/kernels/kernels.h"
#include "sim/kernels/sweep_table.h"

namespace neve::sim::kernels {

template <>
const Sweeps<float>& KernelSet<Avx2Set>::sweeps(int nodes, TransferKind transfer, float) {
  return choose_sweeps<float, Avx2Set>(nodes, transfer);
}
template <>
const Sweeps<double>& KernelSet<Avx2Set>::sweeps(int nodes, TransferKind transfer, double) {
  return choose_sweeps<double, Avx2Set>(nodes, transfer);
}

}  // namespace neve::sim::kernels
