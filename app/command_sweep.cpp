#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "app/command_text.h"
#include "app/commands.h"
#include "app/errors.h"
#include "app/interrupt.h"
#include "app/machine.h"
#include "app/output/atomic_file.h"
#include "app/scene/error.h"
#include "app/scene/read.h"
#include "app/sweep/collect.h"
#include "app/sweep/dry_run_report.h"
#include "app/sweep/engine.h"
#include "app/sweep/labels.h"
#include "app/sweep/look.h"
#include "app/sweep/prepare.h"
#include "app/sweep/read_sweep.h"
#include "app/sweep/report.h"
#include "app/sweep/slurm.h"
#include "app/sweep/store.h"
#include "app/sweep/sweep_plan.h"
#include "app/text.h"

namespace neve::app {

namespace {

int core_count(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Those of --only and --shard, otherwise all.
std::vector<int> chosen_runs(const SweepOptions& options, const Manifest& manifest) {
  std::vector<int> indices;
  if (options.only.empty())
    for (const ManifestRun& run : manifest.runs) indices.push_back(run.index);
  else
    indices = parse_selection(options.only, manifest.runs.back().index);
  if (options.shard)
    std::erase_if(indices, [&](int index) {
      return index % options.shard->count != options.shard->index - 1;
    });
  return indices;
}

/// One command a line, each makes one run that is not finished.
void emit_commands(const SweepOptions& options, const std::filesystem::path& folder,
                   const Manifest& manifest, Progress& progress) {
  const std::string program = shell_word(this_program().string()),
                    where = shell_word(std::filesystem::absolute(folder).string());
  std::string text;
  int count = 0;
  for (const int index : chosen_runs(options, manifest)) {
    const ManifestRun& run = manifest.runs[static_cast<std::size_t>(index)];
    const RunState state = read_report(runs_folder(folder) / run.folder).state;
    if (is_finished(state) && !(options.is_failed_again && has_failed(state))) continue;
    text += program + " sweep run " + where + " --index " + std::to_string(index) +
            " --threads 1 --quiet" + (options.is_failed_again ? " --retry-failed" : "") + "\n";
    ++count;
  }
  write_file(options.emit, text);
  progress.note(std::to_string(count) + (count == 1 ? " command in " : " commands in ") +
                options.emit + "; then: neve sweep collect " + folder.string());
}

EngineResult run_engine(const SweepOptions& options, const std::filesystem::path& folder,
                        const Manifest& manifest, Progress& progress) {
  const std::vector<int> indices = chosen_runs(options, manifest);
  if (options.engine == "slurm") {
    const SlurmOptions slurm{this_program(), options.backend, options.jobs,
                             std::max(1, options.threads), options.sbatch};
    return run_slurm(folder, manifest, indices, slurm, options.is_failed_again, progress);
  }
  EngineOptions engine;
  engine.cores = core_count(options.threads);
  engine.jobs = options.jobs;
  engine.backend = options.backend;
  engine.is_failed_again = options.is_failed_again;
  engine.program = this_program();
  return run_local(folder, manifest, indices, engine, progress);
}

void print_sweep_result(const SweepOptions& options, const std::filesystem::path& folder,
                        const EngineResult& result, Progress& progress) {
  if (options.is_json) {
    Json json;
    json["out"] = folder.string();
    json["ok"] = result.ok;
    json["failed"] = result.failed;
    json["started"] = result.started;
    json["interrupted"] = result.is_interrupted;
    json["seconds"] = result.seconds;
    std::cout << to_text(json) << "\n";
  }
  progress.note(std::to_string(result.ok) + (result.ok == 1 ? " run" : " runs") + " ok" +
                (result.failed > 0 ? ", " + std::to_string(result.failed) + " failed" : "") +
                ", in " + folder.string());
}

/// Runs whose scenes are equal although their settings are not, at most five.
void warn_of_equal_runs(const SweepPlan& plan, Progress& progress) {
  int warnings = 0;
  std::map<std::string, const RunPlan*> seen;
  for (const RunPlan& item : plan.runs) {
    const std::string text = write_scene(item.scene) + std::to_string(item.frames.first) + "-" +
                             std::to_string(item.frames.last);
    const auto [first, is_new] = seen.emplace(text, &item);
    if (is_new) continue;
    std::string differing;
    for (const Override& setting : item.run.settings)
      if (value_of(first->second->run, setting.address) != setting.value)
        differing += (differing.empty() ? "" : ", ") + setting.address;
    // One that is given twice is told already.
    if (differing.empty() || ++warnings > 5) continue;
    progress.warning("runs " + std::to_string(first->second->run.index) + " and " +
                     std::to_string(item.run.index) + " are the same: " +
                     (differing == "output.size" ? "the sweep sets output.size itself, see --size"
                                                 : differing + " changes nothing here"));
  }
}

}  // namespace

int run_sweep(const SweepOptions& options) {
  SweepPlan plan = plan_sweep(options);
  const int cores = core_count(options.threads);
  Progress progress(std::cerr, options.verbosity, can_update_lines(STDERR_FILENO));
  for (const std::string& value : repeated_values(plan.sweep))
    progress.warning(value + " is twice in its list: that run is made once and shown twice");
  warn_of_equal_runs(plan, progress);
  if (options.is_dry_run) {
    print_sweep_plan(plan, cores, options.is_json);
    return exit_ok;
  }
  check_folder(plan);
  catch_interrupts();
  share_look(plan, cores);
  if (is_interrupted()) throw Error(exit_interrupted, "interrupted before the first run");
  const Manifest manifest = prepare_sweep(plan);
  if (!options.emit.empty()) {
    emit_commands(options, plan.folder, manifest, progress);
    return exit_ok;
  }
  const EngineResult result = run_engine(options, plan.folder, manifest, progress);
  collect_sweep(plan.folder, options.backend, cores, progress);
  print_sweep_result(options, plan.folder, result, progress);
  if (result.is_interrupted || is_interrupted()) {
    std::cerr << "neve: interrupted; the same command goes on from here" << std::endl;
    return exit_resumable;
  }
  return result.failed > 0 ? exit_runs_failed : exit_ok;
}

int run_sweep_run(const SweepRunOptions& options) {
  catch_interrupts();
  Progress progress(std::cerr, options.verbosity, can_update_lines(STDERR_FILENO));
  const Manifest manifest = read_manifest(options.folder);
  if (options.index < 0 || options.index >= static_cast<int>(manifest.runs.size()))
    throw UsageError("--index", "there is no run " + std::to_string(options.index),
                     "expected a number from 0 to " + std::to_string(manifest.runs.size() - 1));
  EngineOptions engine;
  engine.cores = core_count(options.threads);
  engine.jobs = 1;
  engine.backend = options.backend;
  engine.is_failed_again = options.is_failed_again;
  engine.program = this_program();
  const EngineResult result =
      run_local(options.folder, manifest, {options.index}, engine, progress);
  if (result.is_interrupted) return exit_resumable;
  return result.failed > 0 ? exit_runs_failed : exit_ok;
}

int run_sweep_collect(const CollectOptions& options) {
  catch_interrupts();
  Progress progress(std::cerr, options.verbosity, can_update_lines(STDERR_FILENO));
  collect_sweep(options.folder, options.backend, core_count(options.threads), progress);
  if (is_interrupted()) return exit_interrupted;
  progress.note("collected in " + options.folder);
  return exit_ok;
}

}  // namespace neve::app
