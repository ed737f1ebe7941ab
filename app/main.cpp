/// neve: parse, dispatch, turn exceptions into exit codes.

#include <iostream>

#include "app/command_line.h"
#include "app/output/atomic_file.h"
#include "app/report_error.h"

int main(int argc, char** argv) {
  using namespace neve::app;
  ignore_write_signals();
  try {
    const int code = run_command_line(argc, argv);
    finish_output();
    return code;
  } catch (...) {
    return report_current_error(wants_json(argc, argv));
  }
}
