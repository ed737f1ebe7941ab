#include "app/sweep/jobs/slurm.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>

#include "app/options/arguments.h"
#include "app/output/atomic_file.h"
#include "app/output/folder_lock.h"
#include "app/output/process.h"
#include "app/output/temporary.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "app/sweep/jobs/slurm_jobs.h"
#include "app/sweep/plan/selection.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/sweep/store/results.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::jobs {

namespace fs = std::filesystem;

namespace {

constexpr auto check_interval = std::chrono::seconds(1);
constexpr auto patience = std::chrono::minutes(10);
constexpr int default_max_array_size = 1001;

/// Calls a program of Slurm. @throws Error when it fails
std::string call(const std::string& name, const std::vector<std::string>& arguments) {
  const auto program = output::find_program(name);
  if (!program)
    throw Error(exit_io, name + " is not installed here, so Slurm cannot be used", name,
                "run on a machine that can submit jobs, or without --engine slurm; --shard and "
                "--emit work with any scheduler");
  const output::ProcessResult result = output::run_process(*program, arguments, fs::current_path());
  if (!result.has_started || result.exit_code != 0)
    throw Error(exit_io, name + " failed: " + trimmed(result.errors + result.output, " \t\r\n"),
                name, "sinfo shows the state of Slurm");
  return trimmed(result.output, " \t\r\n");
}

int max_array_size() {
  std::istringstream lines(call("scontrol", {"show", "config"}));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("MaxArraySize")) continue;
    const auto digits = line.find_first_of("0123456789");
    int size = 0;
    if (digits != std::string::npos)
      std::from_chars(line.data() + digits, line.data() + line.size(), size);
    if (size > 0) return size;
  }
  return default_max_array_size;
}

std::vector<std::string> sbatch_options(const store::Manifest& manifest,
                                        const SlurmOptions& options) {
  std::vector<std::string> words{"--parsable", "--requeue", "--open-mode=append",
                                 "--cpus-per-task=" + std::to_string(options.threads),
                                 "--job-name=" + manifest.name};
  // Time to end and to write a checkpoint comes on top.
  if (manifest.timeout > 0) {
    const auto minutes = static_cast<long>(std::ceil(manifest.timeout / 60)) + 2;
    words.push_back("--time=" + std::to_string(minutes));
  }
  words.push_back("--signal=B:TERM@60");
  if (manifest.memory > 0)
    words.push_back("--mem=" + std::to_string(static_cast<long>(manifest.memory / 1048576) + 128) +
                    "M");
  words.insert(words.end(), options.options.begin(), options.options.end());
  return words;
}

/// Makes one of all options that say what a job waits for: sbatch heeds the last of them alone.
void join_dependencies(std::vector<std::string>& words) {
  const std::string name = "--dependency=";
  std::vector<std::string> others, all;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const bool is_alone = words[k] == "--dependency" || words[k] == "-d";
    if (is_alone && k + 1 < words.size())
      all.push_back(words[++k]);
    else if (words[k].starts_with(name))
      all.push_back(words[k].substr(name.size()));
    else
      others.push_back(words[k]);
  }
  if (!all.empty()) others.push_back(name + joined(all, ","));
  words = std::move(others);
}

/// Scripts are the sweep's own commands, so that signals reach them and their exit codes are
/// Slurm's.
void write_scripts(const fs::path& folder, const SlurmOptions& options,
                   const std::string& retry_failed) {
  const auto write = [&](const char* name, const std::vector<std::string>& words,
                         const std::string& more = "") {
    output::write_file(
        folder / "slurm" / name,
        "#!/bin/bash\nexec " + options::shell_line(words, options.program) + more + "\n");
  };
  plan::SweepRunOptions run;
  run.folder = fs::absolute(folder).string();
  run.threads = options.threads;
  run.backend = options.backend;
  run.verbosity = Verbosity::quiet;
  run.retry_failed = retry_failed;
  write("run.sh", options::words_of(run), " --index $((SLURM_ARRAY_TASK_ID + $1))");
  write("beginning.sh", options::words_of(run),
        " --beginning=$((SLURM_ARRAY_TASK_ID + $1 + 1))");  // they count from 1
  plan::CollectOptions collect;
  collect.folder = run.folder;
  collect.backend = options.backend;
  collect.movie = options.movie;
  collect.has_review = options.has_review;
  collect.verbosity = Verbosity::quiet;
  write("collect.sh", options::words_of(collect));
}

