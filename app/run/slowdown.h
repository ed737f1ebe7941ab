#pragma once
/// A run that becomes much slower than it was at its start.

#include <optional>
#include <string>
#include <vector>

#include "app/record/run_json.h"

namespace neve::app::run {

/// Compares the slowest frame with the first that took steps: how many times as long it took, and
/// why. Nothing while both are alike, or all are short.
std::optional<std::string> slowdown_warning(const std::vector<record::FrameRecord>& frames);

}  // namespace neve::app::run
