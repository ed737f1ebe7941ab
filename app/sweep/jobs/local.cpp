#include "app/sweep/jobs/local.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <list>
#include <optional>
#include <set>
#include <system_error>
#include <thread>

#include "app/options/arguments.h"
#include "app/output/checkpoint.h"
#include "app/output/folder_lock.h"
#include "app/output/sequence.h"
#include "app/output/temporary.h"
#include "app/record/earlier.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/machine.h"
#include "app/support/text.h"
#include "app/sweep/jobs/child.h"
#include "app/sweep/jobs/outcome.h"
#include "app/sweep/jobs/start_order.h"
#include "app/sweep/store/results.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::jobs {

namespace fs = std::filesystem;

namespace {

constexpr auto poll_interval = std::chrono::milliseconds(5);
constexpr auto wait_interval = std::chrono::milliseconds(100);

class LocalJobs {
 public:
  LocalJobs(const fs::path& folder, const store::Manifest& manifest, const LocalOptions& options,
            Progress& progress)
      : folder_(folder), manifest_(manifest), options_(options), progress_(progress) {}

  JobsResult run(const std::vector<int>& indices) {
    const auto start = start_ = Child::Clock::now();
    put_in_order(indices);
    counts_.all = static_cast<int>(queue_.size());
    skip_finished();
    put_failed_by_machine_last();
    for (const Run* run : queue_) work_left_ += run->work;
    make_beginnings();
    clock_.note(0);
    while (!active_.empty() || !queue_.empty()) {
      if (is_interrupted()) stop();
      keep_budget();
      try {
        start_what_fits();
        collect_ended();
      } catch (const IoError& error) {
        give_up({error.code, error.what()});
      }
      show();
      if (!active_.empty()) std::this_thread::sleep_for(poll_interval);
    }
    progress_.clear();
    result_.is_interrupted |=
        is_interrupted() || result_.failure.has_value() || result_.out_of_time > 0;
    result_.seconds = std::chrono::duration<double>(Child::Clock::now() - start).count();
    return result_;
  }

 private:
  struct Active {
    const Run* run;
    fs::path folder;
    output::FolderLock lock;
    store::RunStatus status;
    Child child;
    int threads;
    int made = 0;  ///< pictures, as far as they have been counted
  };

  /// Orders the queue. If the budget is too short for all, the ends of axes come first: long runs
  /// would take the room of many.
  void put_in_order(const std::vector<int>& indices) {
    const bool is_side_by_side = options_.cores > 1 && options_.jobs != 1;
    for (const bool is_longest_first : {is_side_by_side, false}) {
      const std::vector<const Run*> order = start_order(manifest_, indices, is_longest_first);
      queue_.assign(order.begin(), order.end());
      if (options_.budget <= 0 || foreseen_seconds() <= options_.budget) return;
    }
  }

  /// Returns the time of all runs that wait, on all cores; 0 if not known.
  double foreseen_seconds() const {
    double work = 0;
    for (const Run* run : queue_)
      if (!store::is_finished(store::read_status(folder_of(*run)).state)) work += run->work;
    return work * manifest_.seconds_per_work / options_.cores;
  }

  /// Makes the beginnings of the seeds that wait, once for all runs of a seed: by this process, or
  /// by another one that is waited for.
  void make_beginnings() {
    if (!manifest_.beginning) return;
    for (const Run& run : manifest_.beginning->runs)
      output::remove_abandoned_below(beginning_of(run));
    std::set<const Run*> needed;
    for (const Run* run : queue_) needed.insert(&manifest_.beginning->run_of(*run));
    std::deque<const Run*> waiting;
    for (const Run& run : manifest_.beginning->runs)
      if ((is_asked_for(run) || needed.contains(&run)) && !has_beginning(run, beginning_of(run)))
        waiting.push_back(&run);
    if (waiting.empty()) return;
    if (!manifest_.beginning->source.empty()) fail_without_source();
    run_beginnings(waiting);
    for (const Run* run : failed_beginnings_) fail_runs_of(*run);
    if (is_interrupted()) queue_.clear();
  }

