#pragma once
/// The command line: subcommands, flags, help.

namespace neve::app::cli {

/// Parses and runs. @return the exit code
/// @throws UsageError, and the errors of the subcommand
int run_command_line(int argc, char** argv);

/// True if errors are wanted as JSON too; works on command lines that do not parse.
bool wants_json(int argc, char** argv);

}  // namespace neve::app::cli
