/// The sweeps of contact at particles, compiled for what every machine of the
/// architecture has.

#include "sim/kernels/particle_contact_sweeps.h"

namespace neve::sim::kernels {

template <>
const ContactSweeps<float>& ContactKernelSet<BaselineSet>::sweeps(int nodes, float) {
  return choose_contact_sweeps<float, BaselineSet>(nodes);
}
template <>
const ContactSweeps<double>& ContactKernelSet<BaselineSet>::sweeps(int nodes, double) {
  return choose_contact_sweeps<double, BaselineSet>(nodes);
}

}  // namespace neve::sim::kernels
