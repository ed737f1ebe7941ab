#include "app/bench/bench.h"

#include "app/bench/measure.h"
#include "app/output/atomic_file.h"
#include "app/record/run_json.h"
#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/sweep/jobs/local.h"
#include "app/sweep/plan/shared_view.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/sweep/plan/sweep_plan.h"
#include "app/sweep/store/prepare.h"
#include "app/sweep/store/store.h"
#include "sim/kernels/simd.h"

namespace neve::app::bench {

namespace {

/// A few thousand particles: a second of work each, as small as runs of sweeps are.
constexpr const char* scene_text = R"(
title = "bench"
frames = 6
[solver]
cell_size = 0.03
[[body]]
shape = { sphere = { center = [0, 0.2, 0], radius = 0.16 } }
velocity = [0, -3, 0]
[[collider]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[view]]
name = "particles"
[output]
size = [480, 270]
)";

/// Seconds that a run spent on simulating and drawing.
double seconds_of_work(const std::filesystem::path& folder, const sweep::Run& run) {
  double seconds = 0;
  for (const record::FrameRecord& frame :
       record::read_frame_records(sweep::store::runs_folder(folder) / run.folder))
    seconds += frame.seconds_sim + frame.seconds_render;
  return seconds;
}

void measure_round(const BenchOptions& options, int cores, int run_count, Progress& progress,
                   RowSamples& rows) {
  const ScratchFolder scratch;
  output::write_file(scratch.path() / "scene.toml", scene_text);
  sweep::plan::SweepOptions sweep;
  sweep.file = (scratch.path() / "scene.toml").string();
  sweep.axes = {"seed={ range = [1, " + std::to_string(run_count) + "] }"};
  sweep.out = (scratch.path() / "out").string();
  sweep::plan::SweepPlan plan = sweep::plan::plan_sweep(sweep);
  sweep::plan::share_camera_and_ranges(plan, cores);
  const sweep::store::Manifest manifest = sweep::store::prepare_sweep(plan);
  sweep::jobs::LocalOptions engine;
  engine.cores = cores;
  engine.backend = options.backend;
  engine.program = this_program();
  std::vector<int> all;
  for (const sweep::Run& run : manifest.runs) all.push_back(run.index);
  const sweep::jobs::JobsResult result =
      sweep::jobs::run_local(plan.folder, manifest, all, engine, progress);
  stop_if_interrupted();
  if (result.failed > 0) throw Error(exit_internal, "a run of the bench failed");
  double overhead = 0;
  for (const sweep::Run& run : manifest.runs)
    overhead +=
        sweep::store::read_status(sweep::store::runs_folder(plan.folder) / run.folder).seconds -
        seconds_of_work(plan.folder, run);
  const auto add = [&](const char* name, double sample, const char* unit) {
    rows.add({name, cores, 4500, sim::kernels::name(sim::kernels::chosen_simd_level()), {}, unit},
             sample);
  };
  add("cores_busy", 100 * result.core_seconds / (cores * result.seconds), "%");
  add("overhead_per_run", overhead / run_count, "s");
}

}  // namespace

std::vector<BenchRow> bench_sweep(const BenchOptions& options, Progress& progress) {
  progress.note("neve bench sweep");
  const int cores = core_count(options.threads);
  RowSamples rows;
  for (int k = 0; k < options.rounds_or(1, 3); ++k)
    measure_round(options, cores, options.is_quick ? 2 * cores : 12 * cores, progress, rows);
  return rows.rows();
}

}  // namespace neve::app::bench
