#pragma once
/// Every combination of transfer, kernel, advection and precision.

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
    static constexpr const char* transfers[] = {"flip", "apic", "mls"};
    return std::string(transfers[static_cast<int>(transfer)]) +
           (kernel == sim::Kernel::cubic ? " cubic" : " quadratic") +
           (advect == sim::Advect::pic ? " pic" : " particle") +
           (precision == sim::Precision::single ? " float" : " double");
  }
};

inline std::vector<Combination> all_combinations() {
  std::vector<Combination> all;
  for (const auto transfer : {sim::Transfer::flip, sim::Transfer::apic, sim::Transfer::mls})
    for (const auto kernel : {sim::Kernel::cubic, sim::Kernel::quadratic})
      for (const auto advect : {sim::Advect::particle, sim::Advect::pic})
        for (const auto precision : {sim::Precision::single, sim::Precision::real64})
          all.push_back({transfer, kernel, advect, precision});
  return all;
}

}  // namespace neve::test