/// The jobs that are still waiting or running.
std::vector<QueuedJob> living(const std::vector<QueuedJob>& jobs) {
  if (jobs.empty()) return {};
  std::set<std::string> seen;
  // Lists all jobs of this user, because asking for a job that Slurm has forgotten is an error.
  std::istringstream words(call("squeue", {"--me", "--noheader", "--format=%A %F"}));
  for (std::string word; words >> word;) seen.insert(word);
  std::vector<QueuedJob> alive;
  for (const QueuedJob& job : jobs)
    if (seen.contains(job.number)) alive.push_back(job);
  return alive;
}

std::vector<std::string> numbers_of(const std::vector<QueuedJob>& jobs) {
  std::vector<std::string> numbers;
  for (const QueuedJob& job : jobs) numbers.push_back(job.number);
  return numbers;
}

/// Jobs of one call of neve: each is on disk before the next is asked for.
class Queue {
 public:
  Queue(const fs::path& folder, const store::Manifest& manifest, const SlurmOptions& options,
        std::vector<QueuedJob> jobs)
      : folder_(folder), manifest_(manifest), options_(options), jobs_(std::move(jobs)) {}

  const std::vector<QueuedJob>& jobs() const { return jobs_; }
  /// A queue that does not answer is asked again. @throws Error when it has not for long
  void forget_ended(Progress& progress);

  /// Arrays of runs, and a job that collects when all have ended. @throws Error at the first that
  /// Slurm refuses
  void submit(const std::vector<int>& runs);
  /// Returns those of these runs that no job is queued for.
  std::vector<int> without_job(const std::vector<int>& runs) const;

 private:
  /// Arrays of the common beginnings that these runs lack; submits those that are not queued.
  /// @return the numbers of their jobs
  std::vector<std::string> beginning_jobs(const std::vector<int>& runs);
  /// Returns those of these indices that no job is queued for.
  std::vector<int> not_queued(const std::vector<int>& indices, bool are_beginnings) const;
  /// An array of tasks of a script. @param after  jobs that it waits for
  void add_arrays(const char* script, const char* log_name, const std::vector<int>& indices,
                  const std::string& after, bool are_beginnings);
  void add(const std::vector<std::string>& words, const std::vector<int>& runs,
           bool is_beginning = false, int offset = 0) {
    jobs_.push_back({job_number(call("sbatch", words)), runs, is_beginning, offset});
    write_queued_jobs(folder_, jobs_);
  }
  std::string log(const char* name) const {
    return "--output=" + (fs::absolute(folder_) / "slurm" / name).string();
  }

  const fs::path& folder_;
  const store::Manifest& manifest_;
  const SlurmOptions& options_;
  std::vector<QueuedJob> jobs_;
  std::optional<std::chrono::steady_clock::time_point> silent_since_;
};

void Queue::forget_ended(Progress& progress) {
  try {
    jobs_ = living(jobs_);
    silent_since_.reset();
  } catch (const Error& error) {
    const auto now = std::chrono::steady_clock::now();
    if (!silent_since_)
      progress.warning(std::string(error.what()) +
                       "; the jobs continue, and Slurm is asked again for 10 minutes");
    silent_since_ = silent_since_.value_or(now);
    if (now - *silent_since_ > patience) throw;
  }
}

std::vector<int> Queue::not_queued(const std::vector<int>& indices, bool are_beginnings) const {
  std::set<int> queued;
  for (const QueuedJob& job : jobs_)
    if (job.is_beginning == are_beginnings) queued.insert(job.runs.begin(), job.runs.end());
  std::vector<int> without;
  std::ranges::copy_if(indices, std::back_inserter(without),
                       [&](int index) { return !queued.contains(index); });
  return without;
}

