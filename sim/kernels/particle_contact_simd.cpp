/// The sweeps of contact of an instruction set. Apart from simd.cpp, so that a program with kernels
/// of its own for the steps can still take these.

#include "sim/kernels/particle_contact.h"
#include "sim/kernels/simd.h"

namespace neve::sim::kernels {

const ContactSweeps<float>& contact_sweeps_for(SimdLevel level, int nodes, float) {
  return kernels_at<ContactKernelSet>(level, nodes, float());
}
const ContactSweeps<double>& contact_sweeps_for(SimdLevel level, int nodes, double) {
  return kernels_at<ContactKernelSet>(level, nodes, double());
}

}  // namespace neve::sim::kernels
