#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/health/findings.h"
#include "app/options/arguments.h"
#include "app/output/atomic_file.h"
#include "app/output/folder_lock.h"
#include "app/output/movie.h"
#include "app/scene/read.h"
#include "app/setup/caps.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/machine.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "app/sweep/jobs/background.h"
#include "app/sweep/jobs/local.h"
#include "app/sweep/jobs/slurm.h"
#include "app/sweep/jobs/source.h"
#include "app/sweep/jobs/start_order.h"
#include "app/sweep/plan/dry_run_report.h"
#include "app/sweep/plan/refinement.h"
#include "app/sweep/plan/shared_view.h"
#include "app/sweep/plan/sweep_forecast.h"
#include "app/sweep/plan/sweep_plan.h"
#include "app/sweep/read/read_sweep.h"
#include "app/sweep/sheet/collect.h"
#include "app/sweep/store/prepare.h"
#include "app/sweep/store/refine.h"
#include "app/sweep/store/results.h"
#include "app/sweep/store/store.h"

namespace neve::app::cli {

namespace {

/// The runs of --only, otherwise all: 0 to `last`. @throws UsageError
std::vector<int> selected_runs(const sweep::plan::SweepOptions& options, int last) {
  if (!options.only.empty()) return sweep::plan::parse_selection("--only", options.only, last);
  std::vector<int> indices(static_cast<std::size_t>(last) + 1);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

bool is_in_share(const sweep::plan::SweepOptions& options, int index) {
  return !options.shard || index % options.shard->count == options.shard->index - 1;
}

/// The runs of --only and --shard, otherwise all: 0 to `last`. @throws UsageError
std::vector<int> chosen_runs(const sweep::plan::SweepOptions& options, int last) {
  std::vector<int> indices = selected_runs(options, last);
  std::erase_if(indices, [&](int index) { return !is_in_share(options, index); });
  return indices;
}

/// The chosen runs, the copies of their points, and runs at full resolution. One share of --shard
/// has the copies of a point, that of its first run.
std::vector<int> wanted_runs(const sweep::plan::SweepOptions& options,
                             const sweep::store::Manifest& manifest) {
  const int last = manifest.runs.back().index;
  std::vector<int> indices = manifest.with_variants(selected_runs(options, last));
  std::erase_if(indices, [&](int index) {
    const bool is_run = index <= last;
    const auto place = static_cast<std::size_t>(is_run ? index : index - last - 1);
    return !is_in_share(options, is_run ? index : static_cast<int>(manifest.variants[place].of));
  });
  return indices;
}

sweep::store::Retry retry_of(const std::string& states) {
  return states.empty() ? sweep::store::Retry{} : sweep::store::parse_retry(states);
}

/// The table, the sheet and the report are those of the runs that are wanted now.
void note_left_out(const std::filesystem::path& folder, const sweep::store::Manifest& manifest,
                   Progress& progress) {
  std::set<std::string> wanted;
  for (const sweep::Run& run : manifest.runs) wanted.insert(run.folder);
  for (const sweep::store::Variant& variant : manifest.variants) wanted.insert(variant.run.folder);
  const auto known = sweep::store::known_runs(folder);
  const auto left = std::count_if(known.begin(), known.end(), [&](const auto& run) {
    return run.is_finished && !wanted.contains(run.folder);
  });
  if (left > 0)
    progress.note(fmt::format(
        "{} finished {} of before {} other settings or another scene: out of "
        "the table and the sheet, still in {}",
        left, left == 1 ? "run" : "runs", left == 1 ? "has" : "have", (folder / "runs").string()));
}

/// The wanted runs that are to be made, in the order in which they start.
std::vector<const sweep::Run*> runs_to_make(const sweep::plan::SweepOptions& options,
                                            const std::filesystem::path& folder,
                                            const sweep::store::Manifest& manifest,
                                            bool is_longest_first) {
  const sweep::store::Retry retry = retry_of(options.retry_failed);
  std::vector<const sweep::Run*> runs =
      sweep::jobs::start_order(manifest, wanted_runs(options, manifest), is_longest_first);
  std::erase_if(runs, [&](const sweep::Run* run) {
    return !sweep::store::why_to_make(
        folder, *run, sweep::store::read_status(sweep::store::runs_folder(folder) / run->folder),
        retry);
  });
  return runs;
}

/// One command a line, each makes one run that is not finished.
void emit_commands(const sweep::plan::SweepOptions& options, const std::filesystem::path& folder,
                   const sweep::store::Manifest& manifest, Progress& progress) {
  options::refuse_input("--emit", options.emit, manifest.scene_file);
  sweep::plan::SweepRunOptions one;
  one.folder = std::filesystem::absolute(folder).string();
  one.threads = 1;
  one.backend = options.backend;
  one.verbosity = Verbosity::quiet;
  one.retry_failed = options.retry_failed;
  one.caps = setup::cap_texts();
  std::string text;
  int count = 0;
  for (const sweep::Run* run : runs_to_make(options, folder, manifest, true)) {
    one.index = run->index;
    text += options::shell_line(options::words_of(one), this_program()) + "\n";
    ++count;
  }
  output::write_named_file(options.emit, text);
  if (options.is_json)
    std::cout << to_text({{"out", folder.string()},
                          {"exit_code", exit_ok},
                          {"commands_file", options.emit},
                          {"commands", count}})
              << "\n";
  progress.note(fmt::format("{} in {}; then: neve sweep collect {}", count_text(count, "command"),
                            options.emit, shell_path(folder.string())));
}

sweep::jobs::JobsResult run_engine(const sweep::plan::SweepOptions& options,
                                   const std::filesystem::path& folder,
                                   const sweep::store::Manifest& manifest, Progress& progress) {
  const std::vector<int> indices = wanted_runs(options, manifest);
  if (options.engine == "slurm") {
    const sweep::jobs::SlurmOptions slurm{
        this_program(), options.backend, options.jobs,      std::max(1, options.threads),
        options.sbatch, options.movie,   options.has_review};
    return sweep::jobs::run_slurm(folder, manifest, indices, slurm, options.retry_failed, progress);
  }
  sweep::jobs::LocalOptions engine;
  engine.cores = core_count(options.threads);
  engine.jobs = options.jobs;
  engine.backend = options.backend;
  engine.budget = options.budget;
  engine.retry_failed = retry_of(options.retry_failed);
  engine.program = this_program();
  return sweep::jobs::run_local(folder, manifest, indices, engine, progress);
}

[[noreturn]] void fail_by_machine(const sweep::jobs::MachineFailure& failure,
                                  const std::filesystem::path& folder) {
  throw Error(failure.code, "the sweep stopped: " + failure.reason, folder.string(),
              "solve this and repeat the command: it continues, and no run is lost");
}

/// Runs of the sweep that are ok: copies and runs at full resolution are no further ones.
int count_ok(const sweep::plan::SweepOptions& options, const std::filesystem::path& folder,
             const sweep::store::Manifest& manifest) {
  std::set<std::string> ok;  // folders, which equal runs share
  for (const int index : chosen_runs(options, manifest.runs.back().index)) {
    const std::string& run = manifest.runs[static_cast<std::size_t>(index)].folder;
    const sweep::store::RunStatus status =
        sweep::store::read_status(sweep::store::runs_folder(folder) / run);
    if (status.state == sweep::store::RunState::ok) ok.insert(run);
  }
  return static_cast<int>(ok.size());
}

int exit_code_of(const sweep::jobs::JobsResult& result) {
  if (result.is_interrupted || result.elsewhere > 0) return exit_resumable;
  return result.failed > 0 || result.failed_beginnings > 0 ? exit_runs_failed : exit_ok;
}

Json result_json(const std::filesystem::path& folder, const sweep::jobs::JobsResult& result) {
  return {{"out", folder.string()},
          {"exit_code", exit_code_of(result)},
          {"ok", result.ok},
          {"failed", result.failed},
          {"started", result.started},
          {"interrupted", result.is_interrupted},
          {"out_of_time", result.out_of_time},
          {"seconds", result.seconds}};
}

void print_sweep_result(const sweep::plan::SweepOptions& options,
                        const std::filesystem::path& folder, const sweep::jobs::JobsResult& result,
                        double foreseen_seconds, Progress& progress) {
  if (options.is_json) {
    Json json = result_json(folder, result);
    json["foreseen_seconds"] = foreseen_seconds;
    std::cout << to_text(json) << "\n";
  }
  progress.note(fmt::format("{} ok{}, in {}", count_text(result.ok, "run"),
                            result.failed > 0 ? fmt::format(", {} failed", result.failed) : "",
                            folder.string()));
}

/// Parameters of axes and of --set that no run uses.
void warn_of_idle_axes(const sweep::plan::SweepPlan& plan, Progress& progress) {
  std::map<std::string, std::string> idle;
  std::set<std::string> used;
  for (const sweep::plan::PlannedRun& item : plan.runs)
    for (const auto* settings : {&item.run.settings, &plan.sweep.fixed})
      for (const scene::Override& setting : *settings) {
        // Coarsening sets it beside the cells, in a pair of --refine.
        if (setting.address == "solver.dt" && !item.run.setting("solver.cell_size").empty())
          continue;
        const std::string why = health::why_idle(item.scene, setting.address);
        if (why.empty()) used.insert(setting.address);
        idle.emplace(setting.address, why);
      }
  for (const auto& [address, why] : idle)
    if (!used.contains(address)) progress.warning(address + " changes nothing here: " + why);
}

/// Runs whose scenes are equal although their settings are not, at most five.
void warn_of_equal_runs(const sweep::plan::SweepPlan& plan, Progress& progress) {
  int warnings = 0;
  std::map<std::string, const sweep::plan::PlannedRun*> seen;
  for (const sweep::plan::PlannedRun& item : plan.runs) {
    const std::string text = scene::write_scene(item.scene) +
                             std::to_string(item.run.frames.first) + "-" +
                             std::to_string(item.run.frames.last);
    const auto [first, is_new] = seen.emplace(text, &item);
    if (is_new) continue;
    std::string differing;
    for (const scene::Override& setting : item.run.settings)
      if (first->second->run.setting(setting.address) != setting.value)
        differing += (differing.empty() ? "" : ", ") + setting.address;
    // A value that is given twice is told already.
    if (differing.empty() || ++warnings > 5) continue;
    progress.warning(fmt::format(
        "runs {} and {} are the same: {}", first->second->run.index, item.run.index,
        differing == "output.size" ? "the sweep sets output.size itself; see --size"
                                   : fmt::format("{} changes nothing here", differing)));
  }
}

/// Numbers that look like another unit, and snow too thin for its cells, each once, with the first
/// run that has it.
void warn_of_numbers(const sweep::plan::SweepPlan& plan, double coarsening, Progress& progress) {
  constexpr std::size_t most = 5;
  std::set<std::string> warned;
  for (const sweep::plan::PlannedRun& item : plan.runs) {
    std::vector<health::Finding> findings;
    health::check_units(item.scene, findings, coarsening);
    health::check_resolution(item.scene, findings, coarsening);
    for (const health::Finding& finding : findings)
      if (finding.severity != health::Severity::note && warned.size() < most &&
          warned.insert(finding.address).second)
        progress.warning(fmt::format("run {}: {}", item.run.index, health::sentence(finding)));
  }
}

/// Methods that draw may draw a point twice, as trajectories of morris do where axes have few
/// levels.
void note_repeated_points(const sweep::plan::SweepPlan& plan, Progress& progress) {
  if (plan.sweep.settings.method == sweep::read::Method::grid) return;
  const auto seeds = static_cast<std::size_t>(plan.sweep.runs_per_point());
  std::set<std::string> keys;
  for (std::size_t k = 0; k < plan.runs.size(); k += seeds)
    keys.insert(sweep::store::key_of(plan, plan.runs[k]));
  const std::size_t points = plan.runs.size() / seeds, repeated = points - keys.size();
  if (repeated > 0)
    progress.note(
        fmt::format("{} of the {} points are drawn more than once: {} runs make all of them",
                    repeated, points, keys.size() * seeds));
}

/// An axis of one value compares nothing.
void warn_of_single_values(const sweep::read::Sweep& sweep, Progress& progress) {
  for (const sweep::read::Axis& axis : sweep.axes) {
    if (axis.size() != 1) continue;
    const sweep::read::Axis::Parameter& parameter = axis.parameters.front();
    progress.warning(
        fmt::format("{} has one value: no run differs in it; give several, as in "
                    "-p {}={},..., or use --set",
                    parameter.address, parameter.address, parameter.values.front().value));
  }
}

/// Pictures of the same simulations that are others now.
/// @param wanted  numbers of the runs that this command makes
void note_redrawn(const sweep::store::Redrawn& redrawn, const std::vector<int>& wanted,
                  const sweep::plan::SweepPlan& plan, Progress& progress) {
  const auto wanted_of = [&](const std::vector<int>& runs) {
    return std::count_if(runs.begin(), runs.end(), [&](int run) {
      return std::find(wanted.begin(), wanted.end(), run) != wanted.end();
    });
  };
  const auto runs = [](auto count) {
    return fmt::format("{} {}", count, count == 1 ? "run is" : "runs are");
  };
  const auto from_states = wanted_of(redrawn.from_states),
             made_again = wanted_of(redrawn.made_again);
  if (from_states > 0) progress.note(fmt::format("{} drawn from kept states", runs(from_states)));
  if (made_again == 0) return;
  const auto bytes = static_cast<std::uint64_t>(sweep::plan::bytes_of_states(plan));
  progress.note(fmt::format(
      "{} made again, although this folder has the same simulations with other pictures: their "
      "states were not kept{}",
      runs(made_again),
      plan.keeps_states
          ? ""
          : fmt::format("; --keep-states keeps them, in about {}", bytes_text(bytes))));
}

/// Keeps the copies of the points that are left in a plan that has lost some of its runs.
void keep_copies_of_runs(sweep::plan::SweepPlan& plan) {
  const auto seeds = static_cast<std::size_t>(plan.sweep.runs_per_point());
  std::map<std::size_t, std::size_t> places;  // of the first run that is left, by the point
  for (std::size_t k = 0; k < plan.runs.size(); ++k)
    places.emplace(static_cast<std::size_t>(plan.runs[k].run.index) / seeds, k);
  std::erase_if(plan.variants, [&](const sweep::plan::PlannedVariant& copy) {
    return !places.contains(copy.of / seeds);
  });
  for (sweep::plan::PlannedVariant& copy : plan.variants) copy.of = places.at(copy.of / seeds);
}

/// Keeps the runs of --only and --shard in a plan that is only printed. @throws UsageError
void choose_runs(const sweep::plan::SweepOptions& options, sweep::plan::SweepPlan& plan,
                 Progress& progress) {
  const std::vector<int> chosen = chosen_runs(options, plan.runs.back().run.index);
  if (chosen.empty())
    progress.warning(fmt::format("share {}/{} of {} runs is empty", options.shard->index,
                                 options.shard->count, plan.runs.size()));
  if (!options.is_dry_run || chosen.empty()) return;
  std::erase_if(plan.runs, [&](const sweep::plan::PlannedRun& item) {
    return std::find(chosen.begin(), chosen.end(), item.run.index) == chosen.end();
  });
  keep_copies_of_runs(plan);
}

/// Numbers of the chosen runs that are not finished, and of their copies; of equal ones the first.
std::vector<int> unfinished_runs(const sweep::plan::SweepOptions& options,
                                 const std::filesystem::path& folder,
                                 const sweep::store::Manifest& manifest) {
  std::vector<int> indices;
  for (const sweep::Run* run : runs_to_make(options, folder, manifest, false))
    indices.push_back(run->index);
  std::sort(indices.begin(), indices.end());
  return indices;
}

/// The runs and the copies that are left to do.
struct Left {
  std::vector<std::size_t> runs;                           ///< places in the plan, in order
  std::vector<const sweep::plan::PlannedVariant*> copies;  ///< of their points
};

Left left_of(const sweep::plan::SweepPlan& plan, const std::vector<int>& unfinished) {
  Left left;
  for (const int index : unfinished) {
    const auto place = static_cast<std::size_t>(index);
    if (place < plan.runs.size())
      left.runs.push_back(place);
    else
      left.copies.push_back(&plan.variants[place - plan.runs.size()]);
  }
  return left;
}

/// Gives the manifest the cost of each run and copy.
void take_costs(const sweep::plan::SweepPlan& plan, const sweep::plan::SweepForecast& forecast,
                sweep::store::Manifest& manifest) {
  double cost = 0, seconds = 0;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    manifest.runs[k].work = forecast.cost(k);
    cost += forecast.cost(k);
    seconds += forecast.seconds(k).expected;
  }
  for (sweep::store::Variant& variant : manifest.variants)
    variant.run.work =
        forecast.cost(variant.of) * sweep::plan::work_ratio(plan, variant.coarsening);
  if (forecast.seconds_per_work > 0) manifest.seconds_per_work = seconds / cost;
}

/// Says how long the sweep will take, and gives the manifest the cost of each run, by which runs
/// start and share the cores. @return s; 0: nothing is left to do, or it is not known
double foresee_runs(const sweep::plan::SweepOptions& options, const sweep::plan::SweepPlan& plan,
                    int cores, sweep::store::Manifest& manifest, Progress& progress) {
  const Left left = left_of(plan, unfinished_runs(options, plan.folder, manifest));
  if ((left.runs.empty() && left.copies.empty()) || options.engine != "local") return 0;
  // Copies cost as the run of their point, in proportion to their cells and steps.
  std::set<std::size_t> known(left.runs.begin(), left.runs.end());
  for (const sweep::plan::PlannedVariant* copy : left.copies) known.insert(copy->of);
  const std::vector<std::size_t> places(known.begin(), known.end());
  const sweep::plan::SweepForecast forecast = sweep::plan::foresee_sweep(
      plan, places, sweep::plan::small_effort(plan, places, cores), cores);
  take_costs(plan, forecast, manifest);
  sweep::store::write_manifest(plan.folder, manifest);
  double of_copies = 0;
  for (const sweep::plan::PlannedVariant* copy : left.copies)
    of_copies +=
        forecast.seconds(copy->of).expected * sweep::plan::work_ratio(plan, copy->coarsening);
  if (forecast.seconds_per_work > 0 && !left.runs.empty())
    progress.note(sweep::plan::forecast_text(plan, left.runs, forecast, cores, options.budget));
  if (!left.copies.empty())
    progress.note(fmt::format(
        "the prediction runs {} further {}{}", left.copies.size(),
        left.copies.size() == 1 ? "copy" : "copies",
        of_copies > 0 ? ": about " + duration_text(of_copies / cores) + " more on these cores"
                      : ""));
  const sweep::plan::Refinement refinement = sweep::plan::refinement_of(options, plan);
  if (refinement.is_wanted() && forecast.seconds_per_work > 0)
    progress.note(sweep::plan::refinement_text(refinement, plan, forecast, cores));
  return forecast.seconds_of_all(left.runs, cores).expected +
         (of_copies + sweep::plan::cost_of(refinement, plan, forecast).seconds) / cores;
}

/// First runs of the points that are to be made at full resolution.
std::vector<std::size_t> points_to_refine(const sweep::plan::SweepOptions& options,
                                          const sweep::plan::SweepPlan& plan,
                                          const sweep::store::Manifest& manifest,
                                          Progress& progress) {
  std::vector<std::size_t> points;
  for (const int run : sweep::plan::refinement_of(options, plan).named)
    points.push_back(static_cast<std::size_t>(run));
  if (options.refine == 0) return points;
  const std::vector<std::size_t> chosen = sweep::store::points_to_refine(
      manifest, sweep::store::read_results(plan.folder, manifest),
      sweep::store::predictions_of(plan.folder, manifest), static_cast<std::size_t>(options.refine),
      sweep::store::Best::parse("--best", options.best));
  if (chosen.empty())
    progress.warning(
        fmt::format("--refine makes no point at full resolution: none is undecided, and none has "
                    "{} to choose by; give another metric with --best",
                    options.best));
  for (const std::size_t run : chosen)
    if (std::find(points.begin(), points.end(), run) == points.end()) points.push_back(run);
  return points;
}

/// Makes the undecided and the best points at full resolution, beside the runs that have ended.
sweep::jobs::JobsResult refine(const sweep::plan::SweepOptions& options, int cores,
                               const sweep::jobs::JobsResult& coarse, sweep::plan::SweepPlan& plan,
                               sweep::store::Manifest& manifest, Progress& progress) {
  const std::vector<std::size_t> points = points_to_refine(options, plan, manifest, progress);
  if (points.empty()) return coarse;
  sweep::plan::add_full_runs(options, points, plan);
  sweep::plan::share_camera_and_ranges(plan, cores);
  sweep::store::Manifest with_full = sweep::store::prepare_sweep(plan);
  std::vector<std::size_t> made;
  double seconds = 0;
  for (std::size_t k = 0; k < with_full.runs.size(); ++k)
    with_full.runs[k].work = manifest.runs[k].work;
  with_full.seconds_per_work = manifest.seconds_per_work;
  for (sweep::store::Variant& variant : with_full.variants) {
    variant.run.work =
        with_full.runs[variant.of].work * sweep::plan::work_ratio(plan, variant.coarsening);
    if (!variant.is_full()) continue;
    made.push_back(variant.of);
    seconds += variant.run.work * with_full.seconds_per_work;
  }
  sweep::store::write_manifest(plan.folder, with_full);
  manifest = with_full;
  std::sort(made.begin(), made.end());
  progress.note(fmt::format("at full resolution: {} {}{}", made.size() == 1 ? "run" : "runs",
                            fmt::join(made, ", "),
                            seconds > 0 ? ", about " + duration_text(seconds / cores) : ""));
  sweep::plan::SweepOptions rest = options;
  if (rest.budget > 0) rest.budget = std::max(1.0, options.budget - coarse.seconds);
  sweep::jobs::JobsResult result = run_engine(rest, plan.folder, manifest, progress);
  result.seconds += coarse.seconds;
  result.started += coarse.started;
  return result;
}

}  // namespace

int run_sweep(const sweep::plan::SweepOptions& options) {
  sweep::store::Best::parse("--best", options.best);
  retry_of(options.retry_failed);  // a wrong word is refused before anything is planned
  sweep::plan::SweepPlan plan = sweep::plan::plan_sweep(options);
  const int cores = core_count(options.threads);
  Progress progress(options.verbosity, options.progress);
  if (plan.fast) progress.note(plan.fast->sentence());
  for (const std::string& value : sweep::read::repeated_values(plan.sweep))
    progress.warning(value + " is in its list twice: the run is made once and shown twice");
  warn_of_single_values(plan.sweep, progress);
  warn_of_equal_runs(plan, progress);
  warn_of_idle_axes(plan, progress);
  warn_of_numbers(plan, options.coarsening.value_or(1), progress);
  note_repeated_points(plan, progress);
  const sweep::plan::Refinement refinement = sweep::plan::refinement_of(options, plan);
  choose_runs(options, plan, progress);
  if (options.is_dry_run) {
    sweep::plan::print_sweep_plan(plan, refinement, options.rounds, cores, options.is_json);
    return exit_ok;
  }
  const output::MovieStyle movie = output::available_movie(options.movie, plan.base.fps);
  sweep::store::check_folder(plan);
  // Shards of a sweep work side by side.
  const output::FolderLock lock(
      plan.folder, "neve sweep",
      options.shard ? output::FolderLock::Kind::shared : output::FolderLock::Kind::alone);
  catch_interrupts();
  {
    const NothingToKeep reading;
    const std::filesystem::path aside = sweep::plan::share_camera_and_ranges(plan, cores);
    if (!aside.empty())
      progress.warning(fmt::format(
          "{} was written for another scene, frame or shape of the tiles: the camera and the "
          "colour ranges are found anew, and it is kept as {}; to see these runs so, write its "
          "camera into {}",
          sweep::plan::shared_view_path(plan.folder).string(), aside.filename().string(),
          sweep::plan::shared_view_path(plan.folder).filename().string()));
  }
  if (const std::size_t outdated = sweep::store::outdated_runs(plan.folder); outdated > 0)
    progress.note(fmt::format(
        "another build of neve made the {} finished {} here, from sources that change results: "
        "made again",
        outdated, outdated == 1 ? "run" : "runs"));
  sweep::store::Redrawn redrawn;
  sweep::store::Manifest manifest = sweep::store::prepare_sweep(plan, &redrawn);
  note_redrawn(redrawn, wanted_runs(options, manifest), plan, progress);
  // Runs at full resolution are not chosen yet.
  if (!refinement.is_wanted()) note_left_out(plan.folder, manifest, progress);
  const double foreseen_seconds = foresee_runs(options, plan, cores, manifest, progress);
  if (plan.source) sweep::jobs::take_beginning(plan, *manifest.beginning, cores, progress);
  if (!options.emit.empty()) {
    emit_commands(options, plan.folder, manifest, progress);
    return exit_ok;
  }
  sweep::jobs::JobsResult result = run_engine(options, plan.folder, manifest, progress);
  const bool has_ended = !result.failure && !result.is_interrupted && result.elsewhere == 0;
  if (has_ended && refinement.is_wanted()) {
    result = refine(options, cores, result, plan, manifest, progress);
    note_left_out(plan.folder, manifest, progress);
  }
  if (result.failure) fail_by_machine(*result.failure, plan.folder);
  sweep::sheet::collect_sweep(plan.folder, movie, options.has_review, options.backend, cores,
                              progress);
  result.ok = count_ok(options, plan.folder, manifest);
  print_sweep_result(options, plan.folder, result, foreseen_seconds, progress);
  if (result.elsewhere > 0)
    progress.say(fmt::format(
        "not finished: {}{}; the same command completes the sweep later", result.elsewhere_text,
        result.elsewhere > 1 ? fmt::format(" and {} more", result.elsewhere - 1) : ""));
  else if (result.out_of_time > 0 && !is_interrupted())
    progress.say(
        fmt::format("the budget of {} was too short for {}; the same command continues from here",
                    duration_text(options.budget), count_text(result.out_of_time, "run")));
  else if (result.is_interrupted || is_interrupted())
    progress.say("interrupted; the same command continues from here");
  return is_interrupted() ? exit_resumable : exit_code_of(result);
}

namespace {

/// Indices of common beginnings. @param which  "all", or a number from 1 @throws UsageError
std::vector<int> chosen_beginnings(const std::string& which,
                                   const sweep::store::Manifest& manifest) {
  if (!manifest.beginning)
    throw UsageError("--beginning", "this sweep has no fork", "give --index N for one of them");
  const auto count = static_cast<int>(manifest.beginning->runs.size());
  std::vector<int> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), 0);
  if (which == "all") return all;
  const std::optional<int> number = number_of<int>(which);
  if (!number || *number < 1 || *number > count)
    throw UsageError("--beginning", "there is no beginning \"" + which + "\"",
                     count == 1 ? "expected 1, or no number"
                                : fmt::format("expected a number from 1 to {}, one for each seed, "
                                              "or none for all of them",
                                              count));
  return {*number - 1};
}

}  // namespace

