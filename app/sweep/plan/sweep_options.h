#pragma once
/// Command line options of a sweep.

#include <optional>
#include <string>
#include <vector>

#include "app/options/option.h"
#include "app/output/movie_format.h"
#include "app/setup/caps.h"
#include "app/setup/plan.h"
#include "app/support/progress.h"
#include "app/sweep/plan/selection.h"

namespace neve::app::sweep::plan {

struct SweepOptions {
  std::string file;                    ///< a sweep file or a scene
  std::string text;                    ///< of the file, where it is not written; "": it is read
  std::vector<std::string> axes;       ///< -p
  std::vector<std::string> overrides;  ///< --set
  std::optional<setup::FrameRange> frames;
  std::optional<double> fork;              ///< s, time at which the runs fork
  std::optional<double> from;              ///< the same, of the run or picture in `file`
  int seeds = 0;                           ///< runs of each point; 0: those of the file
  bool keeps_states = false;               ///< of drawn frames, to draw them again
  std::optional<scene::PictureSize> size;  ///< of a tile
  std::string view;                        ///< on the tiles; "": that of the file
  int wrap = 0;                            ///< tiles side by side; 0: as the file has it
  setup::Quality quality = setup::Quality::preview;
  std::optional<double> coarsening;
  bool is_fast = false;         ///< with the settings of forecast::fast_look
  bool predicts = false;        ///< each point at full resolution, by further copies
  int refine = 0;               ///< points that are made at full resolution as well; 0: none
  std::string refine_runs;      ///< "3,7": the same of these runs' points; "": none
  std::string best = "spread";  ///< metric by which points are refined, see store::Best
  std::string out;
  int threads = 0;  ///< cores in all; 0: as many as there are
  int jobs = 0;     ///< runs side by side; 0: as many as keep the cores busy
  setup::CapTexts caps;
  std::string backend = "auto";
  std::string retry_failed;  ///< "all", or states as in "timeout,crashed"; "": none
  std::optional<Shard> shard;
  std::string only;                 ///< "3,7-12"; "": all
  std::string engine = "local";     ///< local | slurm
  std::vector<std::string> sbatch;  ///< further options of sbatch
  output::MovieStyle movie;         ///< of the sheet
  bool has_review = false;          ///< links to all pictures, in DIR/review
  double budget = 0;                ///< s for all runs; 0: as long as they take
  std::string emit;                 ///< file for the commands of the runs; nothing is started
  Verbosity verbosity = Verbosity::normal;
  ProgressOptions progress{};
  bool is_agreed = false;  ///< to what a picture that came alone costs and reads
  bool is_dry_run = false;
  int rounds = 1;  ///< of a search that are to come, each of so many runs
  bool is_json = false;
};

/// Advice of commands that write into the folder of a sweep, and nowhere else.
inline constexpr const char* copied_sweep = "copy the sweep to a folder that may be written";

/// Options for one run of an existing sweep.
struct SweepRunOptions {
  std::string folder;  ///< of the sweep
  std::optional<int> index;
  std::string beginning;  ///< "all", or "2": common beginnings of forked runs, instead of a run
  int threads = 0;        ///< 0: as many as there are
  setup::CapTexts caps;
  std::string backend = "auto";
  std::string retry_failed;  ///< "all", or states as in "timeout,crashed"; "": none
  bool is_json = false;
  Verbosity verbosity = Verbosity::normal;
  ProgressOptions progress{};
};

struct CollectOptions {
  std::string folder;  ///< of a sweep
  output::MovieStyle movie;
  bool has_review = false;  ///< links to all pictures, in DIR/review
  std::string backend = "auto";
  int threads = 0;
  bool is_json = false;
  Verbosity verbosity = Verbosity::normal;
  ProgressOptions progress{};
};

/// Describes the options for the view and the quality of tiles.
void describe_tiles(options::Command& visit, SweepOptions& options);

/// The number of runs of a point.
options::Language<int> seeds();

/// neve sweep
void describe(options::Command& visit, SweepOptions& options);
/// neve sweep run
void describe(options::Command& visit, SweepRunOptions& options);
/// neve sweep collect
void describe(options::Command& visit, CollectOptions& options);

}  // namespace neve::app::sweep::plan
