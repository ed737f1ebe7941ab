#pragma once
/// DIR/manifest.json: the sweep as it was expanded. All that results are put together from, besides
/// the folders of the runs.

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/run/render_options.h"
#include "app/support/json.h"
#include "app/sweep/plan/labels.h"

namespace neve::app::sweep::store {

/// "run 1", which --only and --index mean, with its folder where that has another number:
/// "run 1 (runs/0010)"
std::string run_text(const Run& run);

/// Writes settings as files and pages have them: an address and a value each.
Json settings_json(const std::vector<scene::Override>& settings);

/// An axis as the edge of the sheet names it.
struct AxisLabels {
  std::string name;                      ///< may be empty
  std::vector<std::string> values;       ///< texts, with units
  std::vector<std::string> addresses{};  ///< of the parameters that it sets
  /// The shares of a screening, see plan::level_shares(); files from before them have none.
  std::vector<double> shares{};
};

/// The common beginning of runs that fork later than at the start, one for each seed.
struct Beginning {
  double time = 0;  ///< s, where the runs fork
  /// The runs end with the last frame before the fork; see beginning_folder() for their place.
  std::vector<Run> runs{};
  std::string source{};  ///< run or picture that it was taken from; "": simulated from the start

  /// Returns the beginning with the seed of a run.
  const Run& run_of(const Run& branch) const {
    return runs[static_cast<std::size_t>(branch.index) % runs.size()];
  }
  /// The command that forks a run from it. @param folder  of the sweep, as the command sees it
  run::RenderOptions fork_of(const Run& branch, const std::string& folder) const;
};

/// A point once more, with cells of another size: a coarse copy by which it is predicted, or its
/// run at full resolution.
struct Variant {
  Run run;  ///< its number follows those of the sweep's runs; its folder is one of theirs
  std::size_t of = 0;  ///< the run that it is at full resolution; of a copy the first of the point
  double coarsening = 1;
  std::string failure;  ///< why there can be none, a sentence; the run is empty then

  bool is_full() const { return coarsening == 1 && failure.empty(); }
};

/// The star and the note that a person gave to a run, see stars.h.
struct Mark {
  bool has_star = false;
  std::string note{};
  bool is_given() const { return has_star || !note.empty(); }
};
using Marks = std::map<int, Mark>;  ///< by the number of the run

struct Manifest {
  std::string sources;  ///< of the program, see Build; "" in files of before they had it
  std::string version, name, title, sweep_file, scene_file, view;
  int tile_width = 480, tile_height = 270;
  double fps = 24;       ///< of runs that set none
  int first_number = 0;  ///< of the frame at time 0
  double fps_of(const Run& run) const;
  /// False where a frame of one run is at another time than the same frame of another.
  bool has_one_rate() const;
  /// s, of runs that set no rate.
  double time_of(int number) const { return (number - first_number) / fps; }
  int columns = -1, rows = -1;  ///< axes asked for; -1: automatic
  int wrap = 0;
  std::string tile_label;  ///< differences, name, none
  double timeout = 0, memory = 0;
  std::vector<Parameter> parameters;
  std::vector<AxisLabels> axes;  ///< of a grid
  /// Axes of a screening, without values; its runs have their levels as coordinates.
  std::vector<AxisLabels> screened{};
  /// Addresses of all axes, for any method; sorted. Older files have none.
  std::optional<std::vector<std::string>> varied;
  std::vector<Run> runs;
  std::vector<Variant> variants{};
  double coarsening = 1;    ///< of the runs
  std::string coarsened{};  ///< "coarsened 2x, thresholds for cells of 0.02 m"; "" of other sweeps
  /// Runs of each point, which follow each other and differ in their seed alone.
  int seeds = 1;
  /// The distance from the number of a run to that of the next one: more than 1 where some runs of
  /// each point are omitted, see first_draws(). No file has it.
  int apart = 1;
  std::size_t place_of(const Run& run) const { return static_cast<std::size_t>(run.index / apart); }
  double seconds_per_work = 0;  ///< s of one thread, by the forecast; 0: not known
  std::optional<Beginning> beginning{};
  bool keeps_states = false;        ///< of drawn frames
  bool have_tiles_legends = false;  ///< see plan::SweepPlan
  setup::Quality quality = setup::Quality::preview;
  /// The changes of the scene in all runs, beside --coarsen and --fast.
  std::vector<scene::Override> fixed{};
  Marks marks{};             ///< in a file of their own
  std::string scene_hash{};  ///< record::hash_of() its text; "" where it is not a file

  /// The run of a number, a variant's too; null: there is none.
  const Run* run_of(int index) const;
  int last_index() const;
  /// Returns these runs, the copies of their points, and all runs at full resolution: they were
  /// chosen by themselves.
  std::vector<int> with_variants(std::vector<int> indices) const;

  double coarsening_of(const Run& run) const;

  int first_frame() const;
  int last_frame() const;
};

/// @param keys  of the runs, then of the variants @param folders  theirs
Manifest make_manifest(const plan::SweepPlan& plan, const std::vector<std::string>& keys,
                       const std::vector<std::string>& folders);

void write_manifest(const std::filesystem::path& folder, const Manifest& manifest);
/// One sweep in a folder: its table, sheet and report replace those of another.
/// @throws UsageError when the folder has a sweep with axes of other addresses
void check_folder(const plan::SweepPlan& plan);

/// Finished runs in the folder of a sweep that a program with other sources has made: their keys
/// are others now.
std::size_t outdated_runs(const std::filesystem::path& folder);

/// @param file  named in errors @throws Error if it is broken
Manifest parse_manifest(std::span<const std::uint8_t> bytes, const std::string& file);

/// @throws Error if it is missing or broken
Manifest read_manifest(const std::filesystem::path& folder);

}  // namespace neve::app::sweep::store