std::vector<int> Queue::without_job(const std::vector<int>& runs) const {
  return not_queued(runs, false);
}

void Queue::add_arrays(const char* script, const char* log_name, const std::vector<int>& indices,
                       const std::string& after, bool are_beginnings) {
  for (const SlurmArray& array : split_arrays(indices, max_array_size())) {
    std::vector<std::string> words = sbatch_options(manifest_, options_);
    words.push_back("--array=" + array.tasks +
                    (options_.jobs > 0 ? "%" + std::to_string(options_.jobs) : ""));
    words.push_back(log(log_name));
    if (!after.empty()) words.push_back(after);
    join_dependencies(words);
    words.push_back((folder_ / "slurm" / script).string());
    words.push_back(std::to_string(array.offset));
    add(words, array.runs, are_beginnings, array.offset);
  }
}

std::vector<std::string> Queue::beginning_jobs(const std::vector<int>& runs) {
  if (!manifest_.beginning) return {};
  std::set<int> lacking;
  for (const int run : runs) {
    const Run& beginning = manifest_.beginning->run_of(*manifest_.run_of(run));
    if (!has_beginning(beginning, store::beginning_folder(folder_, beginning)))
      lacking.insert(beginning.index);
  }
  add_arrays("beginning.sh", "beginning_%A_%a.log",
             not_queued({lacking.begin(), lacking.end()}, true), "", true);
  std::vector<std::string> numbers;
  for (const QueuedJob& job : jobs_)
    if (std::ranges::any_of(job.runs,
                            [&](int index) { return job.is_beginning && lacking.contains(index); }))
      numbers.push_back(job.number);
  return numbers;
}

void Queue::submit(const std::vector<int>& runs) {
  // The dependency is not afterok: runs whose beginning failed say so, instead of waiting for ever.
  const std::vector<std::string> beginnings = beginning_jobs(runs);
  add_arrays("run.sh", "%A_%a.log", runs,
             beginnings.empty() ? "" : "--dependency=afterany:" + joined(beginnings, ":"), false);
  // afterany: a failed run is no reason to have no sheet.
  std::string all = "--dependency=afterany";
  for (const QueuedJob& job : jobs_) all += ":" + job.number;
  std::vector<std::string> collector{"--parsable", "--job-name=" + manifest_.name + "-collect",
                                     log("collect.log"), all};
  collector.insert(collector.end(), options_.options.begin(), options_.options.end());
  join_dependencies(collector);
  collector.push_back((folder_ / "slurm" / "collect.sh").string());
  add(collector, {});
}

RunCounts count(const fs::path& folder, const store::Manifest& manifest,
                const std::vector<int>& indices) {
  RunCounts counts;
  counts.all = static_cast<int>(indices.size());
  for (const int index : indices) {
    const Run& run = *manifest.run_of(index);
    const store::RunState state = store::read_status(store::runs_folder(folder) / run.folder).state;
    counts.finished += store::is_finished(state);
    counts.failed += store::has_failed(state);
    counts.running += state == store::RunState::running;
  }
  return counts;
}

}  // namespace

std::vector<SlurmArray> split_arrays(const std::vector<int>& indices, int max_array_size) {
  std::map<int, std::vector<int>> blocks;
  for (const int index : indices) blocks[index / max_array_size].push_back(index);
  std::vector<SlurmArray> arrays;
  for (const auto& [block, runs] : blocks) {
    std::vector<int> tasks;
    for (const int run : runs) tasks.push_back(run % max_array_size);
    arrays.push_back({block * max_array_size, plan::selection_text(tasks), runs});
  }
  return arrays;
}

