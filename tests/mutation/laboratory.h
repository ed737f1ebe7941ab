#pragma once
/// Builds the probe with a mistake in it and runs it.

#include <filesystem>
#include <string>
#include <vector>

#include "tests/mutation/mistakes.h"

namespace neve::test {

/// The checks that noticed a mistake.
struct Finding {
  std::string trouble;  ///< why there is no finding: a lost place, a compiler's message
  std::vector<std::string> self_tests, drop, spin;

  bool is_caught() const { return !(self_tests.empty() && drop.empty() && spin.empty()); }
};

class Laboratory {
 public:
  /// @param folder for copies and objects
  explicit Laboratory(const std::filesystem::path& folder);

  /// One finding per mistake, in their order; several at once.
  std::vector<Finding> examine(const std::vector<Mistake>& mistakes) const;

 private:
  Finding examine(const Mistake& mistake) const;

  std::filesystem::path folder_;
  std::filesystem::path kernels_;  ///< without a mistake, for those that are elsewhere
};

}  // namespace neve::test
