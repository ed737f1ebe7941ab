#pragma once
/// One function per subcommand. Each returns an exit code.

#include <string>

#include "app/bench/bench_options.h"
#include "app/compare/pair_options.h"
#include "app/dump/dump_options.h"
#include "app/pick/pick_options.h"
#include "app/run/export_run.h"
#include "app/run/render_options.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/view/view_options.h"

namespace neve::app::cli {

struct CompareOptions {
  std::string a, b;
  double threshold = 0;          ///< of the mean difference, 0 to 255
  double local_threshold = 255;  ///< of the mean over any 8x8 pixels
  bool is_json = false;
  compare::PairOptions pictures;  ///< its a and b are those above; without out: none
};

struct ParamsOptions {
  std::string filter;      ///< "" for all
  bool is_sweep = false;   ///< parameters of sweep files
  bool is_wishes = false;  ///< the table from wishes to parameters
  bool is_markdown = false;
  bool is_json = false;
};

int run_render(const run::RenderOptions& options);
/// Reads only the options that choose the scene: scene, overrides, coarsening, threads.
int run_check(const run::RenderOptions& options);
int run_dump(const dump::DumpOptions& options);
int run_export_command(const run::ExportOptions& options);
int run_view(const view::ViewOptions& options);
int run_compare(const CompareOptions& options);
int run_bench_sim(const bench::BenchOptions& options);
int run_bench_frame(const bench::BenchOptions& options);
int run_bench_render(const bench::BenchOptions& options);
int run_bench_sweep(const bench::BenchOptions& options);
int run_bench_scenes(const bench::BenchOptions& options);
int run_bench_surface(const bench::BenchOptions& options);
int run_bench_view(const bench::BenchOptions& options);
int run_info(const std::string& path, bool is_json);
/// @param folder  of a run or a sweep
/// @param is_quiet  print only what is wrong
int run_verify(const std::string& folder, bool is_quiet, bool is_json);
int run_doctor(bool is_json);
/// @throws UsageError if nothing has the filter in it
int run_params(const ParamsOptions& options);
int run_sweep(const sweep::plan::SweepOptions& options);
int run_sweep_run(const sweep::plan::SweepRunOptions& options);
int run_sweep_collect(const sweep::plan::CollectOptions& options);
int run_pick(const pick::PickOptions& options, const view::ScreenOptions& screen);

}  // namespace neve::app::cli
