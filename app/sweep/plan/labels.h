#pragma once
/// Labels of runs and axes.

#include <string>
#include <vector>

#include "app/sweep/plan/sweep_plan.h"

namespace neve::app::sweep::plan {

/// Last words of addresses, with as many before them as tell them apart.
std::vector<std::string> short_names(const std::vector<std::string>& addresses);

/// 1.4e5, [0, -5, 0], flip: a value as it is given, texts without quotes, numbers with at most six
/// digits.
std::string value_text(const std::string& value);

/// "spread (m)"; without a unit the title alone.
std::string titled(const std::string& title, const std::string& unit);

/// All parameters that differ between runs, in the order of the file.
std::vector<Parameter> varied_parameters(const SweepPlan& plan);

/// "hardening = 5, youngs_modulus = 48000 Pa" without those of the sweep's fixed settings.
std::string settings_text(const SweepPlan& plan, const Run& run);

}  // namespace neve::app::sweep::plan
