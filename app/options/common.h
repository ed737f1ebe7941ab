#pragma once
/// Options that several commands have.

#include <string>

#include "app/options/option.h"
#include "app/output/movie_format.h"
#include "app/setup/caps.h"
#include "app/support/progress.h"

namespace neve::app::options {

/// --threads
void describe_threads(Command& visit, int& threads,
                      const char* help = "Number of threads; 0: one per core");
/// --backend
void describe_backend(Command& visit, std::string& backend,
                      const char* help = "OpenGL backend; neve doctor lists them");
/// --max-memory and --max-particles, which hold from then on for this process and its children.
void describe_caps(Command& visit, setup::CapTexts& caps);
/// --movie, --movie-quality and --movie-fps
void describe_movie(Command& visit, output::MovieStyle& movie);
/// --progress and --log
void describe_progress(Command& visit, ProgressOptions& progress);
/// Help of --json, for a command that has one result.
inline constexpr const char* json_help = "Print the result, or the error, as JSON";
/// --quiet, and --verbose where it has a help
void describe_verbosity(Command& visit, Verbosity& verbosity, const char* verbose = nullptr,
                        const char* quiet = "Print only errors and warnings");

/// False for the names of scenes, pictures and geometry, to which no message is appended: in
/// `neve render --log scene.toml` the name of the log was forgotten.
bool is_log_name(const std::string& file);

}  // namespace neve::app::options
