/// The sweeps, compiled for AVX2 with fma (x86-64-v3).

#include "sim/kernels.h"
#include "sim/sweeps.h"

namespace neve::sim {

template <>
const Sweeps<float>& KernelSet<Avx2Set>::sweeps(int nodes, TransferKind transfer, float) {
  return choose_sweeps<float, Avx2Set>(nodes, transfer);
}
template <>
const Sweeps<double>& KernelSet<Avx2Set>::sweeps(int nodes, TransferKind transfer, double) {
  return choose_sweeps<double, Avx2Set>(nodes, transfer);
}

}  // namespace neve::sim
