#pragma once
/// Common parts of the files that build the command line.

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/movie_flags.h"

namespace neve::app::cli {

/// Action to run after parsing.
using Action = std::function<int()>;

/// A repeatable option that takes one value each time, so that it does not swallow the scene.
CLI::Option* add_repeatable(CLI::App& command, const char* flag, std::vector<std::string>& values,
                            const char* type, const char* help);

/// @throws UsageError
void check_threads(int threads);
/// @throws UsageError with the names there are
void check_backend(const std::string& name);

/// Values that CLI11 hands over as text; turned into options when parsing is done.
struct RenderTexts {
  std::optional<std::string> frames, from, size, quality, passes, coarsening, progress;
  bool is_quiet = false, is_verbose = false;
  MovieTexts movie;
};

/// Adds --progress and --log.
void add_progress(CLI::App& command, std::optional<std::string>& progress,
                  ProgressOptions& options);
/// @throws UsageError
bool parse_progress(const std::string& text);

/// Adds --max-memory and --max-particles: bounds that no scene can raise.
void add_caps(CLI::App& command);

/// Refuses the name of a file for the folder of outputs: a folder x.png is found by nobody.
/// @param example  of a file in it
/// @throws UsageError
void require_folder_name(const std::string& out, const std::string& example);

/// @throws UsageError
run::RenderOptions finished(run::RenderOptions options, const RenderTexts& texts);

/// Options of all commands that read a scene: the scene and its changes.
void add_scene(CLI::App& command, const std::shared_ptr<run::RenderOptions>& options,
               const std::shared_ptr<RenderTexts>& texts);

/// The same, of commands that take the folder of a run, too.
void add_origin(CLI::App& command, const std::shared_ptr<run::RenderOptions>& options,
                const std::shared_ptr<RenderTexts>& texts);

void add_sweep(CLI::App& app, Action& action);
void add_pick(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_dump(CLI::App& app, Action& action);
void add_export(CLI::App& app, Action& action);
void add_strip(CLI::App& app, Action& action);
void add_view(CLI::App& app, Action& action);
void add_new(CLI::App& app, Action& action);
void add_schema(CLI::App& app, Action& action);

}  // namespace neve::app::cli
