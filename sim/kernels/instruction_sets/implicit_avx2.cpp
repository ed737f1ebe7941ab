/// The sweeps of the semi-implicit solve, compiled for AVX2 with fma (x86-64-v3).

#include "sim/kernels/implicit_sweeps.h"

namespace neve::sim::kernels {

template <>
const SolveSweeps<float>& SolveKernelSet<Avx2Set>::sweeps(int nodes, bool is_mls, float) {
  return choose_solve_sweeps<float, Avx2Set>(nodes, is_mls);
}
template <>
const SolveSweeps<double>& SolveKernelSet<Avx2Set>::sweeps(int nodes, bool is_mls, double) {
  return choose_solve_sweeps<double, Avx2Set>(nodes, is_mls);
}

}  // namespace neve::sim::kernels
