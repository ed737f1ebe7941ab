#include "app/pick/round_process.h"

#include <fstream>

#include "app/output/atomic_file.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/machine.h"

namespace neve::app::pick {

namespace fs = std::filesystem;

namespace {

/// Longer than a sweep gives its runs.
constexpr double grace = 30;  // s

fs::path log_in(const fs::path& folder) {
  return folder / "round.log";
}

fs::file_time_type manifest_time(const fs::path& folder) {
  std::error_code error;
  return fs::last_write_time(folder / "manifest.json", error);
}

sweep::jobs::Child started(const sweep::plan::SweepOptions& options) {
  output::make_folder(options.out);
  output::write_file(log_in(options.out), std::string_view{});
  sweep::jobs::ChildLimits limits;
  limits.grace = grace;
  return {
      {this_program(), round_arguments(options), fs::current_path()}, log_in(options.out), limits};
}

}  // namespace

std::vector<std::string> round_arguments(const sweep::plan::SweepOptions& options) {
  std::vector<std::string> words{"sweep",     options.file,    "--out",
                                 options.out, "--threads",     std::to_string(options.threads),
                                 "--backend", options.backend, "--quiet"};
  const auto add = [&](const char* flag, const std::string& value) {
    words.insert(words.end(), {flag, value});
  };
  if (options.frames)
    add("--frames",
        std::to_string(options.frames->first) + "-" + std::to_string(options.frames->last));
  if (options.size)
    add("--size", std::to_string(options.size->width) + "x" + std::to_string(options.size->height));
  if (options.coarsening) add("--coarsen", scene::toml::number_text(*options.coarsening));
  return words;
}

RoundProcess::RoundProcess(const sweep::plan::SweepOptions& options)
    : folder_(options.out), before_(manifest_time(folder_)), child_(started(options)) {}

std::optional<int> RoundProcess::poll() {
  if (code_) return code_;
  const std::optional<sweep::jobs::ChildResult> result = child_.poll();
  if (!result) return std::nullopt;
  using sweep::jobs::Ending;
  if (result->ending == Ending::exited)
    code_ = result->code;
  else
    code_ = result->ending == Ending::stopped ? exit_resumable : exit_internal;
  return code_;
}

bool RoundProcess::has_begun() const {
  return code_ == exit_ok || code_ == exit_runs_failed || manifest_time(folder_) != before_;
}

std::string RoundProcess::error() const {
  std::ifstream lines(log_in(folder_));
  std::string found;
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t at = line.find("error: "); at != std::string::npos)
      found = line.substr(at + std::string_view("error: ").size());
  if (found.empty() && code_ == exit_internal)
    found = "neve sweep ended without a reason; see " + log_in(folder_).string();
  return found;
}

}  // namespace neve::app::pick
