/// Contact at particles as reduced_kernels.cpp has the other kernels: double, cubic spline, the
/// baseline instruction set.

#include "sim/kernels/particle_contact_sweeps.h"

namespace neve::sim::kernels {

template <>
const ContactSweeps<double>& ContactKernelSet<BaselineSet>::sweeps(int nodes, double) {
  if (nodes != cubic_nodes) __builtin_trap();
  return ContactSweepsFor<double, cubic_nodes, BaselineSet>::table;
}
template <>
const ContactSweeps<float>& ContactKernelSet<BaselineSet>::sweeps(int, float) {
  __builtin_trap();
}

}  // namespace neve::sim::kernels

#include "sim/kernels/particle_contact_simd.cpp"
