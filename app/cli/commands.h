#pragma once
/// Per subcommand a function that describes its options, where no other part of the program does,
/// and one that runs it and returns an exit code.

#include <string>
#include <vector>

#include "app/compare/pair_options.h"
#include "app/dump/dump_options.h"
#include "app/options/option.h"
#include "app/pick/pick_options.h"
#include "app/run/export_run.h"
#include "app/run/render_options.h"
#include "app/run/strip_run.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/view/view_options.h"

namespace neve::app::cli {

struct CompareOptions {
  double threshold = 0;          ///< of the mean difference, 0 to 255
  double local_threshold = 255;  ///< of the mean over any 8x8 pixels
  bool is_json = false;
  compare::PairOptions pictures;  ///< or folders of runs; without out none are drawn
};

/// `neve export` takes a run, and what all formats have in common.
struct ExportCommand {
  run::RenderOptions run;
  std::vector<double> at;
  std::vector<scene::ExportFormat> formats;
  scene::Export common;
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
int run_check(const run::RenderOptions& options);
int run_dump(const dump::DumpOptions& options);
int run_strip_command(const run::StripOptions& options);
int run_export(const ExportCommand& command);
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

void describe_new(options::Command& visit, PlainOptions& o);
void describe_info(options::Command& visit, PlainOptions& o);
void describe_verify(options::Command& visit, PlainOptions& o);
void describe_doctor(options::Command& visit, PlainOptions& o);
void describe_schema(options::Command& visit, PlainOptions& o);
void describe_manual(options::Command& visit, PlainOptions& o);
void describe_version(options::Command& visit, PlainOptions& o);
void describe_help(options::Command& visit, PlainOptions& o);
void describe_params(options::Command& visit, ParamsOptions& o);

void describe_check(options::Command& visit, run::RenderOptions& o);
void describe_dump(options::Command& visit, dump::DumpOptions& o);
void describe_export(options::Command& visit, ExportCommand& o);
void describe_strip(options::Command& visit, run::StripOptions& o);
void describe_compare(options::Command& visit, CompareOptions& o);
void describe_pick(options::Command& visit, PickCommand& o);
void describe_view(options::Command& visit, view::ViewOptions& o);

}  // namespace neve::app::cli