  bool is_asked_for(const Run& beginning) const {
    return std::ranges::find(options_.beginnings, beginning.index) != options_.beginnings.end();
  }

  fs::path beginning_of(const Run& run) const { return store::beginning_folder(folder_, run); }

  /// The state was taken from a run; that run may be deleted by now.
  [[noreturn]] void fail_without_source() const {
    const fs::path folder = beginning_of(manifest_.beginning->runs.front());
    throw IoError(folder.string() +
                      ": the state at the fork is missing; repeat the same neve sweep --from, "
                      "which takes it from " +
                      manifest_.beginning->source,
                  folder.string());
  }

  /// Runs beginnings side by side, as runs are.
  void run_beginnings(std::deque<const Run*> waiting) {
    bool is_told = false;
    while (!waiting.empty() || !active_.empty()) {
      const bool is_late = options_.budget > 0 && seconds_left() <= 0;
      if (is_interrupted() || is_late)
        for (Active& active : active_) active.child.stop();
      if (is_interrupted() || is_late || result_.failure) {
        if (!waiting.empty()) leave_for_later();
        waiting.clear();
      }
      const Run* held = nullptr;  // by another process
      if (!waiting.empty() && has_room(*waiting.front())) {
        const Run* run = waiting.front();
        waiting.pop_front();
        if (!start_beginning(*run, static_cast<int>(waiting.size()) + 1))
          waiting.push_back(held = run);
      }
      collect_beginnings();
      if (!active_.empty()) {
        std::this_thread::sleep_for(poll_interval);
      } else if (held) {
        if (!is_told)
          progress_.note("waiting for the common beginning: " +
                         output::FolderLock::holder_of(beginning_of(*held), store::run_lock));
        is_told = true;
        std::this_thread::sleep_for(wait_interval);
      }
    }
  }

  /// False of a beginning that was tried again since all runs that wait failed with it, or that
  /// failed before any of them: on Slurm each is a process that was asked to repeat what failed.
  bool is_retried(const Run& beginning, const store::RunStatus& status) const {
    if (is_asked_for(beginning)) return true;
    return std::ranges::any_of(queue_, [&](const Run* run) {
      if (&manifest_.beginning->run_of(*run) != &beginning) return false;
      const int known = store::read_status(folder_of(*run)).failed_beginning;
      return known == 0 ? !options_.is_one_of_many : known >= status.attempts;
    });
  }

  /// @return false while another process makes it
  bool start_beginning(const Run& run, int left) {
    const fs::path folder = beginning_of(run);
    if (has_beginning(run, folder)) return true;
    std::optional<output::FolderLock> lock = output::FolderLock::try_lock(
        folder, "neve sweep", output::FolderLock::Kind::alone, store::run_lock);
    if (!lock) return false;
    store::RunStatus status = store::read_status(folder);
    // Another process may just have finished it.
    if (has_beginning(run, folder)) return true;
    const bool is_known =
        store::has_failed(status.state) && status.key == run.key &&
        !(options_.retry_failed.contains(status.state) && is_retried(run, status));
    if (is_known) {
      failed_beginnings_.push_back(&run);
      return true;
    }
    const char* whose = manifest_.beginning->runs.size() > 1 ? "" : " of all runs";
    progress_.note(fmt::format("{}{}, to frame {}", run.label, whose, run.frames.last));
    const RunsLeft all{left + static_cast<int>(active_.size()), 0};
    const int threads =
        std::max(1, std::min(threads_for(run, all, options_.cores, free_memory()), free_cores()));
    Child child = start_child(run, folder, threads, status);
    active_.push_back(
        {&run, folder, std::move(*lock), std::move(status), std::move(child), threads});
    return true;
  }

  void collect_beginnings() {
    while (std::optional<Ended> ended = take_ended()) {
      Active& done = ended->run;
      judge(ended->result, manifest_, *done.run, done.folder, done.status);
      store::write_status(done.folder, done.status);
      if (is_machine_failure(done.status))
        give_up({done.status.exit_code, done.run->label + ": " + done.status.reason});
      else if (store::has_failed(done.status.state))
        failed_beginnings_.push_back(done.run);
      else if (done.status.state == store::RunState::interrupted)
        leave_for_later();
    }
  }

