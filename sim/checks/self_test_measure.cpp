#include "sim/checks/self_test_measure.h"
#include "sim/types/number_text.h"

#include <cmath>
#include <limits>

namespace neve::sim::checks::self_test {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::string text(const SelfTestCase& test) {
  static constexpr const char* transfers[] = {"flip", "apic", "mls", "aflip", "asflip"};
  return std::string(transfers[static_cast<int>(test.transfer)]) +
         (test.kernel == Kernel::cubic ? " cubic" : " quadratic") +
         (test.precision == Precision::single ? " float" : " double");
}

}  // namespace

void Measure::zero(const char* what, double value, const Tolerance& tolerance) {
  const bool is_single = test_.precision == Precision::single;
  const double found = std::abs(value), allowed = is_single ? tolerance.single : tolerance.real64;
  if (is_worse(found / allowed))
    detail_ = std::string(what) + " is off by " + number_text(found, 2) + ", allowed " +
              number_text(allowed, 2) + " (" + text(test_) + ")";
}

void Measure::between(const char* what, double value, double least, double most) {
  if (is_worse(std::abs(2 * value - least - most) / (most - least)))
    detail_ = std::string(what) + " is " + number_text(value, 2) + ", allowed " +
              number_text(least, 2) + " to " + number_text(most, 2) + " (" + text(test_) + ")";
}

void Measure::failure(const std::string& message) {
  worst_ = infinite;
  detail_ = message + " (" + text(test_) + ")";
}

/// Keeps the worst ratio; NaN is worse than everything.
bool Measure::is_worse(double ratio) {
  if (ratio <= worst_) return false;
  worst_ = std::isnan(ratio) ? infinite : ratio;
  return true;
}

}  // namespace neve::sim::checks::self_test
