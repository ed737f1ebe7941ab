/// The kernels that the probe needs, and no more: double, cubic spline, FLIP (NEVE_PROBE_ASFLIP:
/// ASFLIP), the baseline instruction set. Compiled in seconds, where all of them take minutes.
/// Takes the place of sim/kernels/simd.cpp and sim/kernels/instruction_sets/ when it is linked
/// before the library.

#define NEVE_LANES_ALONE
#include "sim/kernels/implicit_sweeps.h"
#include "sim/kernels/sweep_table.h"
#include "sim/laws/table.h"

namespace neve::sim::kernels {

#ifdef NEVE_PROBE_ASFLIP
constexpr TransferKind probed = TransferKind::aflip;
#else
constexpr TransferKind probed = TransferKind::flip;
#endif

template <>
const Sweeps<double>& KernelSet<BaselineSet>::sweeps(int nodes, TransferKind transfer, double) {
  if (nodes != cubic_nodes || transfer != probed) __builtin_trap();
  return SweepTable<double, cubic_nodes, probed, BaselineSet>::table;
}
template <>
const Sweeps<float>& KernelSet<BaselineSet>::sweeps(int, TransferKind, float) {
  __builtin_trap();
}

template <>
const LawKernels<double, BaselineSet>& LawSet<BaselineSet>::kernels(int model, double) {
  return laws::LawTable<double, BaselineSet>::at(model);
}
template <>
const LawKernels<float, BaselineSet>& LawSet<BaselineSet>::kernels(int, float) {
  __builtin_trap();
}

template <>
const SolveSweeps<double>& SolveKernelSet<BaselineSet>::sweeps(int nodes, bool is_mls, double) {
  if (nodes != cubic_nodes || is_mls) __builtin_trap();
  return SolveSweepsFor<double, cubic_nodes, false, BaselineSet>::table;
}
template <>
const SolveSweeps<float>& SolveKernelSet<BaselineSet>::sweeps(int, bool, float) {
  __builtin_trap();
}

}  // namespace neve::sim::kernels

#include "sim/kernels/implicit_simd.cpp"
#include "sim/kernels/simd.cpp"
