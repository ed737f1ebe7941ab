#pragma once
/// One function per subcommand. Each returns an exit code.

#include <string>
#include <vector>

#include "app/compare/pair_options.h"
#include "app/dump/dump_options.h"
#include "app/pick/pick_options.h"
#include "app/run/export_run.h"
#include "app/run/render_options.h"
#include "app/run/strip_run.h"
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

/// `neve export` takes a run, and what all formats have in common.
struct ExportCommand {
  run::RenderOptions run;
  std::vector<double> at;
  std::vector<scene::ExportFormat> formats;
  scene::Export common;
};

struct CheckCommand {
  run::RenderOptions run;
  bool predicts = false;  ///< by coarse copies that run to the end
};

struct PickCommand {
  pick::PickOptions pick;
  view::ScreenOptions screen;
};

/// Some commands take little: new, info, verify, doctor, schema, manual, version, help.
struct PlainOptions {
  std::string name;                ///< of a file or folder, or a kind
  std::vector<std::string> names;  ///< of commands
  bool is_quiet = false;
  bool is_json = false;
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
int run_check(const CheckCommand& command);
int run_dump(const dump::DumpOptions& options);
int run_strip_command(const run::StripOptions& options);
int run_export_command(const run::ExportOptions& options);
int run_view(const view::ViewOptions& options);
int run_compare(const CompareOptions& options);
int run_info(const PlainOptions& options);
int run_verify(const PlainOptions& options);
int run_doctor(const PlainOptions& options);
int run_new(const PlainOptions& options);
int run_schema(const PlainOptions& options);
/// @throws UsageError if nothing has the filter in it
int run_params(const ParamsOptions& options);
int run_sweep(const sweep::plan::SweepOptions& options);
int run_sweep_run(const sweep::plan::SweepRunOptions& options);
int run_sweep_collect(const sweep::plan::CollectOptions& options);
int run_pick(const PickCommand& command);

}  // namespace neve::app::cli
