/// The solve's sweeps of an instruction set. Apart from simd.cpp, so that a program with kernels of
/// its own for the steps can still take these.

#include "sim/kernels/implicit.h"
#include "sim/kernels/row.h"

namespace neve::sim::kernels {

namespace {

template <class Real>
const SolveSweeps<Real>& sweeps_at(SimdLevel level, int nodes, bool is_mls) {
#ifdef NEVE_X86_KERNELS
  if (level == SimdLevel::avx512) return SolveKernelSet<Avx512Set>::sweeps(nodes, is_mls, Real());
  if (level == SimdLevel::avx2) return SolveKernelSet<Avx2Set>::sweeps(nodes, is_mls, Real());
#endif
  (void)level;
  return SolveKernelSet<BaselineSet>::sweeps(nodes, is_mls, Real());
}

}  // namespace

const SolveSweeps<float>& solve_sweeps_for(SimdLevel level, int nodes, bool is_mls, float) {
  return sweeps_at<float>(level, nodes, is_mls);
}
const SolveSweeps<double>& solve_sweeps_for(SimdLevel level, int nodes, bool is_mls, double) {
  return sweeps_at<double>(level, nodes, is_mls);
}

}  // namespace neve::sim::kernels
