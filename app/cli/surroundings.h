#pragma once
/// Warnings about what surrounds a command: the environment and the machine.

#include <string>
#include <vector>

#include "app/cli/report_error.h"
#include "app/options/option.h"

namespace neve::app::cli {

/// Sentences on variables that look like those of neve and are read by nothing.
/// @param environment  "NAME=VALUE"
/// @param flags        of the command, as in "--threads"
std::vector<std::string> misnamed_variables(const std::vector<std::string>& environment,
                                            const std::vector<std::string>& flags);

/// Warns of misnamed variables, and of many more threads than cores, on standard error.
void warn_of_surroundings(const options::Command& command, const ErrorOutput& output);

}  // namespace neve::app::cli
