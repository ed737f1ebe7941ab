#include "app/run/export_run.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "app/output/atomic_file.h"
#include "app/output/checkpoint.h"
#include "app/output/folder_lock.h"
#include "app/output/picture_writer.h"
#include "app/output/sequence.h"
#include "app/run/picture_record.h"
#include "app/run/resumed_run.h"
#include "app/run/run_json.h"
#include "app/run/walk.h"
#include "app/scene/check.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/version.h"

namespace neve::app::run {

namespace {

namespace fs = std::filesystem;

/// The job of a run that exists, from its run.json.
RenderJob job_from_run(const RenderOptions& options) {
  if (!options.overrides.empty() || options.coarsening || options.is_fast)
    throw scene::toml::UsageError(!options.overrides.empty() ? "--set"
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

bool is_folder(const std::string& path) {
  std::error_code error;
  return !path.empty() && fs::is_directory(path, error);
}

/// Problems of the exports of the command line, as those of a scene file are found.
void check_exports(const scene::Scene& scene) {
  const std::optional<scene::Problem> problem = scene::find_problem(scene);
  if (!problem) return;
  std::string flag = "--body";
  for (const char* key : {"attributes", "format", "surface"})
    if (problem->address.ends_with(std::string(".") + key)) flag = std::string("--") + key;
  if (problem->address.ends_with(".carried")) flag = "--attributes";
  throw scene::toml::UsageError(flag, problem->message, problem->hint);
}

/// Brings the simulation to the newest checkpoint of a run, where that is not too late and fits.
/// @return its frame; 0: the start
int go_to_checkpoint(const ExportJob& job, ChangePlayer& player, sim::Simulation& simulation,
                     Progress& progress) {
  if (job.run_folder.empty()) return 0;
  const double first = std::floor(job.times.front() * job.run.scene.fps * (1 + 1e-12));
  const output::FoundCheckpoint found =
      output::find_checkpoint(job.run_folder, static_cast<int>(std::min(first, 1e9)) + 1);
  if (!found.checkpoint) return 0;
  const output::Checkpoint& checkpoint = *found.checkpoint;
  const bool is_ours = read_run_json(job.run_folder).value("version", "") == version;
  if (!is_ours || checkpoint.simd != simulation.simd()) return 0;
  const ResumedRun run = read_resumed_run(checkpoint);
  try {
    player.go_to(run.steps);
    restore_frame(run, job.run.scene.fps, simulation);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse_checkpoint(run.file, error);
  }
  progress.note("continues from the checkpoint of frame " + std::to_string(checkpoint.frame));
  return checkpoint.frame;
}

/// Cameras that frame the snow, for formats that have cameras.
void place_camera(scene::Scene& scene) {
  const bool has_camera =
      std::any_of(scene.exports.begin(), scene.exports.end(),
                  [](const scene::Export& e) { return e.format == scene::ExportFormat::usda; });
  if (has_camera && setup::needs_framing(scene))
    setup::resolve_cameras(scene, setup::coarse_run(scene));
}

/// A run in a folder and this one have to be the same: its frames have hashes.
void compare_with_run(const ExportJob& job, int frame, std::uint64_t hash, Progress& progress) {
  for (const FrameRecord& record : job.run_frames)
    if (record.frame == frame && record.state_hash != hash)
      progress.warning("frame " + std::to_string(frame) + " has another state than the run in " +
                       job.run_folder.string() +
                       ": its bits came from another version or other instructions, or files that "
                       "the scene names have changed");
}

void write_list(const ExportJob& job, const ExportResult& result,
                const std::vector<output::WrittenFile>& written) {
  FileHashes files;
  for (const output::WrittenFile& file : written)
    files[file.file.lexically_relative(job.run.folder).generic_string()] = hash_text(file.hash);
  Json json;
  json["version"] = version;
  json["scene_file"] = job.run.scene_file;
  json["fps"] = job.run.scene.fps;
  json["is_whole"] = result.is_whole;
  json["exports"] = result.exports;
  json["files"] = files;
  output::write_file(output::export_list_path(job.run.folder), with_own_hash(json));
}

void remove_earlier_list(const fs::path& folder) {
  std::error_code error;
  const fs::path file = output::export_list_path(folder);
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return;
  try {
    exports::remove_earlier_exports(folder, parse_json(output::read_file(file)).at("exports"));
  } catch (const IoError&) {
    throw;  // files of an earlier export would lie beside the new ones
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    // No list of ours: nothing is removed.
  }
}

}  // namespace

ExportJob make_export_job(const ExportOptions& options) {
  ExportJob job;
  const bool is_run = is_folder(options.run.scene);
  job.run = is_run ? job_from_run(options.run) : make_job(options.run);
  if (is_run) {
    job.run_folder = options.run.scene;
    job.run_frames = read_frame_records(job.run_folder);
  }
  job.lock_folder = job.run.folder;
  if (options.run.out.empty()) job.run.folder /= output::exports_folder;
  job.run.scene.exports = options.exports;
  check_exports(job.run.scene);
  job.are_frames = options.at.empty();
  if (!job.are_frames) {
    job.times = options.at;
    const double last = std::ceil(job.times.back() * job.run.scene.fps);
    job.run.frames = {0, static_cast<int>(std::min(last, 1e9))};
    return job;
  }
  job.first_number = job.run.frames.first;
  for (int frame = job.run.frames.first; frame <= job.run.frames.last; ++frame)
    job.times.push_back(frame / job.run.scene.fps);
  return job;
}

ExportResult run_export(const ExportJob& job, int threads, Progress& progress) {
  const output::FolderLock lock(job.lock_folder, "neve export");
  scene::Scene scene = job.run.scene;
  place_camera(scene);
  const setup::SeededScene seeded = setup::seed_scene(scene);
  sim::Simulation simulation = setup::make_simulation(scene, seeded.particles, threads);
  ChangePlayer player(scene, job.run.changes, simulation);
  player.begin();
  Walk walk(scene.fps, simulation, player, progress,
            go_to_checkpoint(job, player, simulation, progress));
  output::make_folder(job.run.folder);
  remove_earlier_list(job.run.folder);
  exports::Exporter exporter(scene, job.run.folder, seeded.body_end);
  output::PictureWriter writer;
  ExportResult result;
  progress.start(static_cast<int>(std::floor(job.times.back() * scene.fps * (1 + 1e-12))));
  for (const double time : job.times) {
    if (!walk.go_to(time)) break;
    const int number = job.first_number + static_cast<int>(result.moments++);
    scene::Scene now = player.scene();
    follow_colliders(simulation, now);
    if (job.are_frames) compare_with_run(job, number, simulation.state_hash(), progress);
    for (exports::Exporter::Work& work : exporter.add(now.colliders, simulation, number, false))
      writer.write(std::move(work));
  }
  writer.finish();
  std::vector<output::WrittenFile> written = writer.take_written();
  for (output::WrittenFile& file : exporter.finish()) written.push_back(std::move(file));
  progress.clear();
  result.is_whole = result.moments == job.times.size();
  result.divergence = simulation.divergence();
  result.exports = exporter.to_json("");
  write_list(job, result, written);
  return result;
}

}  // namespace neve::app::run
