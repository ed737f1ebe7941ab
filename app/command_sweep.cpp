#include <unistd.h>

#include <iostream>
#include <thread>

#include "app/commands.h"
#include "app/errors.h"
#include "app/interrupt.h"
#include "app/machine.h"
#include "app/sweep/collect.h"
#include "app/sweep/dry_run_report.h"
#include "app/sweep/engine.h"
#include "app/sweep/look.h"
#include "app/sweep/prepare.h"
#include "app/sweep/store.h"
#include "app/sweep/sweep_plan.h"
#include "app/text.h"

namespace neve::app {

namespace {

int core_count(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

std::vector<int> all_indices(const Manifest& manifest) {
  std::vector<int> indices;
  for (const ManifestRun& run : manifest.runs) indices.push_back(run.index);
  return indices;
}

void print_result(const SweepOptions& options, const std::filesystem::path& folder,
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

}  // namespace

int run_sweep(const SweepOptions& options) {
  SweepPlan plan = plan_sweep(options);
  const int cores = core_count(options.threads);
  if (options.is_dry_run) {
    print_sweep_plan(plan, cores, options.is_json);
    return exit_ok;
  }
  catch_interrupts();
  Progress progress(std::cerr, options.verbosity, can_update_lines(STDERR_FILENO));
  share_look(plan, cores);
  if (is_interrupted()) throw Error(exit_interrupted, "interrupted before the first run");
  const Manifest manifest = prepare_sweep(plan);
  EngineOptions engine;
  engine.cores = cores;
  engine.jobs = options.jobs;
  engine.backend = options.backend;
  engine.is_failed_again = options.is_failed_again;
  engine.program = this_program();
  const EngineResult result =
      run_local(plan.folder, manifest, all_indices(manifest), engine, progress);
  collect_sweep(plan.folder, options.backend, cores, progress);
  print_result(options, plan.folder, result, progress);
  if (result.is_interrupted || is_interrupted()) {
    std::cerr << "neve: interrupted; the same command goes on from here" << std::endl;
    return exit_resumable;
  }
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
