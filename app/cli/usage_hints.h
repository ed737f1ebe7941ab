#pragma once
/// Messages for a command line that names what there is not.

#include <string>
#include <vector>

#include "app/cli/command_line.h"

namespace neve::app::cli {

/// The words have to start with a command, and with a part of one that does nothing without.
/// @throws UsageError
void check_command(Entry& program, const std::vector<std::string>& words);

/// Refuses a word that no option of the command takes. @throws UsageError
[[noreturn]] void refuse_leftover(const Entry& entry, const std::string& word);

/// Refuses to help with what is no part of a command. @throws UsageError
[[noreturn]] void refuse_help(const Entry& entry, const std::string& word);

}  // namespace neve::app::cli
