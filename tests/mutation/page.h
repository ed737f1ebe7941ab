#pragma once
/// docs/mistakes.md: which check notices which mistake.

#include <string>
#include <vector>

#include "tests/mutation/laboratory.h"

namespace neve::test {

/// A row of the table, without the end of the line.
std::string row(const Mistake& mistake, const Finding& finding);

std::string page(const std::vector<Mistake>& mistakes, const std::vector<Finding>& findings);

/// Checks that no mistake sets off: decoration.
std::vector<std::string> idle_checks(const std::vector<Finding>& findings);

}  // namespace neve::test
