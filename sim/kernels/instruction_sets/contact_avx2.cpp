/// The sweeps of contact at particles, compiled for AVX2 with fma (x86-64-v3).

#include "sim/kernels/particle_contact_sweeps.h"

namespace neve::sim::kernels {

template <>
const ContactSweeps<float>& ContactKernelSet<Avx2Set>::sweeps(int nodes, float) {
  return choose_contact_sweeps<float, Avx2Set>(nodes);
}
template <>
const ContactSweeps<double>& ContactKernelSet<Avx2Set>::sweeps(int nodes, double) {
  return choose_contact_sweeps<double, Avx2Set>(nodes);
}

}  // namespace neve::sim::kernels
