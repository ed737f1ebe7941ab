/// neve: parse, dispatch, turn exceptions into exit codes.

#include <fcntl.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/cli/command_line.h"
#include "app/output/atomic_file.h"

namespace {

/// A standard stream that is closed is opened on nothing, the wrong way round: no file that is
/// opened later takes its place, and using it is still an error.
void hold_standard_streams() {
  for (int stream = 0; stream < 3; ++stream)
    if (::fcntl(stream, F_GETFD) < 0) ::open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  using namespace neve::app;
  hold_standard_streams();
  output::ignore_write_signals();
  try {
    const int code = cli::run_command_line(words);
    cli::finish_output();
    return code;
  } catch (...) {
    return cli::report_current_error(cli::error_output(words));
  }
}
