/// The sweeps, compiled for AVX-512 (x86-64-v4).

#include "sim/kernels/kernels.h"
#include "sim/kernels/sweep_table.h"

namespace neve::sim::kernels {

template <>
const Sweeps<float>& KernelSet<Avx512Set>::sweeps(int nodes, TransferKind transfer, float) {
  return choose_sweeps<float, Avx512Set>(nodes, transfer);
}
template <>
const Sweeps<double>& KernelSet<Avx512Set>::sweeps(int nodes, TransferKind transfer, double) {
  return choose_sweeps<double, Avx512Set>(nodes, transfer);
}

}  // namespace neve::sim::kernels
