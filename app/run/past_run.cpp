#include "app/run/past_run.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "app/output/atomic_file.h"
#include "app/output/checkpoint.h"
#include "app/output/sequence.h"
#include "app/run/render_job.h"
#include "app/scene/read.h"
#include "app/support/errors.h"
#include "app/support/version.h"

namespace neve::app::run {

namespace fs = std::filesystem;

bool is_folder(const std::string& path) {
  std::error_code error;
  return !path.empty() && fs::is_directory(path, error);
}

RenderJob job_from_run(const RenderOptions& options) {
  if (!options.overrides.empty() || options.coarsening || options.is_fast)
    throw UsageError(!options.overrides.empty() ? "--set"
                     : options.coarsening       ? "--coarsen"
                                                : "--fast",
                     "a run has the scene it was made from",
                     "give the scene file instead of the folder to write another run");
  const fs::path file = output::run_json_path(options.scene);
  RenderJob job;
  try {
    const Json run = parse_json(output::read_file(file));
    job.scene =
        scene::read_scene_text(run.at("scene").get<std::string>(), file.string() + " (its scene)");
    job.changes = scene::live_changes(run.value("changes", Json::array()));
    job.overrides = run.value("overrides", std::vector<std::string>{});
    job.coarsening = run.value("coarsen", 1.0);
  } catch (const nlohmann::json::exception&) {
    throw Error(exit_invalid_scene, file.string() + ": error: is not a run.json of neve",
                file.string());
  }
  job.scene_file = options.scene;
  job.folder = options.out.empty() ? fs::path(options.scene) : fs::path(options.out);
  job.frames = options.frames.value_or(setup::FrameRange{0, job.scene.frames});
  return job;
}

namespace {

/// The newest kept state that is not later than a frame.
std::optional<ResumedRun> state_before(const fs::path& folder, int last, const std::string& simd) {
  const std::vector<int> frames = output::kept_states(folder);
  for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame) {
    if (*frame > last) continue;
    const output::FoundState found = output::read_state(folder, *frame);
    if (found.checkpoint && found.checkpoint->simd == simd)
      return read_resumed_run(*found.checkpoint);
  }
  return std::nullopt;
}

}  // namespace

std::optional<ResumedRun> checkpoint_before(const PastRun& past, double time, double fps,
                                            const sim::Simulation& simulation) {
  if (past.folder.empty()) return std::nullopt;
  if (read_run_json(past.folder).value("version", "") != version) return std::nullopt;
  const double latest = time * (1 + 1e-12);
  int before = static_cast<int>(std::min(std::floor(latest * fps), 1e9)) + 1;
  std::optional<ResumedRun> kept = state_before(past.folder, before - 1, simulation.simd());
  for (;;) {
    const output::FoundCheckpoint found = output::find_checkpoint(past.folder, before);
    if (!found.checkpoint || found.checkpoint->simd != simulation.simd()) return kept;
    ResumedRun run = read_resumed_run(*found.checkpoint);
    if (kept && kept->steps >= run.steps) return kept;
    // One of an interrupted run may hold steps beyond its frame.
    if (run.frame / fps + run.advance.seconds <= latest) return run;
    before = run.frame;
  }
}

void go_to_checkpoint(const ResumedRun& checkpoint, double fps, ChangePlayer& player,
                      sim::Simulation& simulation) {
  try {
    player.go_to(checkpoint.steps);
    restore_frame(checkpoint, fps, simulation);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse_checkpoint(checkpoint.file, error);
  }
}

void compare_with_past(const PastRun& past, int frame, std::uint64_t hash, Progress& progress) {
  for (const FrameRecord& record : past.frames)
    if (record.frame == frame && record.state_hash != hash)
      progress.warning("frame " + std::to_string(frame) + " has another state than the run in " +
                       past.folder.string() +
                       ": its bits came from another version or other instructions, or files that "
                       "the scene names have changed");
}

}  // namespace neve::app::run