  /// A beginning was ended before its last frame: no run of its seed can start, and the others wait
  /// with them.
  void leave_for_later() {
    result_.is_interrupted = true;
    if (!is_interrupted()) result_.out_of_time += static_cast<int>(queue_.size());
    queue_.clear();
  }

  /// Runs that fork from a beginning that failed fail as it did; those of other seeds are made.
  void fail_runs_of(const Run& beginning) {
    const store::RunStatus ended = store::read_status(beginning_of(beginning));
    const std::string state = store::name(ended.state);
    const bool says_it = ended.reason.starts_with(state + ":");
    const std::string why =
        beginning.label + " ended as " +
        (says_it ? ended.reason : state + (ended.reason.empty() ? "" : ": " + ended.reason));
    int failed = 0;
    std::erase_if(queue_, [&](const Run* run) {
      if (&manifest_.beginning->run_of(*run) != &beginning) return false;
      failed += fail_before_fork(*run, ended, why);
      return true;
    });
    ++result_.failed_beginnings;
    progress_.warning(fmt::format(
        "{}; {}correct the scene, or fork earlier; --retry-failed tries it again", why,
        failed > 0 ? fmt::format("{} that {} from it {} with it; ", count_text(failed, "run"),
                                 failed == 1 ? "forks" : "fork", failed == 1 ? "fails" : "fail")
                   : ""));
  }

  /// @return false where another process has the run
  bool fail_before_fork(const Run& run, const store::RunStatus& ended, const std::string& why) {
    const fs::path folder = folder_of(run);
    const std::optional<output::FolderLock> lock = lock_run(run, folder);
    if (!lock) return false;
    store::RunStatus status = store::read_status(folder);
    start_over(folder, status);
    status.state = ended.state;
    status.failed_beginning = std::max(1, ended.attempts);
    status.exit_code = ended.exit_code;
    status.signal = ended.signal;
    status.reason = why;
    status.short_reason =
        "before the fork" + (ended.short_reason.empty() ? "" : ", " + ended.short_reason);
    store::write_status(folder, status);
    count(status);
    work_left_ -= run.work;
    return true;
  }

  fs::path folder_of(const Run& run) const { return store::runs_folder(folder_) / run.folder; }

  void count(const store::RunStatus& status) {
    ++counts_.finished;
    if (status.state == store::RunState::ok) ++result_.ok;
    if (!store::has_failed(status.state)) return;
    ++result_.failed;
    ++counts_.failed;
  }

  void skip_finished() {
    std::erase_if(queue_, [&](const Run* run) {
      const store::RunStatus status = store::read_status(folder_of(*run));
      if (const auto why = store::why_to_make(folder_, *run, status, options_.retry_failed)) {
        if (!why->empty())
          progress_.warning(fmt::format("{}: {}; it is made again", store::run_text(*run), *why));
        return false;
      }
      count(status);
      return true;
    });
  }

  /// One that fails for ever must not keep others from being made.
  void put_failed_by_machine_last() {
    std::stable_partition(queue_.begin(), queue_.end(), [&](const Run* run) {
      return !is_machine_failure(store::read_status(folder_of(*run)));
    });
  }

  /// Runs in progress may end.
  void give_up(const MachineFailure& failure) {
    if (!result_.failure) result_.failure = failure;
    queue_.clear();
  }

  double seconds_left() const {
    return options_.budget - std::chrono::duration<double>(Child::Clock::now() - start_).count();
  }

  /// Compares a run with those that ended, before the first one with the forecast.
  bool fits_in_budget(const Run& run) const {
    if (options_.budget <= 0) return true;
    const double seconds_per_work =
        work_timed_ > 0 ? seconds_timed_ / work_timed_ : manifest_.seconds_per_work;
    return run.work * seconds_per_work <= seconds_left();
  }

