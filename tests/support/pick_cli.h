#pragma once
/// `neve pick` on a small scene, answered by a script, a list, a page or a terminal.

#include <sstream>

#include "tests/cli/run_neve.h"
#include "tests/support/child.h"

namespace neve::test {

class PickSearch : public Cli {
 protected:
  /// Runs of three frames, some hundred pixels each.
  std::vector<std::string> words(const std::string& out,
                                 const std::vector<std::string>& more = {}) {
    std::vector<std::string> all{"pick",     "scene.toml",
                                 "--out",    out,
                                 "--frames", "2",
                                 "--size",   "64x36",
                                 "-p",       "material.snow.hardening=2,20",
                                 "-p",       "material.snow.youngs_modulus=2e4,1e6"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  app::output::ProcessResult replay(const std::string& script, const std::string& out,
                                    const std::vector<std::string>& more = {}) {
    folder.write("script.json", script);
    std::vector<std::string> all = words(out, {"--replay", "script.json"});
    all.insert(all.end(), more.begin(), more.end());
    return neve(all);
  }

  app::output::ProcessResult by_list(const std::string& clicks, const std::string& out) {
    folder.write("list.txt", clicks);
    return neve(words(out, {"--clicks", "list.txt"}));
  }

  /// Starts it in the background; what it prints goes to told and said.
  pid_t start(const std::string& out, const std::string& more) {
    std::string line;
    for (const std::string& word : words(out)) line += " '" + word + "'";
    return start_program(
        {"/bin/bash", "-c",
         "cd \"$1\" && exec \"$0\"" + line + " " + more + " >told 2>said </dev/null", NEVE_BINARY,
         folder.path().string()});
  }

  void expect_same_pick(const std::string& a, const std::string& b) {
    for (const char* file : {"/clicks.txt", "/picked.toml", "/picked_sweep.toml", "/learned.txt"}) {
      EXPECT_FALSE(read_text(folder / (a + file)).empty()) << a << file;
      EXPECT_EQ(read_text(folder / (a + file)), read_text(folder / (b + file))) << file;
    }
  }

  /// The answers in the folder, without the comments.
  std::string answers(const std::string& out) {
    std::string found;
    std::istringstream lines(read_text(folder / out / "clicks.txt"));
    for (std::string line; std::getline(lines, line);)
      if (!line.empty() && line[0] != '#') found += line + "\n";
    return found;
  }

  /// Two minutes at most.
  template <class IsTrue>
  static bool wait_until(IsTrue is_true) {
    for (int k = 0; k < 2400; ++k) {
      if (is_true()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
};

}  // namespace neve::test
