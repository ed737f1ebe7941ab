#include "app/sweep/jobs/engine.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <list>
#include <optional>
#include <set>
#include <system_error>
#include <thread>

#include "app/output/checkpoint.h"
#include "app/output/sequence.h"
#include "app/support/interrupt.h"
#include "app/support/machine.h"
#include "app/support/text.h"
#include "app/sweep/jobs/child.h"
#include "app/sweep/jobs/outcome.h"
#include "app/sweep/plan/order.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::jobs {

namespace fs = std::filesystem;

namespace {

constexpr auto poll_interval = std::chrono::milliseconds(5);

std::string host_name() {
  char name[256] = "";
  ::gethostname(name, sizeof name - 1);
  return name;
}

/// In which the next runs are started.
std::deque<const store::ManifestRun*> queue_of(const store::Manifest& manifest,
                                               const std::vector<int>& indices) {
  std::vector<std::vector<int>> coordinates;
  std::vector<int> sizes;
  for (const store::ManifestRun& run : manifest.runs) coordinates.push_back(run.coordinates);
  for (const store::ManifestAxis& axis : manifest.axes)
    sizes.push_back(static_cast<int>(axis.values.size()));
  std::deque<const store::ManifestRun*> queue;
  std::set<std::string> keys;
  for (const std::size_t k : plan::coarse_first(coordinates, sizes)) {
    const store::ManifestRun& run = manifest.runs[k];
    const bool is_wanted = std::find(indices.begin(), indices.end(), run.index) != indices.end();
    // Equal runs share a folder: one of them is enough.
    if (is_wanted && keys.insert(run.key).second) queue.push_back(&run);
  }
  return queue;
}

class LocalEngine {
 public:
  LocalEngine(const fs::path& folder, const store::Manifest& manifest, const EngineOptions& options,
              Progress& progress)
      : folder_(folder), manifest_(manifest), options_(options), progress_(progress) {}

  EngineResult run(const std::vector<int>& indices) {
    const auto start = Child::Clock::now();
    queue_ = queue_of(manifest_, indices);
    state_.all = static_cast<int>(queue_.size());
    skip_finished();
    for (const store::ManifestRun* run : queue_) work_left_ += run->work;
    clock_.note(0);
    while (!active_.empty() || !queue_.empty()) {
      if (is_interrupted()) stop();
      start_what_fits();
      collect_ended();
      show();
      if (!active_.empty()) std::this_thread::sleep_for(poll_interval);
    }
    progress_.clear();
    result_.is_interrupted |= is_interrupted();
    result_.seconds = std::chrono::duration<double>(Child::Clock::now() - start).count();
    return result_;
  }

 private:
  struct Active {
    const store::ManifestRun* run;
    fs::path folder;
    store::RunLock lock;
    store::RunReport report;
    Child child;
    int threads;
    int frame;  ///< the next one that was not there yet
  };

  fs::path folder_of(const store::ManifestRun& run) const {
    return store::runs_folder(folder_) / run.folder;
  }

  void count(const store::RunReport& report) {
    ++state_.finished;
    if (report.state == store::RunState::ok) ++result_.ok;
    if (!store::has_failed(report.state)) return;
    ++result_.failed;
    ++state_.failed;
  }

  void skip_finished() {
    std::erase_if(queue_, [&](const store::ManifestRun* run) {
      const store::RunReport report = store::read_report(folder_of(*run));
      const bool is_again = options_.is_failed_again && store::has_failed(report.state);
      if (!store::is_finished(report.state) || is_again) return false;
      count(report);
      return true;
    });
  }

  void stop() {
    queue_.clear();
    for (Active& active : active_) active.child.stop();
  }

  int free_cores() const {
    int used = 0;
    for (const Active& active : active_) used += active.threads;
    return options_.cores - used;
  }

  /// Memory that is there and not promised to a run that has just begun to take it.
  double free_memory() const {
    double memory = static_cast<double>(available_memory());
    for (const Active& active : active_)
      if (active.child.seconds() < 5) memory -= active.run->memory;
    return memory;
  }

  void start_what_fits() {
    while (!queue_.empty()) {
      const int left = static_cast<int>(queue_.size() + active_.size());
      const bool is_full =
          options_.jobs > 0
              ? static_cast<int>(active_.size()) >= options_.jobs
              : free_cores() <= 0 || (!active_.empty() && queue_.front()->memory > free_memory());
      if (is_full) return;
      const store::ManifestRun* run = queue_.front();
      queue_.pop_front();
      const int threads =
          options_.jobs > 0
              ? std::max(1, options_.cores / options_.jobs)
              : std::min(free_cores(), threads_for(*run, left, options_.cores, free_memory()));
      start(*run, std::max(1, threads));
    }
  }

  void start(const store::ManifestRun& run, int threads) {
    const fs::path folder = folder_of(run);
    store::RunLock lock(folder);
    if (!lock.is_held()) {
      progress_.warning(store::run_text(run) + " is in progress in another sweep");
      --state_.all;
      work_left_ -= run.work;
      return;
    }
    store::RunReport report = store::read_report(folder);
    if (is_over_memory(run, report, folder)) return;
    const bool goes_on = report.state == store::RunState::running ||
                         report.state == store::RunState::interrupted ||
                         report.state == store::RunState::timeout;
    if (!goes_on) clean(folder);
    Child child({options_.program, arguments_of(run, threads, goes_on), folder, folder / "log"},
                {manifest_.timeout, static_cast<std::uint64_t>(manifest_.memory), options_.grace});
    report.state = store::RunState::running;
    ++report.attempts;
    report.pid = child.pid();
    report.host = host_name();
    report.reason.clear();
    report.short_reason.clear();
    store::write_report(folder, report);
    ++result_.started;
    progress_.detail(store::run_text(run) + " starts on " + std::to_string(threads) +
                     (threads == 1 ? " thread" : " threads"));
    active_.push_back({&run, folder, std::move(lock), std::move(report), std::move(child), threads,
                       run.first_frame});
  }