int run_sweep_run(const sweep::plan::SweepRunOptions& options) {
  catch_interrupts();
  Progress progress(options.verbosity, options.progress);
  const sweep::store::Manifest manifest = sweep::store::read_manifest(options.folder);
  // One that makes its runs under the keys of another build mixes them in one table.
  if (!manifest.sources.empty() && manifest.sources != build().sources)
    throw Error(exit_refused,
                options.folder +
                    ": another build of neve has planned this sweep, which would give "
                    "other results; repeat the command of the sweep with this one",
                options.folder, "repeat the command of the sweep, which plans it with this build");
  const bool makes_beginnings = !options.beginning.empty();
  const int index = options.index.value_or(0);
  if (!manifest.run_of(index))
    throw UsageError("--index", fmt::format("there is no run {}", index),
                     fmt::format("expected a number from 0 to {}", manifest.last_index()));
  sweep::jobs::LocalOptions engine;
  engine.cores = core_count(options.threads);
  engine.jobs = 1;
  engine.is_one_of_many = true;
  engine.backend = options.backend;
  engine.retry_failed = retry_of(options.retry_failed);
  engine.program = this_program();
  if (makes_beginnings) engine.beginnings = chosen_beginnings(options.beginning, manifest);
  const std::vector<int> indices = makes_beginnings ? std::vector<int>{} : std::vector<int>{index};
  const sweep::jobs::JobsResult result =
      sweep::jobs::run_local(options.folder, manifest, indices, engine, progress);
  if (result.failure) fail_by_machine(*result.failure, options.folder);
  if (result.elsewhere > 0) throw IoError(result.elsewhere_text, options.folder, "wait for it");
  if (options.is_json) std::cout << to_text(result_json(options.folder, result)) << "\n";
  return exit_code_of(result);
}

int run_sweep_collect(const sweep::plan::CollectOptions& options) {
  catch_interrupts();
  Progress progress(options.verbosity, options.progress);
  const output::MovieStyle movie =
      output::available_movie(options.movie, sweep::store::read_manifest(options.folder).fps);
  sweep::sheet::collect_sweep(options.folder, movie, options.has_review, options.backend,
                              core_count(options.threads), progress);
  if (is_interrupted()) return exit_interrupted;
  const RunCounts counts = sweep::jobs::progress_of(options.folder).counts();
  const int unfinished = counts.all - counts.finished;
  progress.note("collected in " + options.folder);
  if (unfinished > 0)
    progress.warning(fmt::format("{} of {} runs {} not finished; neve sweep continues them",
                                 unfinished, counts.all, unfinished == 1 ? "is" : "are"));
  if (options.is_json)
    std::cout << to_text({{"out", options.folder},
                          {"exit_code", exit_ok},
                          {"runs", counts.all},
                          {"ok", counts.finished - counts.failed},
                          {"failed", counts.failed},
                          {"unfinished", unfinished}})
              << "\n";
  return exit_ok;
}

}  // namespace neve::app::cli
