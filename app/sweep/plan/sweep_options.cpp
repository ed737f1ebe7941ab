#include "app/sweep/plan/sweep_options.h"

#include <fmt/core.h>

#include <cmath>

#include "app/options/common.h"
#include "app/options/languages.h"
#include "app/run/render_options.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"
#include "app/sweep/read/sweep_leaf.h"
#include "app/timeline/origin.h"

namespace neve::app::sweep::plan {

namespace {

options::Language<double> budget() {
  return {"TIME", "1h30m",
          [](const std::string& flag, const std::string& text) {
            const std::optional<double> seconds = read::seconds_of(text);
            if (!seconds || !(*seconds > 0))
              throw UsageError(flag, "cannot use \"" + text + "\"",
                               "expected a time as in 90s, 20m or 1h30m");
            return *seconds;
          },
          [](const double& seconds) { return scene::toml::number_text(seconds) + "s"; }};
}

setup::Quality tile_quality(const std::string& name) {
  if (name == setup::name(setup::Quality::draft))
    throw UsageError("--quality", "tiles have a size of their own",
                     "give --size 240x135 for smaller ones; expected preview or final");
  return setup::quality_named(name);
}

int read_seeds(const std::string& flag, const std::string& text) {
  const std::optional<double> number = finite_number(text);
  if (!number || *number != std::floor(*number) || *number < 0)
    throw UsageError(
        flag, "cannot use \"" + text + "\"",
        fmt::format("expected a whole number from {} to {}", read::min_seeds, read::max_seeds));
  if (*number < read::min_seeds)
    throw UsageError(flag, text + " tells nothing about noise: one run is one draw",
                     fmt::format("expected {} or more, as in --seeds 4; or remove --seeds for one "
                                 "run of each point",
                                 read::min_seeds));
  if (*number > read::max_seeds)
    throw UsageError(flag, text + " is too many",
                     fmt::format("expected at most {}; 4 show what is noise, 8 show small "
                                 "differences",
                                 read::max_seeds));
  return static_cast<int>(*number);
}

void check_engine(const std::string& flag, const std::string& name) {
  if (name != "local" && name != "slurm")
    throw UsageError(flag, "unknown engine \"" + name + "\"",
                     "expected local or slurm; --shard and --emit work with any scheduler");
}

/// Refuses an empty list: a variable of the shell that is not set must not mean all runs.
void check_list(const std::string& flag, const std::string& text) {
  if (text.empty())
    throw UsageError(flag, "the list is empty",
                     "expected numbers of runs, as in 3,7-12; is a variable of the shell not set?");
}

void describe_retry(options::Command& visit, std::string& states, const char* help) {
  visit("--retry-failed", states, options::text("STATES", "timeout,crashed"), help).or_alone("all");
}

constexpr const char* review_help =
    "Link the pictures of all runs as DIR/review/run_0007.1001.png, names that review servers "
    "group; DIR/runs.otio then names these";

void describe_runs(options::Command& visit, SweepOptions& o) {
  visit("FILE", o.file, options::scene_file(),
        "A sweep file (TOML with a table [sweep]), or a scene and -p; with --from the folder of a "
        "run, or a picture");
  visit("-p,--parameter", o.axes, options::text("ADDRESS=LIST", "material.snow.hardening=5,10,20"),
        "Vary a parameter, as in material.snow.hardening=5,10,20 or solver.cell_size={ logspace = "
        "[0.01, 0.04], num = 3 } (repeatable: all combinations)");
  visit("--set", o.overrides, options::text("ADDRESS=VALUE", "material.snow.hardening=5"),
        "Change a parameter of all runs (repeatable)");
  visit("--frames", o.frames, options::frames(),
        "Frames of each run: A-B, or N for all up to N; overrides the file");
  visit("--fork", o.fork, options::time(),
        "Fork all runs at a time, as in 0.8s: simulate the common start once, then change live "
        "parameters in each");
  visit("--from", o.from, options::time(),
        "Fork all runs from the run of FILE (the folder of a run, or a picture) at a time: they "
        "start with its state at that time, and -p and --set change parameters there");
  visit(
      "--seeds", o.seeds, seeds(),
      "Make N runs of each point, with the scene's seed and those after it, so that tiles, table "
      "and plots show which differences are larger than noise; N times the cost; with --fork each "
      "seed has a beginning of its own");
  visit(
      "--refine", o.refine,
      options::number<int>("K", 1, 10000, "a number of points from 1 to 10000, as in --refine 4"),
      "With --coarsen N: when all runs have ended, make K points at full resolution as well, with "
      "all of their seeds, in the same folder: the undecided ones first, then the best of --best; "
      "tiles show these, and the report says how well coarse ranked full");
  visit("--refine-runs", o.refine_runs, options::text("LIST", "3,7-9", check_list),
        "With --coarsen N: make these runs at full resolution as well, as in 3,7-9; with --seeds "
        "the points that they are of");
  visit("--best", o.best, options::text("METRIC", "height"),
        "Metric of data.csv by which --refine chooses, the greatest first; METRIC:least for the "
        "least, "
        "as in spread:least")
      .with_default();
  visit("--keep-states", o.keeps_states,
        "Keep the state of each drawn frame: tiles of another size, view, colour or camera are "
        "then drawn without simulating; --dry-run says how much disk space the states take");
  visit("--size", o.size, options::size(), "Size of a tile; default: 480 pixels wide");
  describe_tiles(visit, o);
  visit("--coarsen", o.coarsening, options::coarsening(),
        "Make cells N times as large in all runs");
  visit(
      "--predict", o.predicts,
      "With --coarsen N: run coarse copies of each point beside its runs, and say on tiles and in "
      "tables what it does at full resolution: breaks, holds or undecided, and its size with "
      "intervals; costs about a third of that run for each point");
  visit("--fast", o.is_fast,
        "Take longer steps in all runs for a quick look, by settings that are recorded like those "
        "of --set");
  options::describe_movie(visit, o.movie);
  visit("--review", o.has_review, review_help);
  visit("--out", o.out, options::folder("sheet.png"),
        "Output folder instead of out/<name of the file>.cdb");
}

/// The runs that are chosen, and the machines that make them.
void describe_places(options::Command& visit, SweepOptions& o) {
  visit("--only", o.only, options::text("LIST", "3,7-12", check_list),
        "Make only these runs, as in 3,7-12");
  visit("--budget", o.budget, budget(),
        "Stop after this time, as in 20m or 1h30m; the same command continues. A run is not "
        "started if its forecast ends later");
  visit("--shard", o.shard, options::language("I/N", "2/8", parse_shard, shard_text),
        "Make only the I-th of N shares; each share runs on a machine of its own, all write to one "
        "output folder");
  visit("--engine", o.engine, options::text("NAME", "slurm", check_engine),
        "local: run on this machine; slurm: submit a job array and wait for it (Ctrl-C cancels it)")
      .with_default();
  visit("--sbatch", o.sbatch, options::text("OPTION", "--partition=long"),
        "Pass a further option to sbatch, as in --sbatch=--partition=long (repeatable; with "
        "--engine slurm)");
  visit("--emit", o.emit, options::text("FILE"),
        "Write the command of each run to a file, one a line, for GNU parallel and render farms; "
        "start nothing");
}

void check_places(const SweepOptions& o) {
  if (o.budget > 0 && (o.engine == "slurm" || !o.emit.empty()))
    throw UsageError("--budget", "runs of other schedulers end when these end them",
                     "remove --budget, or limit each run with [limits] timeout in the sweep file");
  if (!o.sbatch.empty() && o.engine != "slurm")
    throw UsageError("--sbatch", "works only with --engine slurm",
                     "add --engine slurm, or remove --sbatch");
}

/// A seed draws particles at the start of a run; later there is nothing left to draw.
void check_seeds(const SweepOptions& o) {
  if (!o.from || o.seeds == 0) return;
  const std::string time = scene::toml::number_text(*o.from) + "s";
  throw UsageError(
      "--seeds",
      fmt::format("cannot be combined with --from: the state of {} at {} has drawn its "
                  "particles already, and all seeds would give the same runs",
                  o.file, time),
      fmt::format("simulate the beginning with each seed: neve sweep SCENE --fork {} "
                  "--seeds {}",
                  time, o.seeds));
}

void check_prediction(const SweepOptions& o) {
  if (!o.predicts) return;
  if (!(o.coarsening.value_or(1) > 1))
    throw UsageError("--predict", "predicts full runs from coarse ones, and these are none",
                     "add --coarsen 2");
  if (o.fork || o.from)
    throw UsageError("--predict",
                     std::string("cannot be combined with ") + (o.fork ? "--fork" : "--from") +
                         ": copies are simulated from the start",
                     "remove one of them");
}

void check_refinement(const SweepOptions& o) {
  if (o.refine == 0 && o.refine_runs.empty()) return;
  const char* flag = o.refine > 0 ? "--refine" : "--refine-runs";
  if (!(o.coarsening.value_or(1) > 1))
    throw UsageError(flag, "makes runs of a coarse sweep at full resolution, and this is none",
                     "add --coarsen 2");
  const char* other = o.fork ? "--fork" : o.from ? "--from" : nullptr;
  if (other)
    throw UsageError(
        flag,
        std::string("cannot be combined with ") + other + ": a run keeps its cells while it runs",
        "remove one of them");
  if (o.shard || !o.emit.empty() || o.engine != "local")
    throw UsageError(
        flag, "waits for all runs of the sweep, which end elsewhere",
        "remove --shard, --emit and --engine, or repeat the sweep without them and with " +
            std::string(flag) + " when they have ended");
}

/// The end of the list, for commands that work on an existing sweep.
template <class Options>
void describe_folder(options::Command& visit, Options& o) {
  visit("DIR", o.folder, options::text(""), "Output folder of a sweep").required();
  options::describe_threads(visit, o.threads);
  options::describe_backend(visit, o.backend);
  visit("--json", o.is_json, options::json_help);
  options::describe_progress(visit, o.progress);
  options::describe_verbosity(visit, o.verbosity);
}

}  // namespace

void describe_tiles(options::Command& visit, SweepOptions& o) {
  visit("--view", o.view, options::text("NAME", "smoke"),
        "View on the tiles; default: that of the sweep file, else the scene's first");
  visit("--quality", o.quality,
        options::language("NAME", "final", tile_quality,
                          [](setup::Quality quality) { return setup::name(quality); }),
        "preview: one sample per pixel (default); final: four, without steps at edges, and motion "
        "blur");
}

options::Language<int> seeds() {
  return {"N", "4", read_seeds, [](const int& seeds) { return std::to_string(seeds); }};
}

void describe(options::Command& visit, SweepOptions& o) {
  visit.about(
      "sweep",
      "Run a scene with many parameter values, and make a labelled contact sheet of the results");
  describe_runs(visit, o);
  visit("--wrap", o.wrap, options::number<int>("N", 1, 64, "a whole number from 1 to 64"),
        "Tiles side by side in the sheet of one axis");
  options::describe_threads(visit, o.threads, "Number of cores; 0: all");
  visit(
      "--jobs", o.jobs,
      options::number<int>("N", 0, 1024,
                           "a whole number from 0 (as many as keep the cores busy, the default) to "
                           "1024"),
      "Number of simultaneous runs; default: as many as keep the cores busy and fit into memory");
  options::describe_backend(visit, o.backend);
  describe_retry(visit, o.retry_failed,
                 "Repeat the runs that failed, timed out, crashed or took too much memory, or only "
                 "those in some states, as in --retry-failed=timeout,crashed");
  options::describe_caps(visit, o.caps);
  run::describe_agreement(visit, o.is_agreed);
  visit("--dry-run", o.is_dry_run, "Print the runs, their cost and memory; start nothing");
  visit("--json", o.is_json, options::json_help);
  options::describe_progress(visit, o.progress);
  options::describe_verbosity(visit, o.verbosity, "Print a line for each run");
  describe_places(visit, o);
  visit.check([&o] {
    if (o.file.empty())
      throw UsageError("sweep", "which sweep?",
                       "give a sweep file, or a scene and -p ADDRESS=LIST");
    if (is_sweep_folder(o.file))
      throw UsageError(
          "sweep", o.file + " is the folder of a sweep, not a scene",
          "name the sweep file or the scene that it was made from; neve sweep collect " +
              shell_path(o.file) + " makes its sheets again");
    if (!o.from && timeline::is_folder(o.file))
      throw UsageError("sweep", o.file + " is a folder, not a scene",
                       "to vary its run from a time on, add --from TIME");
    check_places(o);
    check_seeds(o);
    check_prediction(o);
    check_refinement(o);
  });
}

void describe(options::Command& visit, SweepRunOptions& o) {
  visit.about("sweep run", "Make one run of an existing sweep; --emit and --engine slurm use this");
  visit.other_place = copied_sweep;
  visit("--index", o.index, options::number<int>("N", 0, 1e9, "the number of a run, from 0"),
        "Number of the run");
  visit("--beginning", o.beginning, options::text("N", "2"),
        "Make the common beginning of a sweep with --fork instead of a run: of the N-th seed, or "
        "without N those of all seeds")
      .or_alone("all")
      .excludes({"--index"}, "give one of the two");
  describe_retry(visit, o.retry_failed,
                 "Repeat the run if it failed before, or ended in one of these states, as in "
                 "--retry-failed=timeout,crashed");
  options::describe_caps(visit, o.caps);
  describe_folder(visit, o);
  visit.check([&o] {
    if (!o.index && o.beginning.empty())
      throw UsageError("sweep run", "which run?", "give --index N, or --beginning");
  });
}

void describe(options::Command& visit, CollectOptions& o) {
  visit.about("sweep collect", "Make table, sheets and report from the finished runs of a sweep");
  visit.other_place = copied_sweep;
  options::describe_movie(visit, o.movie);
  visit("--review", o.has_review, review_help);
  describe_folder(visit, o);
}

}  // namespace neve::app::sweep::plan
