/// The sweeps of contact at particles, compiled for AVX-512 (x86-64-v4).

#include "sim/kernels/particle_contact_sweeps.h"

namespace neve::sim::kernels {

template <>
const ContactSweeps<float>& ContactKernelSet<Avx512Set>::sweeps(int nodes, float) {
  return choose_contact_sweeps<float, Avx512Set>(nodes);
}
template <>
const ContactSweeps<double>& ContactKernelSet<Avx512Set>::sweeps(int nodes, double) {
  return choose_contact_sweeps<double, Avx512Set>(nodes);
}

}  // namespace neve::sim::kernels
