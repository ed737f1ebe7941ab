#pragma once
/// Python with the modules that a test needs, and scripts of tests/python.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/output/process.h"

namespace neve::test {

/// The system's Python first: its modules are Debian's packages. Nothing where it lacks the module.
inline std::optional<std::filesystem::path> python_with(const std::string& module) {
  std::vector<std::filesystem::path> candidates{"/usr/bin/python3"};
  if (const auto found = app::output::find_program("python3")) candidates.push_back(*found);
  for (const std::filesystem::path& python : candidates) {
    std::error_code error;
    if (!std::filesystem::exists(python, error)) continue;
    if (app::output::run_process(python, {"-c", "import " + module}, "/").exit_code == 0)
      return python;
  }
  return std::nullopt;
}

/// Runs tests/python/NAME in a folder. @param variables  of the environment: "NAME=VALUE"
inline app::output::ProcessResult run_script_with(const std::filesystem::path& python,
                                                  const std::vector<std::string>& variables,
                                                  const std::string& name,
                                                  const std::vector<std::string>& arguments,
                                                  const std::filesystem::path& folder) {
  std::vector<std::string> words = variables;
  words.insert(words.end(),
               {python.string(), "-B", std::string(NEVE_SOURCE_DIR "/tests/python/") + name});
  words.insert(words.end(), arguments.begin(), arguments.end());
  return app::output::run_process("/usr/bin/env", words, folder);
}

inline app::output::ProcessResult run_script(const std::filesystem::path& python,
                                             const std::string& name,
                                             const std::vector<std::string>& arguments,
                                             const std::filesystem::path& folder) {
  return run_script_with(python, {}, name, arguments, folder);
}

}  // namespace neve::test
