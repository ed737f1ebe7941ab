#pragma once
/// The one place where exceptions become messages and exit codes.

#include <string>

#include "app/support/json.h"

namespace neve::app::cli {

/// Says where an error is written.
struct ErrorOutput {
  bool is_json = false;           ///< on stdout too, as JSON
  bool is_progress_json = false;  ///< on stderr as an event of --progress json
  std::string log;                ///< of --log; empty: none
};

/// Keeps the answer of --json until the command ends: with an error after it, both are one document
/// on stdout.
void set_answer(Json answer);

/// Lets a request to stop that comes before anything is made be answered like an error.
void prepare_interrupt(const ErrorOutput& output);

/// Call it while an exception is handled. Prints one message on stderr and, if wanted, a JSON
/// object on stdout. @return the exit code
int report_current_error(const ErrorOutput& output);

/// Prints the answer, if there is one, and flushes std::cout. A reader that stops early is no
/// error: `neve dump ... | head`.
/// @throws IoError when it cannot be written for another reason
void finish_output();

}  // namespace neve::app::cli
