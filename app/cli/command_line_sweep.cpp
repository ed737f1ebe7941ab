/// The command line of `neve sweep`.

#include <memory>
#include <optional>

#include "app/cli/command_line_parts.h"
#include "app/cli/commands.h"
#include "app/run/past_run.h"
#include "app/scene/scene_file.h"
#include "app/setup/argument_text.h"
#include "app/support/errors.h"
#include "app/sweep/read/sweep_leaf.h"
#include "app/sweep/store/store.h"

namespace neve::app::cli {

namespace {

/// Values that CLI11 hands over as text.
struct SweepTexts {
  std::optional<std::string> frames, fork, from, size, coarsening, shard, progress, budget;
  bool is_quiet = false, is_verbose = false;
  MovieTexts movie;
};

sweep::plan::SweepOptions finished_sweep(sweep::plan::SweepOptions options,
                                         const SweepTexts& texts) {
  if (options.file.empty())
    throw UsageError("sweep", "which sweep?", "give a sweep file, or a scene and -p ADDRESS=LIST");
  options.file = scene::path_of_scene(options.file);
  if (texts.from) options.from = setup::parse_time(*texts.from, "--from");
  if (!texts.from && run::is_folder(options.file))
    throw UsageError("sweep", options.file + " is a folder, not a scene",
                     "to vary its run from a time on, add --from TIME");
  if (texts.frames) options.frames = setup::parse_frames(*texts.frames);
  if (texts.fork) options.fork = setup::parse_time(*texts.fork, "--fork");
  if (texts.coarsening) options.coarsening = setup::parse_coarsening(*texts.coarsening);
  if (texts.size) options.size = setup::parse_size(*texts.size);
  options.movie = finished_movie(texts.movie);
  if (texts.is_quiet) options.verbosity = Verbosity::quiet;
  if (texts.is_verbose) options.verbosity = Verbosity::verbose;
  if (!options.retry_failed.empty()) sweep::store::parse_retry(options.retry_failed);
  if (texts.progress) options.progress.is_json = parse_progress(*texts.progress);
  if (texts.shard) options.shard = sweep::plan::parse_shard(*texts.shard);
  if (options.engine != "local" && options.engine != "slurm")
    throw UsageError("--engine", "unknown engine \"" + options.engine + "\"",
                     "expected local or slurm; --shard and --emit work with any scheduler");
  if (texts.budget) {
    const std::optional<double> seconds = sweep::read::seconds_of(*texts.budget);
    if (!seconds || !(*seconds > 0))
      throw UsageError("--budget", "cannot use \"" + *texts.budget + "\"",
                       "expected a time as in 90s, 20m or 1h30m");
    if (options.engine == "slurm" || !options.emit.empty())
      throw UsageError(
          "--budget", "runs of other schedulers end when these end them",
          "remove --budget, or limit each run with [limits] timeout in the sweep file");
    options.budget = *seconds;
  }
  if (!options.sbatch.empty() && options.engine != "slurm")
    throw UsageError("--sbatch", "works only with --engine slurm",
                     "add --engine slurm, or remove --sbatch");
  check_threads(options.threads);
  check_backend(options.backend);
  if (options.jobs < 0 || options.jobs > 1024)
    throw UsageError("--jobs", "cannot use " + std::to_string(options.jobs),
                     "expected 0 (as many as keep the cores busy) to 1024");
  return options;
}

void add_what(CLI::App& command, sweep::plan::SweepOptions& options, SweepTexts& texts) {
  command
      .add_option("FILE", options.file,
                  "A sweep file (TOML with a table [sweep]), or a scene and -p; with --from the "
                  "folder of a run, or a picture")
      ->type_name("");
  add_repeatable(command, "-p,--parameter", options.axes, "ADDRESS=LIST",
                 "Vary a parameter, as in material.snow.hardening=5,10,20 or solver.cell_size={ "
                 "logspace = [0.01, 0.04], num = 3 } (repeatable: all combinations)");
  add_repeatable(command, "--set", options.overrides, "ADDRESS=VALUE",
                 "Change a parameter of all runs (repeatable)");
  command
      .add_option("--frames", texts.frames,
                  "Frames of each run: A-B, or N for 0-N; overrides the file")
      ->type_name("A-B");
  command
      .add_option(
          "--fork", texts.fork,
          "Part the runs at a time, as in 0.8s: their beginning is computed once, then each "
          "changes its parameters; only those that may change during a run")
      ->type_name("TIME");
  command
      .add_option("--from", texts.from,
                  "Part the runs at a time from the run in FILE, the folder of a run or a picture: "
                  "they begin with its state there, and -p and --set change it")
      ->type_name("TIME");
  command.add_flag("--keep-states", options.keeps_states,
                   "Keep the state of each drawn frame: tiles of another size, view, colour or "
                   "camera are then drawn without simulating; --dry-run says what that takes");
  command.add_option("--size", texts.size, "Size of a tile; default: 480 pixels wide")
      ->type_name("WxH");
  command.add_option("--coarsen", texts.coarsening, "Make cells N times as large in all runs")
      ->type_name("N");
  command.add_flag("--fast", options.is_fast,
                   "Take longer steps in all runs for a quick look, by settings that are recorded "
                   "as --set is");
  add_movie_flags(command, texts.movie);
  command.add_option("--out", options.out, "Output folder instead of out/<name of the file>.cdb")
      ->type_name("DIR");
}

/// Adds the options that select runs and machines.
void add_where(CLI::App& command, sweep::plan::SweepOptions& options, SweepTexts& texts) {
  command.add_option("--only", options.only, "Make only these runs, as in 3,7-12")
      ->type_name("LIST");
  command
      .add_option("--budget", texts.budget,
                  "Stop after this time, as in 20m or 1h30m; the same command continues. A run "
                  "that by the forecast would not end before is not started")
      ->type_name("TIME");
  command
      .add_option("--shard", texts.shard,
                  "Make only the I-th of N shares, each on a machine of its own that shares the "
                  "output folder")
      ->type_name("I/N");
  command
      .add_option("--engine", options.engine,
                  "local: run on this machine; slurm: submit a job array and wait for it (Ctrl-C "
                  "cancels it)")
      ->type_name("NAME")
      ->capture_default_str();
  add_repeatable(command, "--sbatch", options.sbatch, "OPTION",
                 "Pass a further option to sbatch, as in --sbatch=--partition=long (repeatable; "
                 "with --engine slurm)");
  command
      .add_option("--emit", options.emit,
                  "Write the command of each run to a file, one a line, for GNU parallel and "
                  "render farms; start nothing")
      ->type_name("FILE");
}

/// Adds the options of subcommands that work on an existing sweep.
template <class Options>
void add_folder(CLI::App& command, Action& action, const std::shared_ptr<Options>& options,
                int (*run)(const Options&)) {
  const auto is_quiet = std::make_shared<bool>(false);
  command.add_option("DIR", options->folder, "Output folder of a sweep")->required()->type_name("");
  command.add_option("--threads", options->threads, "Number of threads; 0: one per core")
      ->type_name("N");
  command.add_option("--backend", options->backend, "OpenGL backend; neve doctor lists them")
      ->type_name("NAME");
  const auto progress = std::make_shared<std::optional<std::string>>();
  command.add_flag("--json", options->is_json, "Print the result, or the error, as JSON");
  add_progress(command, *progress, options->progress);
  command.add_flag("--quiet,-q", *is_quiet, "Print only errors and warnings");
  command.final_callback([=, &action] {
    check_threads(options->threads);
    check_backend(options->backend);
    if (*progress) options->progress.is_json = parse_progress(**progress);
    action = [=] {
      if (*is_quiet) options->verbosity = Verbosity::quiet;
      return run(*options);
    };
  });
}

void add_run(CLI::App& sweep, Action& action) {
  CLI::App* command = sweep.add_subcommand(
      "run", "Make one run of an existing sweep; --emit and --engine slurm use this");
  const auto options = std::make_shared<sweep::plan::SweepRunOptions>();
  CLI::Option* index =
      command->add_option("--index", options->index, "Number of the run")->type_name("N");
  command
      ->add_flag("--beginning", options->is_beginning,
                 "Make the common beginning of a sweep with --fork, instead of a run")
      ->excludes(index);
  command
      ->add_flag("--retry-failed{all}", options->retry_failed,
                 "Repeat the run if it failed before, or ended in one of these states, as in "
                 "--retry-failed=timeout,crashed")
      ->disable_flag_override(false);
  add_caps(*command);
  add_folder(*command, action, options, run_sweep_run);
  command->parse_complete_callback([=] {
    if (command->count("--index") == 0 && !options->is_beginning)
      throw UsageError("sweep run", "which run?", "give --index N, or --beginning");
  });
}

void add_collect(CLI::App& sweep, Action& action) {
  CLI::App* command = sweep.add_subcommand(
      "collect", "Make table, sheets and report from the finished runs of a sweep");
  const auto options = std::make_shared<sweep::plan::CollectOptions>();
  const auto movie = std::make_shared<MovieTexts>();
  add_movie_flags(*command, *movie);
  add_folder(*command, action, options, run_sweep_collect);
  command->parse_complete_callback([=] { options->movie = finished_movie(*movie); });
}

}  // namespace

void add_sweep(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "sweep",
      "Run a scene with many parameter values, and make a labelled contact sheet of the results");
  const auto options = std::make_shared<sweep::plan::SweepOptions>();
  const auto texts = std::make_shared<SweepTexts>();
  add_what(*command, *options, *texts);
  command->add_option("--threads", options->threads, "Number of cores; 0: all")->type_name("N");
  command
      ->add_option("--jobs", options->jobs,
                   "Number of simultaneous runs; default: as many as keep the cores busy and fit "
                   "into memory")
      ->type_name("N");
  command->add_option("--backend", options->backend, "OpenGL backend; neve doctor lists them")
      ->type_name("NAME");
  command
      ->add_flag("--retry-failed{all}", options->retry_failed,
                 "Repeat the runs that failed, timed out, crashed or took too much memory, or "
                 "only those in some states, as in --retry-failed=timeout,crashed")
      ->disable_flag_override(false);
  add_caps(*command);
  command->add_flag("--dry-run", options->is_dry_run,
                    "Print the runs, their cost and memory; start nothing");
  command->add_flag("--json", options->is_json, "Print the result, or the error, as JSON");
  add_progress(*command, texts->progress, options->progress);
  CLI::Option* quiet =
      command->add_flag("--quiet,-q", texts->is_quiet, "Print only errors and warnings");
  command->add_flag("--verbose,-v", texts->is_verbose, "Print a line for each run")
      ->excludes(quiet);
  add_where(*command, *options, *texts);
  add_run(*command, action);
  add_collect(*command, action);
  command->final_callback([=, &action] {
    if (!command->get_subcommands().empty()) return;
    if (command->count("--out") > 0 && options->out.empty())
      throw UsageError("--out", "names no folder", "expected the path of a folder");
    action = [=] { return run_sweep(finished_sweep(*options, *texts)); };
  });
}

}  // namespace neve::app::cli
