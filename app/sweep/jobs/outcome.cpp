#include "app/sweep/jobs/outcome.h"

#include <charconv>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>

#include "app/output/atomic_file.h"
#include "app/output/sequence.h"
#include "app/support/errors.h"
#include "app/support/progress.h"
#include "app/support/text.h"

namespace neve::app::sweep::jobs {

namespace fs = std::filesystem;

namespace {

/// The last line that says something, of the last 64 KiB.
std::string last_message(const fs::path& log) {
  std::ifstream in(log, std::ios::binary | std::ios::ate);
  if (!in) return {};
  const std::streamoff size = in.tellg(), most = 1 << 16;
  in.seekg(std::max<std::streamoff>(0, size - most));
  std::string line, last;
  while (std::getline(in, line))
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  const std::string prefix = "neve: error: ";
  return last.starts_with(prefix) ? last.substr(prefix.size()) : last;
}

double fps_of(const store::Manifest& manifest, const store::ManifestRun& run) {
  const std::string given = run.value("fps");
  double fps = manifest.fps;
  std::from_chars(given.data(), given.data() + given.size(), fps);
  return fps;
}

/// Few words for the rule that broke; a rule that is not known here is named.
std::string rule_text(const std::string& rule, double value) {
  const std::string number = rough_text(value);
  if (rule == "acoustic_cfl") return "acoustic CFL " + number;
  if (rule == "speed_cfl") return number + " cells in one step";
  if (rule == "J_P") return "J_P fell to " + number;
  if (rule == "inverted") return "turned inside out";
  if (rule == "not_finite") return "not a finite number";
  if (rule == "overflow") return "left the lattice";
  if (rule == "energy") return "energy rose to " + number + " J";
  if (rule == "time_step") return "time step fell to " + number + " s";
  return rule;
}

void judge_divergence(const store::Manifest& manifest, const store::ManifestRun& run,
                      const fs::path& folder, store::RunReport& report) {
  report.state = store::RunState::diverged;
  try {
    const Json incident = parse_json(output::read_file(output::incident_path(folder)));
    report.reason = incident.at("sentence").get<std::string>();
    const double time = incident.value("time", 0.0);
    const auto frame = static_cast<int>(std::floor(time * fps_of(manifest, run)));
    const Json value = incident.value("value", Json());
    report.short_reason =
        "frame " + std::to_string(frame) + ": " +
        rule_text(incident.value("rule", ""), value.is_number() ? value.get<double>() : 0);
  } catch (const std::exception&) {
    report.reason = last_message(folder / "log");
  }
}

void judge_exit(const ChildResult& result, const store::Manifest& manifest,
                const store::ManifestRun& run, const fs::path& folder, store::RunReport& report) {
  report.exit_code = result.code;
  switch (result.code) {
    case exit_ok:
      report.state = store::RunState::ok;
      return;
    case exit_diverged:
      return judge_divergence(manifest, run, folder, report);
    case exit_resumable:
    case exit_interrupted:
      report.state = store::RunState::interrupted;
      report.reason = "interrupted";
      return;
    default:
      report.reason = last_message(folder / "log");
  }
  const bool is_memory = report.reason.find("memory") != std::string::npos;
  if (result.code == exit_refused && report.reason.find("out of memory") != std::string::npos)
    report.state = store::RunState::out_of_memory;
  else if (result.code == exit_refused)
    report.state = store::RunState::refused;
  else
    report.state = store::RunState::failed;
  report.short_reason = report.state == store::RunState::refused
                            ? (is_memory ? "memory limit" : "limit of the scene")
                            : "exit code " + std::to_string(result.code);
  if (report.state == store::RunState::out_of_memory) report.short_reason.clear();
}

void judge_signal(const ChildResult& result, const fs::path& folder, store::RunReport& report) {
  report.signal = result.signal;
  report.state = store::RunState::crashed;
  report.short_reason = "signal " + std::to_string(result.signal);
  report.reason = "ended by signal " + std::to_string(result.signal);
  if (const char* what = ::strsignal(result.signal)) report.reason += std::string(", ") + what;
  if (result.signal == SIGKILL)
    report.reason += "; the system kills processes that take too much memory, see dmesg";
  // An allocation that fails in a thread ends in abort.
  if (result.signal != SIGABRT ||
      last_message(folder / "log").find("bad_alloc") == std::string::npos)
    return;
  report.state = store::RunState::out_of_memory;
  report.reason = "an allocation failed";
  report.short_reason.clear();
}

}  // namespace

void judge(const ChildResult& result, const store::Manifest& manifest,
           const store::ManifestRun& run, const fs::path& run_folder, store::RunReport& report) {
  report.exit_code = report.signal = 0;
  report.reason.clear();
  report.short_reason.clear();
  report.pid = 0;
  report.seconds += result.seconds;
  report.peak_memory = std::max(report.peak_memory, result.peak_memory);
  switch (result.ending) {
    case Ending::exited:
      return judge_exit(result, manifest, run, run_folder, report);
    case Ending::signaled:
      return judge_signal(result, run_folder, report);
    case Ending::timeout:
      report.state = store::RunState::timeout;
      report.short_reason = "after " + duration_text(manifest.timeout);
      report.reason = "stopped after " + duration_text(manifest.timeout) + ", [limits] timeout";
      return;
    case Ending::out_of_memory:
      report.state = store::RunState::out_of_memory;
      report.short_reason = "over " + bytes_text(static_cast<std::uint64_t>(manifest.memory));
      report.reason = "used more than " + bytes_text(static_cast<std::uint64_t>(manifest.memory)) +
                      " of memory, [limits] memory";
      return;
    case Ending::stopped:
      report.state = store::RunState::interrupted;
      report.reason = "interrupted";
  }
}

std::string tile_text(const store::RunReport& report) {
  const auto with_reason = [&](const char* word) {
    return report.short_reason.empty() ? std::string(word) : word + (" " + report.short_reason);
  };
  switch (report.state) {
    case store::RunState::pending:
      return "not run yet";
    case store::RunState::running:
      return "running";
    case store::RunState::ok:
      return {};
    case store::RunState::diverged:
      return with_reason("DIVERGED");
    case store::RunState::failed:
      return with_reason("FAILED");
    case store::RunState::refused:
      return with_reason("REFUSED");
    case store::RunState::timeout:
      return with_reason("TIMEOUT");
    case store::RunState::crashed:
      return with_reason("CRASHED");
    case store::RunState::out_of_memory:
      return with_reason("OUT OF MEMORY");
    case store::RunState::interrupted:
      return "interrupted";
  }
  return {};
}

}  // namespace neve::app::sweep::jobs