  /// Lets runs that would not end in time make room for shorter ones. If none would, they begin all
  /// the same: their checkpoints are the next call's beginning.
  void keep_budget() {
    if (options_.budget <= 0) return;
    const bool is_hopeless =
        result_.started == 0 && std::none_of(queue_.begin(), queue_.end(),
                                             [&](const Run* run) { return fits_in_budget(*run); });
    if (is_hopeless && seconds_left() > 0) return;
    result_.out_of_time += static_cast<int>(
        std::erase_if(queue_, [&](const Run* run) { return !fits_in_budget(*run); }));
    if (seconds_left() > 0) return;
    result_.out_of_time += static_cast<int>(queue_.size());
    if (!is_over_) result_.out_of_time += static_cast<int>(active_.size());
    is_over_ = true;
    stop();
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

  /// Available memory that is not promised to a run that has just begun to take it.
  double free_memory() const {
    double memory = static_cast<double>(available_memory());
    for (const Active& active : active_)
      if (active.child.seconds() < 5) memory -= active.run->memory;
    return memory;
  }

  bool has_room(const Run& run) const {
    return options_.jobs > 0 ? static_cast<int>(active_.size()) < options_.jobs
                             : free_cores() > 0 && (active_.empty() || run.memory <= free_memory());
  }

  void start_what_fits() {
    while (!queue_.empty()) {
      const RunsLeft left{static_cast<int>(queue_.size() + active_.size()), work_left_};
      if (!has_room(*queue_.front())) return;
      const Run* run = queue_.front();
      queue_.pop_front();
      const int threads =
          options_.jobs > 0
              ? std::max(1, options_.cores / options_.jobs)
              : std::min(free_cores(), threads_for(*run, left, options_.cores, free_memory()));
      start(*run, std::max(1, threads));
    }
  }

  /// Returns nothing while another process makes the run: it is left to that.
  std::optional<output::FolderLock> lock_run(const Run& run, const fs::path& folder) {
    std::optional<output::FolderLock> lock = output::FolderLock::try_lock(
        folder, "neve sweep", output::FolderLock::Kind::alone, store::run_lock);
    if (lock) return lock;
    ++result_.elsewhere;
    result_.elsewhere_text = fmt::format("{} is in progress: {}", store::run_text(run),
                                         output::FolderLock::holder_of(folder, store::run_lock));
    progress_.warning(result_.elsewhere_text);
    --counts_.all;
    work_left_ -= run.work;
    return lock;
  }

  void start(const Run& run, int threads) {
    const fs::path folder = folder_of(run);
    std::optional<output::FolderLock> lock = lock_run(run, folder);
    if (!lock) return;
    store::RunStatus status = store::read_status(folder);
    // Another process may have made it while it waited here.
    if (!store::why_to_make(folder_, run, status, options_.retry_failed)) {
      count(status);
      work_left_ -= run.work;
      return;
    }
    if (is_over_memory(run, status, folder)) return;
    Child child = start_child(run, folder, threads, status);
    ++result_.started;
    progress_.detail(fmt::format("{} starts on {} {}", store::run_text(run), threads,
                                 threads == 1 ? "thread" : "threads"));
    active_.push_back(
        {&run, folder, std::move(*lock), std::move(status), std::move(child), threads});
  }

  /// The process of a run is killed with its sweep, a moment later.
  static void wait_for_orphan(const fs::path& folder) {
    constexpr auto longest = std::chrono::seconds(5);
    const auto start = Child::Clock::now();
    while (output::FolderLock::is_held(folder) && Child::Clock::now() - start < longest)
      std::this_thread::sleep_for(poll_interval);
  }

  /// A signal, a limit or a machine that goes leaves the last checkpoint whole.
  static bool leaves_a_checkpoint(const store::RunStatus& status) {
    using enum store::RunState;
    if (status.state == running || status.state == interrupted) return true;
    return status.failed_beginning == 0 &&
           (status.state == timeout || status.state == crashed || status.state == out_of_memory);
  }

  /// A process that makes a run, or continues one. @param status  of the run, written
  Child start_child(const Run& run, const fs::path& folder, int threads,
                    store::RunStatus& status) const {
    const bool resumes = leaves_a_checkpoint(status);
    wait_for_orphan(folder);
    if (!resumes) start_over(folder, status);
    Child child({options_.program, arguments_of(run, folder, threads, resumes), folder},
                folder / "log",
                {manifest_.timeout, static_cast<std::uint64_t>(manifest_.memory), options_.grace});
    status.state = store::RunState::running;
    status.failed_beginning = 0;
    ++status.attempts;
    status.pid = child.pid();
    status.host = host_name();
    status.reason.clear();
    status.short_reason.clear();
    store::write_status(folder, status);
    return child;
  }

  /// True if a run needs more memory than allowed, as known before anything is started.
  bool is_over_memory(const Run& run, store::RunStatus& status, const fs::path& folder) {
    if (manifest_.memory <= 0 || run.memory <= manifest_.memory) return false;
    status.state = store::RunState::out_of_memory;
    const std::string needed = bytes_text(static_cast<std::uint64_t>(run.memory)),
                      allowed = bytes_text(static_cast<std::uint64_t>(manifest_.memory));
    status.short_reason = fmt::format("needs {}", needed);
    status.reason =
        fmt::format("about {} of memory are needed, [limits] memory allows {}", needed, allowed);
    finish(run, folder, status);
    return true;
  }

  /// Removes the files of an abandoned attempt, and with them what it cost. The status says first
  /// that there is no result: who collects in between would miss its files.
  static void start_over(const fs::path& folder, store::RunStatus& status) {
    status.state = store::RunState::pending;
    status.seconds = 0;
    status.peak_memory = 0;
    store::write_status(folder, status);
    record::remove_earlier_run(folder);
    output::remove_checkpoints(folder);
    std::error_code error;
    fs::remove(folder / "log", error);
    fs::remove(output::run_json_path(folder), error);
  }

  std::vector<std::string> arguments_of(const Run& run, const fs::path& folder, int threads,
                                        bool resumes) const {
    const bool is_branch =
        manifest_.beginning && std::ranges::none_of(manifest_.beginning->runs,
                                                    [&](const Run& own) { return &own == &run; });
    run::RenderOptions options;
    options.scene = "scene.toml";
    if (is_branch)
      options = manifest_.beginning->fork_of(run, "../..");
    else
      options.views = {manifest_.view};
    // Forks have it from the run that they leave.
    const double coarsening = manifest_.coarsening_of(run);
    if (!is_branch && coarsening > 1) options.coarsened = coarsening;
    options.out = ".";
    options.frames = run.frames;
    options.threads = threads;
    options.backend = options_.backend;
    options.has_movies = false;
    options.verbosity = Verbosity::quiet;
    options.resume = resumes;
    // A run that has states of itself continues to keep them.
    options.keeps_all_states = manifest_.keeps_states || !output::kept_states(folder).empty();
    options.keeps_states = options.keeps_all_states;
    options.replaces = true;
    if (manifest_.quality != setup::Quality::preview) options.quality = manifest_.quality;
    return options::words_of(options);
  }

  struct Ended {
    Active run;
    ChildResult result;
  };
  /// Takes one that has ended off the list, before its status is written: that may find no room on
  /// the disk.
  std::optional<Ended> take_ended() {
    for (auto active = active_.begin(); active != active_.end(); ++active) {
      const std::optional<ChildResult> result = active->child.poll();
      if (!result) continue;
      result_.cpu_seconds += result->cpu_seconds;
      result_.core_seconds += result->seconds * active->threads;
      Ended ended{std::move(*active), *result};
      active_.erase(active);
      return ended;
    }
    return std::nullopt;
  }

  void collect_ended() {
    while (std::optional<Ended> ended = take_ended()) {
      Active& done = ended->run;
      // The seconds are those at the threads that the run had.
      work_timed_ += done.run->work;
      seconds_timed_ += ended->result.seconds;
      judge(ended->result, manifest_, *done.run, done.folder, done.status);
      finish(*done.run, done.folder, done.status);
      if (done.status.state == store::RunState::ok) output::remove_checkpoints(done.folder);
    }
  }

  void finish(const Run& run, const fs::path& folder, store::RunStatus& status) {
    store::note_record(record::read_run_json(folder), status);
    store::write_status(folder, status);
    if (store::is_finished(status.state)) count(status);
    // Another process may have interrupted it too: then the sweep is not done either.
    if (status.state == store::RunState::interrupted) result_.is_interrupted = true;
    if (is_machine_failure(status))
      give_up({status.exit_code, store::run_text(run) + ": " + status.reason});
    work_done_ += run.work;
    work_left_ -= run.work;
    clock_.note(work_done_);
    const std::string what = store::run_text(run) + (run.label.empty() ? "" : ", " + run.label);
    if (store::has_failed(status.state))
      progress_.note(what + ": " + tile_text(status) +
                     (status.reason.empty() ? "" : "\n  " + status.reason));
    else
      progress_.detail(fmt::format("{}: {} after {} s", what, store::name(status.state),
                                   fixed_text(status.seconds, 1)));
  }

  void show() {
    counts_.running = static_cast<int>(active_.size());
    const auto now = Child::Clock::now();
    if (now - shown_at_ < std::chrono::milliseconds(500)) return;
    shown_at_ = now;
    // Existing frames count as work done, so that few long runs have an estimate too.
    double begun = 0;
    for (Active& active : active_) {
      const setup::FrameRange& frames = active.run->frames;
      active.made = store::frames_made(active.folder, manifest_.view, frames, active.made);
      begun += active.run->work * active.made / frames.count();
    }
    clock_.note(work_done_ + begun);
    counts_.seconds_left = clock_.seconds_for(std::max(0.0, work_left_ - begun));
    progress_.runs(counts_);
  }

  const fs::path& folder_;
  const store::Manifest& manifest_;
  const LocalOptions& options_;
  Progress& progress_;
  std::deque<const Run*> queue_;
  std::list<Active> active_;
  JobsResult result_;
  RunCounts counts_;
  WorkClock clock_;
  double work_done_ = 0, work_left_ = 0;
  double work_timed_ = 0, seconds_timed_ = 0;  ///< of runs that ended now
  bool is_over_ = false;                       ///< the budget's time
  std::vector<const Run*> failed_beginnings_;
  Child::Clock::time_point start_;
  Child::Clock::time_point shown_at_;
};

}  // namespace

bool has_beginning(const Run& run, const fs::path& folder) {
  const store::RunStatus status = store::read_status(folder);
  return status.state == store::RunState::ok && status.key == run.key &&
         record::is_untouched(record::read_run_json(folder)) &&
         output::find_checkpoint(folder).checkpoint.has_value();
}

int threads_for(const Run& run, const RunsLeft& left, int cores, double memory) {
  // Fewer particles than these are not worth a thread's share of a step.
  constexpr double least = 4000;
  const double fitting = run.memory > 0 ? std::max(1.0, std::floor(memory / run.memory)) : cores;
  const double together =
      std::min({static_cast<double>(cores), static_cast<double>(left.runs), fitting});
  const auto by_count = static_cast<int>(cores / std::max(1.0, together));
  // One that is longer than what all others leave to a core would be waited for.
  const auto by_length =
      left.work > 0 ? static_cast<int>(std::lround(cores * std::min(1.0, run.work / left.work)))
                    : 1;
  const int threads = std::max(by_count, by_length);
  const auto useful = static_cast<int>(std::clamp(run.particles / least, 1.0, 1024.0));
  return std::clamp(threads, 1, useful);
}

JobsResult run_local(const fs::path& folder, const store::Manifest& manifest,
                     const std::vector<int>& indices, const LocalOptions& options,
                     Progress& progress) {
  return LocalJobs(folder, manifest, options, progress).run(indices);
}

}  // namespace neve::app::sweep::jobs
