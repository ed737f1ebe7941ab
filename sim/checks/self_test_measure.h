#pragma once
/// Measurements of a self-test: values found and tolerances.

#include <string>

#include "sim/checks/self_test.h"
#include "sim/laws/law.h"
#include "sim/types/math.h"

namespace neve::sim::checks::self_test {

using laws::rounding;
using laws::Tolerance;

/// Differences of energies with a step of 1e-5 are good to 1e-10 in double. In float the forces are
/// good to 1e-6, and random ones cancel in part.
inline constexpr Tolerance differences{1e-6, 2e-4};

/// The entry of largest magnitude.
inline double largest(const Mat3d& m) {
  return m.cwiseAbs().maxCoeff();
}

/// Worst value of one test, relative to its tolerance.
class Measure {
 public:
  explicit Measure(const SelfTestCase& test) : test_(test) {}

  /// Measures a value that has to be 0.
  void zero(const char* what, double value, const Tolerance& tolerance = rounding);
  /// Measures a value that has to lie in a range.
  void between(const char* what, double value, double least, double most);
  /// Notes something that could not be computed.
  void failure(const std::string& message);

  /// Ratio to the tolerance; negative where nothing was measured.
  double worst() const { return worst_; }
  const std::string& detail() const { return detail_; }

 private:
  bool is_worse(double ratio);

  SelfTestCase test_;
  double worst_ = -1;
  std::string detail_;
};

}  // namespace neve::sim::checks::self_test
