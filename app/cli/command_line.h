#pragma once
/// The command line: subcommands, flags, help.

#include "app/cli/report_error.h"

namespace neve::app::cli {

/// Parses and runs. @return the exit code
/// @throws UsageError, and the errors of the subcommand
int run_command_line(int argc, char** argv);

/// Finds out where the flags want errors; works on command lines that do not parse.
ErrorOutput error_output(int argc, char** argv);

}  // namespace neve::app::cli
