/// The sweeps of the semi-implicit solve, compiled for what every machine of the
/// architecture has.

#include "sim/kernels/implicit_sweeps.h"

namespace neve::sim::kernels {

template <>
const SolveSweeps<float>& SolveKernelSet<BaselineSet>::sweeps(int nodes, bool is_mls, float) {
  return choose_solve_sweeps<float, BaselineSet>(nodes, is_mls);
}
template <>
const SolveSweeps<double>& SolveKernelSet<BaselineSet>::sweeps(int nodes, bool is_mls, double) {
  return choose_solve_sweeps<double, BaselineSet>(nodes, is_mls);
}

}  // namespace neve::sim::kernels
