/// The solve's sweeps of an instruction set. Apart from simd.cpp, so that a program with kernels of
/// its own for the steps can still take these.

#include "sim/kernels/implicit.h"
#include "sim/kernels/simd.h"

namespace neve::sim::kernels {

const SolveSweeps<float>& solve_sweeps_for(SimdLevel level, int nodes, bool is_mls, float) {
  return kernels_at<SolveKernelSet>(level, nodes, is_mls, float());
}
const SolveSweeps<double>& solve_sweeps_for(SimdLevel level, int nodes, bool is_mls, double) {
  return kernels_at<SolveKernelSet>(level, nodes, is_mls, double());
}

}  // namespace neve::sim::kernels