namespace {

/// Runs that have to be made, of equal ones the first.
std::vector<int> missing_runs(const fs::path& folder, const store::Manifest& manifest,
                              const std::vector<int>& indices, const store::Retry& retry) {
  std::vector<int> missing;
  std::set<std::string> keys;
  for (const int index : indices) {
    const Run& run = *manifest.run_of(index);
    const store::RunStatus status = store::read_status(store::runs_folder(folder) / run.folder);
    if (store::why_to_make(folder, run, status, retry) && keys.insert(run.key).second)
      missing.push_back(index);
  }
  return missing;
}

/// Queues runs that have no job. A site that takes only some of them gets the rest when one
/// of these has ended. @return how many were queued
/// @throws Error where it takes none and none is queued
std::size_t queue_rest(Queue& queue, const std::vector<int>& missing, Progress& progress) {
  const std::vector<int> rest = queue.without_job(missing);
  if (rest.empty()) return 0;
  const std::size_t before = queue.jobs().size();
  const auto names = [&] { return joined(numbers_of(queue.jobs()), ", "); };
  try {
    queue.submit(rest);
  } catch (const Error& error) {
    if (queue.jobs().empty()) throw;
    const std::vector<int> left = queue.without_job(rest);
    if (queue.jobs().size() > before || before == 0 || left.empty())
      progress.warning(fmt::format(
          "{}; queued: {} as job {}{}", error.what(), count_text(rest.size() - left.size(), "run"),
          names(),
          left.empty() ? "; neve sweep collect makes the sheet if nobody waits here"
                       : fmt::format("; {} more follow when a job has ended", left.size())));
    return rest.size() - left.size();
  }
  progress.note(fmt::format("submitted {} as job {}", count_text(rest.size(), "run"), names()));
  return rest.size();
}

/// Tasks that runs were given, by run: "4711_3".
using Tasks = std::map<int, std::string>;

/// Takes a run that its job left in progress for crashed, unless another process has it.
/// @return whether none has it
bool end_with_job(const fs::path& run_folder, const std::string& task) {
  const std::optional<output::FolderLock> lock = output::FolderLock::try_lock(
      run_folder, "neve sweep", output::FolderLock::Kind::alone, store::run_lock);
  if (!lock) return false;
  store::RunStatus status = store::read_status(run_folder);
  if (status.state != store::RunState::running) return true;
  status.state = store::RunState::crashed;
  status.short_reason = "its job ended";
  status.reason = "its job ended; see slurm/" + task + ".log";
  status.pid = 0;
  store::write_status(run_folder, status);
  return true;
}

/// Jobs that ended before their runs did: the first of them and how to find out why.
std::string ended_text(const fs::path& folder, const std::vector<int>& runs, const Tasks& tasks,
                       bool have_begun, const char* next) {
  const bool is_one = runs.size() == 1;
  const auto task = tasks.find(runs.front());
  const std::string of_first = task == tasks.end() ? "" : task->second;
  const fs::path log = folder / "slurm" / (of_first + ".log");
  const char* const end = have_begun ? (is_one ? "it was made" : "they were made")
                                     : (is_one ? "it began" : "they began");
  return fmt::format("{} {}: {} ended before {}; see {}, or sacct -j {}; {}",
                     is_one ? "run" : "runs", plan::selection_text(runs),
                     is_one ? "its job" : "their jobs", end, shell_path(log.string()), of_first,
                     next);
}

/// Attempts of the runs that are interrupted, by run.
std::map<int, int> attempts_of_interrupted(const fs::path& folder, const store::Manifest& manifest,
                                           const std::vector<int>& indices) {
  std::map<int, int> attempts;
  for (const int index : indices) {
    const store::RunStatus status =
        store::read_status(store::runs_folder(folder) / manifest.run_of(index)->folder);
    if (status.state == store::RunState::interrupted) attempts[index] = status.attempts;
  }
  return attempts;
}

/// A run that has not begun, because its common beginning was interrupted.
bool waits_for_beginning(const fs::path& folder, const store::Manifest& manifest, const Run& run,
                         store::RunState state) {
  if (state != store::RunState::pending || !manifest.beginning) return false;
  const fs::path beginning = store::beginning_folder(folder, manifest.beginning->run_of(run));
  return store::read_status(beginning).state == store::RunState::interrupted;
}

/// Judges runs whose jobs have ended. @param before  attempts of those that were interrupted
void judge_ended(const fs::path& folder, const store::Manifest& manifest,
                 const std::vector<int>& indices, const Tasks& tasks,
                 const std::map<int, int>& before, JobsResult& result, Progress& progress) {
  std::vector<int> died, unmade;
  for (const int index : indices) {
    const Run& run = *manifest.run_of(index);
    const fs::path run_folder = store::runs_folder(folder) / run.folder;
    const store::RunStatus status = store::read_status(run_folder);
    const store::RunState state = status.state;
    const auto earlier = before.find(index);
    const bool is_interrupted_now = state == store::RunState::interrupted &&
                                    (earlier == before.end() || earlier->second < status.attempts);
    if (is_interrupted_now || waits_for_beginning(folder, manifest, run, state))
      result.is_interrupted = true;
    else if (state == store::RunState::pending || state == store::RunState::interrupted)
      unmade.push_back(index);
    if (state != store::RunState::running) continue;
    const auto task = tasks.find(index);
    if (end_with_job(run_folder, task == tasks.end() ? "" : task->second)) {
      died.push_back(index);
    } else {
      ++result.elsewhere;
      result.elsewhere_text =
          fmt::format("{} is in progress: {}", store::run_text(run),
                      output::FolderLock::holder_of(run_folder, store::run_lock));
    }
  }
  if (!died.empty())
    progress.warning(ended_text(folder, died, tasks, true, "--retry-failed makes them again"));
  if (!unmade.empty())
    progress.warning(
        ended_text(folder, unmade, tasks, false, "the same command submits them again"));
  result.failed += static_cast<int>(unmade.size());
}

}  // namespace

