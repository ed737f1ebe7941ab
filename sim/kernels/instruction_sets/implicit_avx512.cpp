/// The sweeps of the semi-implicit solve, compiled for AVX-512 (x86-64-v4).

#include "sim/kernels/implicit_sweeps.h"

namespace neve::sim::kernels {

template <>
const SolveSweeps<float>& SolveKernelSet<Avx512Set>::sweeps(int nodes, bool is_mls, float) {
  return choose_solve_sweeps<float, Avx512Set>(nodes, is_mls);
}
template <>
const SolveSweeps<double>& SolveKernelSet<Avx512Set>::sweeps(int nodes, bool is_mls, double) {
  return choose_solve_sweeps<double, Avx512Set>(nodes, is_mls);
}

}  // namespace neve::sim::kernels
