#pragma once
/// The words of a command line, read into the options of a command.

#include <string>
#include <vector>

#include "app/options/option.h"

namespace neve::app::options {

/// Reads words as they follow the name of the command: "--flag VALUE", "--flag=VALUE", "-fVALUE",
/// "-qv", arguments in their order; after "--" all words are arguments. Command::check_all() is
/// left to the caller.
/// @return words that no option takes; then no value has been read @throws UsageError
std::vector<std::string> parse(Command& command, const std::vector<std::string>& words);

}  // namespace neve::app::options
