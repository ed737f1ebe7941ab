#pragma once
/// Time and memory that a run of the program takes.

#include <sys/resource.h>

#include <string>

#include "tests/cli/run_neve.h"
#include "tests/support/child.h"

namespace neve::test {

struct Cost {
  int exit_code = -1;
  double seconds = 0;  ///< of processors
  double memory = 0;   ///< bytes at most
};

class CostlyCli : public Cli {
 protected:
  Cost cost_of(const std::string& arguments) {
    const pid_t child =
        start_program({"/bin/bash", "-c", "cd \"$1\" && exec \"$0\" " + arguments + " >told 2>said",
                       NEVE_BINARY, folder.path().string()});
    int status = 0;
    rusage usage{};
    ::wait4(child, &status, 0, &usage);
    const auto seconds = [](const timeval& t) {
      return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            seconds(usage.ru_utime) + seconds(usage.ru_stime), 1024.0 * double(usage.ru_maxrss)};
  }

  std::string with_views(int count, const std::string& size) {
    std::string text = tiny_scene;
    for (int k = 0; k < count; ++k)
      text += "[[view]]\nname = \"v" + std::to_string(k) +
              "\"\nlayers = [\"particles\"]\nsize = " + size + "\n";
    return text;
  }
};

}  // namespace neve::test
