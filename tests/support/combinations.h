#pragma once
/// Every combination of transfer, kernel, advection and precision that is one of its own.

#include <string>
#include <vector>

#include "sim/types/settings.h"

namespace neve::test {

struct Combination {
  sim::Transfer transfer;
  sim::Kernel kernel;
  sim::Advect advect;
  sim::Precision precision;

  void apply_to(sim::SolverSettings& s) const {
    s.transfer = transfer;
    s.kernel = kernel;
    s.advect = advect;
    s.precision = precision;
  }
  std::string name() const {
    static constexpr const char* transfers[] = {"flip", "apic", "mls", "aflip", "asflip"};
    return std::string(transfers[static_cast<int>(transfer)]) +
           (kernel == sim::Kernel::cubic ? " cubic" : " quadratic") +
           (advect == sim::Advect::pic ? " pic" : " particle") +
           (precision == sim::Precision::single ? " float" : " double");
  }
};

inline std::vector<Combination> all_combinations() {
  std::vector<Combination> all;
  using enum sim::Transfer;
  for (const auto transfer : {flip, apic, mls, aflip, asflip})
    for (const auto kernel : {sim::Kernel::cubic, sim::Kernel::quadratic})
      for (const auto advect : {sim::Advect::particle, sim::Advect::pic})
        for (const auto precision : {sim::Precision::single, sim::Precision::real64}) {
          // The affine FLIPs know themselves how particles move.
          const bool has_own_way = transfer == aflip || transfer == asflip;
          if (has_own_way && advect == sim::Advect::pic) continue;
          all.push_back({transfer, kernel, advect, precision});
        }
  return all;
}

}  // namespace neve::test
