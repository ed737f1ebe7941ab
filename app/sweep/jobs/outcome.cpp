#include "app/sweep/jobs/outcome.h"

#include <fmt/core.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>

#include "app/output/json_file.h"
#include "app/output/sequence.h"
#include "app/support/errors.h"
#include "app/support/progress.h"
#include "app/support/text.h"

namespace neve::app::sweep::jobs {

namespace fs = std::filesystem;

namespace {

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

void judge_divergence(const store::Manifest& manifest, const Run& run, const fs::path& folder,
                      store::RunStatus& status) {
  status.state = store::RunState::diverged;
  try {
    const Json incident = output::read_json(output::incident_path(folder));
    status.reason = incident.at("sentence").get<std::string>();
    const double time = incident.value("time", 0.0);
    const auto frame =
        manifest.first_number + static_cast<int>(std::floor(time * manifest.fps_of(run)));
    const Json value = incident.value("value", Json());
    status.short_reason = fmt::format(
        "frame {}: {}", frame,
        rule_text(incident.value("rule", ""), value.is_number() ? value.get<double>() : 0));
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    status.reason = last_error(folder / "log");
  }
}

bool is_of_machine(int exit_code) {
  return exit_code == exit_io || exit_code == exit_no_backend;
}

void judge_exit(const ChildResult& result, const store::Manifest& manifest, const Run& run,
                const fs::path& folder, store::RunStatus& status) {
  status.exit_code = result.code;
  switch (result.code) {
    case exit_ok:
      status.state = store::RunState::ok;
      return;
    case exit_diverged:
      return judge_divergence(manifest, run, folder, status);
    case exit_resumable:
    case exit_interrupted:
      status.state = store::RunState::interrupted;
      status.reason = "interrupted";
      return;
    default:
      status.reason = last_error(folder / "log");
      // A log that cannot be written or read is the machine's too.
      if (status.reason.empty())
        status.reason =
            fmt::format("ended with exit code {} and no message in its log", result.code);
  }
  const bool has_no_memory =
      result.code == exit_refused && status.reason.find("out of memory") != std::string::npos;
  // Memory that no limit of the sweep forbids is the machine's.
  if (is_of_machine(result.code) || (has_no_memory && manifest.memory <= 0)) {
    status.state = store::RunState::interrupted;
    return;
  }
  const bool is_memory = status.reason.find("memory") != std::string::npos;
  if (has_no_memory)
    status.state = store::RunState::out_of_memory;
  else if (result.code == exit_refused)
    status.state = store::RunState::refused;
  else
    status.state = store::RunState::failed;
  status.short_reason = status.state == store::RunState::refused
                            ? (is_memory ? "memory limit" : "limit of the scene")
                            : fmt::format("exit code {}", result.code);
  if (status.state == store::RunState::out_of_memory) status.short_reason.clear();
}

void judge_signal(const ChildResult& result, const fs::path& folder, store::RunStatus& status) {
  status.signal = result.signal;
  status.state = store::RunState::crashed;
  status.short_reason = fmt::format("signal {}", result.signal);
  status.reason = fmt::format("ended by signal {}", result.signal);
  if (const char* name = ::strsignal(result.signal)) status.reason += fmt::format(", {}", name);
  if (result.signal == SIGKILL)
    status.reason += "; the system kills processes that take too much memory, see dmesg";
  // An allocation that fails in a thread ends in abort.
  if (result.signal != SIGABRT || last_error(folder / "log").find("bad_alloc") == std::string::npos)
    return;
  status.state = store::RunState::out_of_memory;
  status.reason = "an allocation failed";
  status.short_reason.clear();
}

}  // namespace

std::string last_error(const fs::path& log) {
  std::ifstream in(log, std::ios::binary | std::ios::ate);
  if (!in) return {};
  const std::streamoff size = in.tellg(), most = 1 << 16;
  in.seekg(std::max<std::streamoff>(0, size - most));
  std::string text(static_cast<std::size_t>(std::clamp<std::streamoff>(size, 0, most)), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  const std::string line = last_line(text);
  const Json event = Json::parse(line, nullptr, false);
  if (event.is_object()) {
    if (event.value("event", "") != "error") return {};
    const std::string text = event.value("error", ""), hint = event.value("hint", "");
    const bool is_said = hint.empty() || text.find(hint) != std::string::npos;
    return text + (is_said ? "" : "; " + hint);
  }
  const std::string prefix = "neve: error: ";
  return line.starts_with(prefix) ? line.substr(prefix.size()) : line;
}

void judge(const ChildResult& result, const store::Manifest& manifest, const Run& run,
           const fs::path& run_folder, store::RunStatus& status) {
  status.exit_code = status.signal = 0;
  status.reason.clear();
  status.short_reason.clear();
  status.pid = 0;
  status.seconds += result.seconds;
  status.peak_memory = std::max(status.peak_memory, result.peak_memory);
  const std::string memory_limit = bytes_text(static_cast<std::uint64_t>(manifest.memory));
  switch (result.ending) {
    case Ending::exited:
      return judge_exit(result, manifest, run, run_folder, status);
    case Ending::signaled:
      return judge_signal(result, run_folder, status);
    case Ending::timeout:
      status.state = store::RunState::timeout;
      status.short_reason = fmt::format("after {}", duration_text(manifest.timeout));
      status.reason = fmt::format("stopped {}, [limits] timeout", status.short_reason);
      return;
    case Ending::out_of_memory:
      status.state = store::RunState::out_of_memory;
      status.short_reason = fmt::format("over {}", memory_limit);
      status.reason = fmt::format("used more than {} of memory, [limits] memory", memory_limit);
      return;
    case Ending::stopped:
      status.state = store::RunState::interrupted;
      status.reason = "interrupted";
  }
}

bool is_machine_failure(const store::RunStatus& status) {
  const bool has_no_memory =
      status.state == store::RunState::interrupted && status.exit_code == exit_refused;
  return is_of_machine(status.exit_code) || has_no_memory;
}

std::string tile_text(const store::RunStatus& status) {
  const auto with_reason = [&](const char* word) {
    return status.short_reason.empty() ? std::string(word) : word + (" " + status.short_reason);
  };
  switch (status.state) {
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
