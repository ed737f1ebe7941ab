#pragma once
/// The one place where exceptions become messages and exit codes.

#include <string>

namespace neve::app::cli {

/// Says where an error is written.
struct ErrorOutput {
  bool is_json = false;           ///< on stdout too, as JSON
  bool is_progress_json = false;  ///< on stderr as an event of --progress json
  std::string log;                ///< of --log; empty: none
};

/// Call it while an exception is handled. Prints one message on stderr and, if wanted, a JSON
/// object on stdout. @return the exit code
int report_current_error(const ErrorOutput& output);

/// Flushes std::cout. A reader that stops early is no error: `neve dump ... | head`.
/// @throws IoError when it cannot be written for another reason
void finish_output();

}  // namespace neve::app::cli
