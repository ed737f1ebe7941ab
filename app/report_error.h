#pragma once
/// The one place where exceptions become messages and exit codes.

namespace neve::app {

/// Call it while an exception is handled. Prints one message on stderr and, if wanted, a JSON
/// object on stdout. @return the exit code
int report_current_error(bool is_json);

}  // namespace neve::app