JobsResult run_slurm(const fs::path& folder, const store::Manifest& manifest,
                     const std::vector<int>& indices, const SlurmOptions& options,
                     const std::string& retry_failed, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const store::Retry retry =
      retry_failed.empty() ? store::Retry{} : store::parse_retry(retry_failed);
  const std::vector<int> missing = missing_runs(folder, manifest, indices, retry);
  const std::map<int, int> before = attempts_of_interrupted(folder, manifest, missing);
  JobsResult result;
  Queue queue(folder, manifest, options, living(queued_jobs(folder)));
  if (!queue.jobs().empty()) progress.note("waiting for the jobs submitted before");
  if (!queue.without_job(missing).empty()) {
    output::make_folder(folder / "slurm");
    output::remove_abandoned(folder / "slurm");
    write_scripts(folder, options, retry_failed);
    result.started = static_cast<int>(queue_rest(queue, missing, progress));
  }
  Tasks tried;  // also of jobs that have ended
  const auto note_tried = [&] {
    for (const QueuedJob& job : queue.jobs())
      for (const int run : job.is_beginning ? std::vector<int>{} : job.runs)
        tried[run] = fmt::format("{}_{}", job.number, run - job.offset);
  };
  WorkClock clock;
  while (!queue.jobs().empty() && !is_interrupted()) {
    RunCounts counts = count(folder, manifest, indices);
    clock.note(counts.finished);
    counts.seconds_left = clock.seconds_for(counts.all - counts.finished);
    progress.runs(counts);
    std::this_thread::sleep_for(check_interval);
    note_tried();
    const std::size_t queued = queue.jobs().size();
    queue.forget_ended(progress);
    std::vector<int> rest;
    std::ranges::copy_if(missing, std::back_inserter(rest),
                         [&](int run) { return !tried.contains(run); });
    if (queue.jobs().size() < queued && !rest.empty())
      result.started += static_cast<int>(queue_rest(queue, rest, progress));
  }
  if (is_interrupted() && !queue.jobs().empty()) {
    call("scancel", numbers_of(queue.jobs()));
    result.is_interrupted = true;
  }
  progress.clear();
  if (!result.is_interrupted)
    judge_ended(folder, manifest, indices, tried, before, result, progress);
  const RunCounts counts = count(folder, manifest, indices);
  result.ok = counts.finished - counts.failed;
  result.failed += counts.failed;
  const std::chrono::duration<double> span = std::chrono::steady_clock::now() - start;
  result.seconds = span.count();
  return result;
}

}  // namespace neve::app::sweep::jobs
