#pragma once
/// What the files that build the command line share.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace neve::app {

/// What parsing leaves to run.
using Action = std::function<int()>;

/// A repeatable option that takes one value each time, so that it does not swallow the scene.
CLI::Option* add_repeatable(CLI::App& command, const char* flag, std::vector<std::string>& values,
                            const char* type, const char* help);

/// @throws UsageError
void check_threads(int threads);
/// @throws UsageError with the names there are
void check_backend(const std::string& name);

void add_sweep(CLI::App& app, Action& action);

}  // namespace neve::app
