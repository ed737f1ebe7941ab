#pragma once
/// The options of a command, listed for people and for programs.

#include <string>
#include <vector>

#include "app/options/option.h"
#include "app/support/json.h"

namespace neve::app::options {

/// @param parts  commands below it
/// @param width  of the lines; 0: they are not broken
std::string help_text(const Command& command, const std::vector<const Command*>& parts, int width);

/// Name, help and options: a list of name, letter, type, default, help, is_repeatable, is_required.
Json to_json(const Command& command);

/// "neve sweep run [OPTIONS] DIR"
std::string usage_line(const Command& command, bool has_parts);

/// The help of an option, with its default.
std::string sentence_of(const Option& option);

}  // namespace neve::app::options
