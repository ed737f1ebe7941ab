#pragma once
/// The one place where exceptions become messages and exit codes.

namespace neve::app::cli {

/// Call it while an exception is handled. Prints one message on stderr and, if wanted, a JSON
/// object on stdout. @return the exit code
int report_current_error(bool is_json);

/// Flushes std::cout. A reader that stops early is no error: `neve dump ... | head`.
/// @throws IoError when it cannot be written for another reason
void finish_output();

}  // namespace neve::app::cli
