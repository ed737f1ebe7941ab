/// neve: parse, dispatch, turn exceptions into exit codes.

#include <iostream>

#include "app/cli/command_line.h"
#include "app/cli/report_error.h"
#include "app/output/atomic_file.h"

int main(int argc, char** argv) {
  using namespace neve::app;
  output::ignore_write_signals();
  try {
    const int code = cli::run_command_line(argc, argv);
    cli::finish_output();
    return code;
  } catch (...) {
    return cli::report_current_error(cli::wants_json(argc, argv));
  }
}
