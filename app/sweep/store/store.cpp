#include "app/sweep/store/store.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <system_error>

#include "app/output/atomic_file.h"
#include "app/output/checkpoint.h"
#include "app/output/json_file.h"
#include "app/output/sequence.h"
#include "app/record/run_json.h"
#include "app/scene/leaf.h"
#include "app/support/errors.h"
#include "app/support/version.h"
#include "app/sweep/plan/labels.h"

namespace neve::app::sweep::store {

namespace fs = std::filesystem;

namespace {

constexpr std::array states{"pending", "running", "ok",      "diverged",      "failed",
                            "refused", "timeout", "crashed", "out_of_memory", "interrupted"};

fs::path status_path(const fs::path& run_folder) {
  return run_folder / "status.json";
}

std::string text_of(const Json& json, const std::string& key) {
  const bool has_text = json.is_object() && json.contains(key) && json[key].is_string();
  return has_text ? json[key].get<std::string>() : "";
}

bool is_run_folder(const std::string& name) {
  return name.size() >= 4 && name.size() <= 8 &&
         std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

const char* name(RunState state) {
  return states[static_cast<std::size_t>(state)];
}

std::string run_folder_name(int number) {
  char text[16];
  std::snprintf(text, sizeof text, "%04d", number);
  return text;
}

fs::path runs_folder(const fs::path& sweep) {
  return sweep / "runs";
}

bool is_finished(RunState state) {
  return state == RunState::ok || has_failed(state);
}

bool has_failed(RunState state) {
  return state != RunState::pending && state != RunState::running && state != RunState::ok &&
         state != RunState::interrupted;
}

bool has_record(const RunStatus& status) {
  return status.state == RunState::ok ||
         (status.state == RunState::diverged && status.failed_beginning == 0);
}

int frames_made(const fs::path& run_folder, const std::string& view,
                const setup::FrameRange& frames, int known) {
  std::error_code error;
  while (known < frames.count() &&
         fs::exists(output::frame_path(run_folder, view, frames.first + known), error))
    ++known;
  return known;
}

std::filesystem::path beginning_folder(const std::filesystem::path& sweep, const Run& beginning) {
  return sweep /
         (beginning.index == 0 ? "beginning" : fmt::format("beginning_{}", beginning.index + 1));
}

RunStatus read_status(const fs::path& run_folder) {
  RunStatus status, damaged;
  std::error_code error;
  damaged.is_damaged = fs::exists(status_path(run_folder), error);
  try {
    const Json json = output::read_json(status_path(run_folder), 1 << 20);
    if (!record::is_untouched(json)) return damaged;
    const auto found = std::find(states.begin(), states.end(), json.at("state").get<std::string>());
    status.key = json.at("key").get<std::string>();
    status.simulation = json.value("simulation", "");
    status.reason = json.value("reason", "");
    status.short_reason = json.value("short_reason", "");
    status.exit_code = whole_number_or(json, "exit_code", 0);
    status.signal = whole_number_or(json, "signal", 0);
    status.attempts = whole_number_or(json, "attempts", 0);
    status.seconds = json.value("seconds", 0.0);
    status.peak_memory = whole_number_or(json, "peak_memory_bytes", std::uint64_t{0});
    status.pid = whole_number_or(json, "pid", 0L);
    status.host = json.value("host", "");
    status.failed_beginning = whole_number_or(json, "failed_beginning", 0);
    status.states = json.value("states", "");
    status.drawings = json.value("drawings", status.drawings);
    if (!(status.seconds >= 0 && status.seconds < 1e12) || status.attempts < 0) return damaged;
    if (found != states.end()) status.state = static_cast<RunState>(found - states.begin());
  } catch (const UnreadableError&) {
    throw;
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    return damaged;
  }
  return status;
}

void write_status(const fs::path& run_folder, const RunStatus& status) {
  Json json;
  json["version"] = version;
  json["state"] = name(status.state);
  json["key"] = status.key;
  json["simulation"] = status.simulation;
  json["reason"] = status.reason;
  json["short_reason"] = status.short_reason;
  json["exit_code"] = status.exit_code;
  json["signal"] = status.signal;
  json["attempts"] = status.attempts;
  json["seconds"] = status.seconds;
  json["peak_memory_bytes"] = status.peak_memory;
  json["pid"] = status.pid;
  json["host"] = status.host;
  if (status.failed_beginning > 0) json["failed_beginning"] = status.failed_beginning;
  if (!status.states.empty()) json["states"] = status.states;
  if (!status.drawings.empty()) json["drawings"] = status.drawings;
  output::write_file(status_path(run_folder), record::with_own_hash(json));
}

void note_record(const Json& run_json, RunStatus& status) {
  status.states.clear();
  status.drawings.clear();
  if (!has_record(status) || !run_json.is_object()) return;
  status.states = text_of(run_json, "simulation");
  if (const Json drawings = run_json.value("drawings", Json()); drawings.is_object())
    for (const auto& entry : drawings.items())
      status.drawings[entry.key()] = text_of(drawings, entry.key());
}

bool is_of_other_simulation(const RunStatus& status, const Json& run_json) {
  return run_json.is_object() && !status.states.empty() &&
         status.states != text_of(run_json, "simulation");
}

std::string difference_of_record(const RunStatus& status, const Json& run_json) {
  if (!run_json.is_object()) return {};
  if (is_of_other_simulation(status, run_json))
    return "is of another simulation than the sweep made";
  const Json drawings = run_json.value("drawings", Json());
  for (const auto& [view, drawing] : status.drawings)
    if (text_of(drawings, view) != drawing)
      return "has pictures of " + view + " that are drawn otherwise than the sweep did";
  return {};
}

Retry parse_retry(const std::string& text) {
  Retry retry;
  std::vector<std::string> failures;
  for (std::size_t k = 0; k < states.size(); ++k)
    if (const auto state = static_cast<RunState>(k); has_failed(state)) {
      failures.push_back(name(state));
      if (text == "all") retry.insert(state);
    }
  if (text == "all") return retry;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    const auto found = std::find(failures.begin(), failures.end(), word);
    if (found == failures.end())
      throw UsageError("--retry-failed", "no failed run has the state \"" + word + "\"",
                       "expected " + scene::list_of(failures));
    retry.insert(
        static_cast<RunState>(std::find(states.begin(), states.end(), word) - states.begin()));
  }
  if (retry.empty())
    throw UsageError("--retry-failed", "names no state", "expected " + scene::list_of(failures));
  return retry;
}

std::vector<KnownRun> known_runs(const fs::path& sweep) {
  std::vector<KnownRun> known;
  std::error_code error;
  for (fs::directory_iterator it(runs_folder(sweep), error), end; !error && it != end;
       it.increment(error)) {
    const fs::path& path = it->path();
    const std::string folder = path.filename().string();
    if (!is_run_folder(folder)) continue;
    const RunStatus status = read_status(path);
    if (!status.key.empty())
      known.push_back({folder, status.key, status.simulation, is_finished(status.state),
                       !output::kept_states(path).empty()});
  }
  std::sort(known.begin(), known.end(),
            [](const KnownRun& a, const KnownRun& b) { return a.folder < b.folder; });
  return known;
}

}  // namespace neve::app::sweep::store
