#pragma once
/// One function per subcommand, and what the command line tells it. Each returns an exit code.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/plan.h"
#include "app/progress.h"
#include "app/sweep/selection.h"
#include "sim/math.h"
#include "sim/stage.h"

namespace neve::app {

struct RenderOptions {
  std::string scene;  ///< a scene file or a picture; empty: the default scene
  std::vector<std::string> overrides;
  std::optional<double> coarsening;
  std::optional<FrameRange> frames;
  std::vector<std::string> views;
  std::optional<PictureSize> size;
  std::string out;
  int threads = 0;  ///< 0: one per core
  std::string backend = "auto";
  std::optional<Quality> quality;
  std::string reference;
  double reference_threshold = 0.5;  ///< of the mean difference, 0 to 255
  /// Of the mean over any 8x8 pixels: small snow that is somewhere else changes the picture's mean
  /// by little. Rounding of other drivers stays far below it.
  double reference_local_threshold = 8;
  std::string shader_dir;
  bool is_validated = false;
  bool is_resumed = false;
  int checkpoint_every = 10;  ///< frames; 0: none
  bool has_movies = true;
  Verbosity verbosity = Verbosity::normal;
  bool is_dry_run = false;
  bool is_json = false;
};

struct SweepOptions {
  std::string file;                    ///< a sweep file or a scene
  std::vector<std::string> axes;       ///< -p
  std::vector<std::string> overrides;  ///< --set
  std::optional<FrameRange> frames;
  std::optional<PictureSize> size;  ///< of a tile
  std::optional<double> coarsening;
  std::string out;
  int threads = 0;  ///< cores in all; 0: as many as there are
  int jobs = 0;     ///< runs side by side; 0: as many as keep the cores busy
  std::string backend = "auto";
  bool is_failed_again = false;
  std::optional<Shard> shard;
  std::string only;                 ///< "3,7-12"; "": all
  std::string engine = "local";     ///< local | slurm
  std::vector<std::string> sbatch;  ///< further options of sbatch
  std::string emit;                 ///< file for the commands of the runs; nothing is started
  Verbosity verbosity = Verbosity::normal;
  bool is_dry_run = false;
  bool is_json = false;
};

/// Of one run of a sweep that is on disk already.
struct SweepRunOptions {
  std::string folder;  ///< of the sweep
  int index = 0;
  int threads = 0;  ///< 0: as many as there are
  std::string backend = "auto";
  bool is_failed_again = false;
  Verbosity verbosity = Verbosity::normal;
};

struct CollectOptions {
  std::string folder;  ///< of a sweep
  std::string backend = "auto";
  int threads = 0;
  Verbosity verbosity = Verbosity::normal;
};

enum class DumpFormat { table, vtk };

/// A particle by its id, or what is nearest to a place.
using Probe = std::variant<std::size_t, sim::Vec3d>;

struct DumpOptions {
  RenderOptions run;                ///< scene, overrides, coarsening, threads, verbosity, is_json
  double at = 0;                    ///< s
  std::optional<sim::Stage> stage;  ///< without: the state before the step
  std::vector<std::string> fields;  ///< empty: all
  std::vector<Probe> probes;
  DumpFormat format = DumpFormat::table;
  std::string file;  ///< empty: standard output
};

struct ViewOptions {
  RenderOptions run;  ///< scene, overrides, coarsening, threads, views, size, out, backend
  bool is_web = false, is_window = false;  ///< neither: whichever fits
  std::string listen;                      ///< address of the page; empty: this machine alone
  int port = 0;                            ///< of the page; 0: a free one
  bool is_running = false;                 ///< from the start
  std::string replay, record;              ///< files of scripts
  int pictures = 0;                        ///< ends after so many; 0: never
  std::uint64_t kept_memory = 0;           ///< bytes for kept frames; 0: a quarter of what is free
};

struct CompareOptions {
  std::string a, b;
  double threshold = 0;          ///< of the mean difference, 0 to 255
  double local_threshold = 255;  ///< of the mean over any 8x8 pixels
  bool is_json = false;
};

struct BenchOptions {
  int rounds = 0;        ///< 0: as many as are usual
  double particles = 0;  ///< 0: the common case, or the end of the curve
  bool is_curve = false;
  int threads = 0;  ///< 0: one per core
  std::string backend = "auto";
  bool is_quick = false;
  bool is_json = false;
  bool is_markdown = false;
};

int run_render(const RenderOptions& options);
/// Reads only what says which scene: scene, overrides, coarsening, threads.
int run_check(const RenderOptions& options);
int run_dump(const DumpOptions& options);
int run_view(const ViewOptions& options);
int run_compare(const CompareOptions& options);
int run_bench_sim(const BenchOptions& options);
int run_bench_frame(const BenchOptions& options);
int run_bench_render(const BenchOptions& options);
int run_bench_sweep(const BenchOptions& options);
int run_bench_view(const BenchOptions& options);
int run_info(const std::string& path, bool is_json);
int run_doctor(bool is_json);
/// @param filter  only addresses with this in them; "" for all
/// @throws UsageError when there is none
int run_params(const std::string& filter, bool is_sweep, bool is_json);
int run_sweep(const SweepOptions& options);
int run_sweep_run(const SweepRunOptions& options);
int run_sweep_collect(const CollectOptions& options);

}  // namespace neve::app