  /// Known before anything is started.
  bool is_over_memory(const store::ManifestRun& run, store::RunReport& report,
                      const fs::path& folder) {
    if (manifest_.memory <= 0 || run.memory <= manifest_.memory) return false;
    report.state = store::RunState::out_of_memory;
    const std::string needed = bytes_text(static_cast<std::uint64_t>(run.memory)),
                      allowed = bytes_text(static_cast<std::uint64_t>(manifest_.memory));
    report.short_reason = "needs " + needed;
    report.reason = "about " + needed + " of memory are needed, [limits] memory allows " + allowed;
    finish(run, folder, report);
    return true;
  }

  /// Removes the files of an abandoned attempt.
  static void clean(const fs::path& folder) {
    output::remove_earlier_run(folder);
    output::remove_checkpoints(folder);
    std::error_code error;
    fs::remove(folder / "log", error);
    fs::remove(output::run_json_path(folder), error);
  }

  std::vector<std::string> arguments_of(const store::ManifestRun& run, int threads,
                                        bool goes_on) const {
    std::vector<std::string> words{
        "render",     "scene.toml",
        "--out",      ".",
        "--frames",   std::to_string(run.first_frame) + "-" + std::to_string(run.last_frame),
        "--threads",  std::to_string(threads),
        "--backend",  options_.backend,
        "--no-movie", "--quiet"};
    if (goes_on) words.push_back("--resume");
    return words;
  }

  void collect_ended() {
    for (auto active = active_.begin(); active != active_.end();) {
      const std::optional<ChildResult> ended = active->child.poll();
      if (!ended) {
        ++active;
        continue;
      }
      result_.cpu_seconds += ended->cpu_seconds;
      result_.core_seconds += ended->seconds * active->threads;
      judge(*ended, manifest_, *active->run, active->folder, active->report);
      finish(*active->run, active->folder, active->report);
      if (active->report.state == store::RunState::ok) output::remove_checkpoints(active->folder);
      active = active_.erase(active);
    }
  }

  void finish(const store::ManifestRun& run, const fs::path& folder,
              const store::RunReport& report) {
    store::write_report(folder, report);
    if (store::is_finished(report.state)) count(report);
    // Also by another process: then the sweep is not done either.
    if (report.state == store::RunState::interrupted) result_.is_interrupted = true;
    work_done_ += run.work;
    work_left_ -= run.work;
    clock_.note(work_done_);
    const std::string what = store::run_text(run) + (run.label.empty() ? "" : ", " + run.label);
    if (store::has_failed(report.state))
      progress_.note(what + ": " + tile_text(report) +
                     (report.reason.empty() ? "" : "\n  " + report.reason));
    else
      progress_.detail(what + ": " + store::name(report.state) + " after " +
                       fixed_text(report.seconds, 1) + " s");
  }

  void show() {
    state_.running = static_cast<int>(active_.size());
    const auto now = Child::Clock::now();
    if (now - shown_at_ < std::chrono::milliseconds(500)) return;
    shown_at_ = now;
    // Frames that are there count as work done, so that few long runs have an estimate too.
    double begun = 0;
    for (Active& active : active_) {
      std::error_code error;
      while (active.frame <= active.run->last_frame &&
             fs::exists(output::frame_path(active.folder, manifest_.view, active.frame), error))
        ++active.frame;
      const int all = active.run->last_frame - active.run->first_frame + 1;
      begun += active.run->work * (active.frame - active.run->first_frame) / all;
    }
    clock_.note(work_done_ + begun);
    state_.seconds_left = clock_.seconds_for(std::max(0.0, work_left_ - begun));
    progress_.line(runs_text(state_));
  }

  const fs::path& folder_;
  const store::Manifest& manifest_;
  const EngineOptions& options_;
  Progress& progress_;
  std::deque<const store::ManifestRun*> queue_;
  std::list<Active> active_;
  EngineResult result_;
  RunsState state_;
  WorkClock clock_;
  double work_done_ = 0, work_left_ = 0;
  Child::Clock::time_point shown_at_;
};

}  // namespace

int threads_for(const store::ManifestRun& run, int left, int cores, double memory) {
  // Fewer particles than these are not worth a thread's share of a step.
  constexpr double least = 4000;
  const double fitting = run.memory > 0 ? std::max(1.0, std::floor(memory / run.memory)) : cores;
  const double together =
      std::min({static_cast<double>(cores), static_cast<double>(left), fitting});
  const auto threads = static_cast<int>(cores / std::max(1.0, together));
  const auto useful = static_cast<int>(std::clamp(run.particles / least, 1.0, 1024.0));
  return std::clamp(threads, 1, useful);
}

EngineResult run_local(const fs::path& folder, const store::Manifest& manifest,
                       const std::vector<int>& indices, const EngineOptions& options,
                       Progress& progress) {
  return LocalEngine(folder, manifest, options, progress).run(indices);
}

}  // namespace neve::app::sweep::jobs
