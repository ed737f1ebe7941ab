/// The sweeps, compiled for what every machine of the architecture has.

#include "sim/kernels.h"
#include "sim/sweeps.h"

namespace neve::sim {

namespace {

template <class Real>
const Sweeps<Real>& choose(int nodes, TransferKind transfer) {
  if (nodes == cubic_nodes) {
    switch (transfer) {
      case TransferKind::flip:
        return SweepsFor<Real, cubic_nodes, TransferKind::flip>::table;
      case TransferKind::apic:
        return SweepsFor<Real, cubic_nodes, TransferKind::apic>::table;
      default:
        return SweepsFor<Real, cubic_nodes, TransferKind::mls>::table;
    }
  }
  switch (transfer) {
    case TransferKind::flip:
      return SweepsFor<Real, quadratic_nodes, TransferKind::flip>::table;
    case TransferKind::apic:
      return SweepsFor<Real, quadratic_nodes, TransferKind::apic>::table;
    default:
      return SweepsFor<Real, quadratic_nodes, TransferKind::mls>::table;
  }
}

}  // namespace

const Sweeps<float>& baseline_sweeps(int nodes, TransferKind transfer, float) {
  return choose<float>(nodes, transfer);
}
const Sweeps<double>& baseline_sweeps(int nodes, TransferKind transfer, double) {
  return choose<double>(nodes, transfer);
}

}  // namespace neve::sim
