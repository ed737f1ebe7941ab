#include "app/bench/sweep_bench.h"

#include "app/bench/measure.h"
#include "app/bench/scratch_folder.h"
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

struct Round {
  double cores_busy = 0, overhead = 0;
};

/// Seconds that a run spent on simulating and drawing.
double seconds_of_work(const std::filesystem::path& folder, const sweep::Run& run) {
  double seconds = 0;
  for (const record::FrameRecord& frame :
       record::read_frame_records(sweep::store::runs_folder(folder) / run.folder))
    seconds += frame.seconds_sim + frame.seconds_render;
  return seconds;
}

Round measure_round(const BenchOptions& options, int cores, int run_count, Progress& progress) {
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
  return {result.core_seconds / (cores * result.seconds), overhead / run_count};
}

}  // namespace

std::vector<BenchRow> bench_sweep(const BenchOptions& options, Progress& progress) {
  progress.note("neve bench sweep");
  const int cores = core_count(options.threads);
  const int rounds = options.rounds > 0 ? options.rounds : options.is_quick ? 1 : 3;
  const int runs = options.is_quick ? 2 * cores : 12 * cores;
  std::vector<double> busy, overhead;
  for (int k = 0; k < rounds; ++k) {
    const Round round = measure_round(options, cores, runs, progress);
    busy.push_back(100 * round.cores_busy);
    overhead.push_back(round.overhead);
  }
  const auto row = [&](const char* name, const std::vector<double>& samples, const char* unit) {
    BenchRow result;
    result.name = name;
    result.threads = cores;
    result.particles = 4500;
    result.simd = sim::kernels::name(sim::kernels::chosen_simd_level());
    result.value = statistics_of(samples);
    result.unit = unit;
    return result;
  };
  return {row("cores_busy", busy, "%"), row("overhead_per_run", overhead, "s")};
}

}  // namespace neve::app::bench
