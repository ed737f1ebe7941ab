#include "app/sweep/jobs/slurm.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>

#include "app/options/arguments.h"
#include "app/output/atomic_file.h"
#include "app/output/process.h"
#include "app/output/temporary.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "app/sweep/plan/selection.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::jobs {

namespace fs = std::filesystem;

namespace {

constexpr auto check_interval = std::chrono::seconds(1);
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
  run.is_beginning = true;
  write("beginning.sh", options::words_of(run));
  plan::CollectOptions collect;
  collect.folder = run.folder;
  collect.backend = options.backend;
  collect.verbosity = Verbosity::quiet;
  write("collect.sh", options::words_of(collect));
}

std::string job_id(const std::string& answer) {
  const std::string id = answer.substr(0, answer.find_first_of(";\n"));
  if (id.empty() || id.find_first_not_of("0123456789") != std::string::npos)
    throw Error(exit_io,
                fmt::format("sbatch answered \"{}\"; expected the number of a job", answer),
                "sbatch");
  return id;
}

fs::path jobs_path(const fs::path& folder) {
  return folder / "slurm" / "jobs.json";
}

std::vector<std::string> known_jobs(const fs::path& folder) {
  try {
    return parse_json(output::read_file(jobs_path(folder))).get<std::vector<std::string>>();
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    return {};
  }
}

/// The jobs that are still waiting or running.
std::vector<std::string> living(const std::vector<std::string>& jobs) {
  std::set<std::string> seen;
  // Lists all jobs of this user, because asking for a job that Slurm has forgotten is an error.
  std::istringstream lines(call("squeue", {"--me", "--noheader", "--format=%A %F"}));
  for (std::string id; lines >> id;) seen.insert(id);
  std::vector<std::string> alive;
  for (const std::string& job : jobs)
    if (seen.contains(job)) alive.push_back(job);
  return alive;
}

std::vector<std::string> submit(const fs::path& folder, const store::Manifest& manifest,
                                const std::vector<int>& indices, const SlurmOptions& options,
                                const std::string& retry_failed) {
  output::make_folder(folder / "slurm");
  output::remove_abandoned(folder / "slurm");
  write_scripts(folder, options, retry_failed);
  const std::string log = (fs::absolute(folder) / "slurm" / "%A_%a.log").string();
  std::vector<std::string> jobs;
  std::string after = "--dependency=afterany";
  std::string beginning;
  if (manifest.beginning) {
    std::vector<std::string> words = sbatch_options(manifest, options);
    words.push_back("--output=" + (fs::absolute(folder) / "slurm" / "beginning.log").string());
    words.push_back((folder / "slurm" / "beginning.sh").string());
    jobs.push_back(job_id(call("sbatch", words)));
    // Not afterok: runs whose beginning failed say so, instead of waiting for ever.
    beginning = after + ":" + jobs.back();
  }
  for (const SlurmArray& array : split_arrays(indices, max_array_size())) {
    std::vector<std::string> words = sbatch_options(manifest, options);
    words.push_back("--array=" + array.tasks +
                    (options.jobs > 0 ? "%" + std::to_string(options.jobs) : ""));
    words.push_back("--output=" + log);
    if (!beginning.empty()) words.push_back(beginning);
    words.push_back((folder / "slurm" / "run.sh").string());
    words.push_back(std::to_string(array.offset));
    jobs.push_back(job_id(call("sbatch", words)));
    after += ":" + jobs.back();
  }
  // afterany: a failed run is no reason to have no sheet.
  std::vector<std::string> collector{
      "--parsable", "--job-name=" + manifest.name + "-collect",
      "--output=" + (fs::absolute(folder) / "slurm" / "collect.log").string(), after};
  collector.insert(collector.end(), options.options.begin(), options.options.end());
  collector.push_back((folder / "slurm" / "collect.sh").string());
  jobs.push_back(job_id(call("sbatch", collector)));
  output::write_file(jobs_path(folder), to_text(Json(jobs)) + "\n");
  return jobs;
}

RunCounts count(const fs::path& folder, const store::Manifest& manifest,
                const std::vector<int>& indices) {
  RunCounts counts;
  counts.all = static_cast<int>(indices.size());
  for (const int index : indices) {
    const Run& run = manifest.runs[static_cast<std::size_t>(index)];
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
  for (const int index : indices) blocks[index / max_array_size].push_back(index % max_array_size);
  std::vector<SlurmArray> arrays;
  for (const auto& [block, tasks] : blocks)
    arrays.push_back({block * max_array_size, plan::selection_text(tasks)});
  return arrays;
}

JobsResult run_slurm(const fs::path& folder, const store::Manifest& manifest,
                     const std::vector<int>& indices, const SlurmOptions& options,
                     const std::string& retry_failed, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const store::Retry retry =
      retry_failed.empty() ? store::Retry{} : store::parse_retry(retry_failed);
  std::vector<int> missing;
  std::set<std::string> keys;
  for (const int index : indices) {
    const Run& run = manifest.runs[static_cast<std::size_t>(index)];
    const store::RunState state = store::read_status(store::runs_folder(folder) / run.folder).state;
    const bool is_wanted = !store::is_finished(state) || retry.contains(state);
    if (is_wanted && keys.insert(run.key).second) missing.push_back(index);
  }
  JobsResult result;
  std::vector<std::string> jobs = living(known_jobs(folder));
  if (!jobs.empty()) {
    progress.note("waiting for the jobs submitted before");
  } else if (!missing.empty()) {
    jobs = submit(folder, manifest, missing, options, retry_failed);
    result.started = static_cast<int>(missing.size());
    progress.note(fmt::format("submitted {} runs as job {}{}", missing.size(), jobs.front(),
                              jobs.size() > 2 ? " and others" : ""));
  }
  WorkClock clock;
  while (!jobs.empty() && !is_interrupted()) {
    RunCounts counts = count(folder, manifest, indices);
    clock.note(counts.finished);
    counts.seconds_left = clock.seconds_for(counts.all - counts.finished);
    progress.runs(counts);
    std::this_thread::sleep_for(check_interval);
    jobs = living(jobs);
  }
  if (is_interrupted() && !jobs.empty()) {
    call("scancel", jobs);
    result.is_interrupted = true;
  }
  progress.clear();
  const RunCounts counts = count(folder, manifest, indices);
  result.ok = counts.finished - counts.failed;
  result.failed = counts.failed;
  // Jobs that ended without making their runs.
  result.is_interrupted |= counts.finished < counts.all;
  const std::chrono::duration<double> span = std::chrono::steady_clock::now() - start;
  result.seconds = span.count();
  return result;
}

}  // namespace neve::app::sweep::jobs
