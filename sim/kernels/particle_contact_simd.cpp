/// The sweeps of contact of an instruction set. Apart from simd.cpp, so that a program with kernels
/// of its own for the steps can still take these.

#include "sim/kernels/particle_contact.h"
#include "sim/kernels/row.h"

namespace neve::sim::kernels {

namespace {

template <class Real>
const ContactSweeps<Real>& contact_sweeps_at(SimdLevel level, int nodes) {
#ifdef NEVE_X86_KERNELS
  if (level == SimdLevel::avx512) return ContactKernelSet<Avx512Set>::sweeps(nodes, Real());
  if (level == SimdLevel::avx2) return ContactKernelSet<Avx2Set>::sweeps(nodes, Real());
#endif
  (void)level;
  return ContactKernelSet<BaselineSet>::sweeps(nodes, Real());
}

}  // namespace

const ContactSweeps<float>& contact_sweeps_for(SimdLevel level, int nodes, float) {
  return contact_sweeps_at<float>(level, nodes);
}
const ContactSweeps<double>& contact_sweeps_for(SimdLevel level, int nodes, double) {
  return contact_sweeps_at<double>(level, nodes);
}

}  // namespace neve::sim::kernels
