#pragma once
/// Messages for a command line that cannot be parsed.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace neve::app::cli {

/// Names of all subcommands, called or not.
std::vector<std::string> subcommand_names(const CLI::App& command);

/// CLI11 says of a misspelt subcommand only that one is required. @throws UsageError
void check_subcommand(const CLI::App& app, int argc, char** argv);

/// Reports an error of CLI11, with the expected value and the help to read. @throws UsageError
[[noreturn]] void fail_parse(const CLI::App& app, const CLI::ParseError& error);

/// Options and arguments that no command takes. @throws UsageError
void check_leftovers(const CLI::App& app);

/// The help of the command that these words name; of `app` where there are none.
/// @throws UsageError
std::string help_of(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace neve::app::cli
