#include "app/run/export_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "app/output/atomic_file.h"
#include "app/output/folder_lock.h"
#include "app/output/json_file.h"
#include "app/output/picture_writer.h"
#include "app/output/sequence.h"
#include "app/record/earlier.h"
#include "app/record/picture_files.h"
#include "app/record/run_json.h"
#include "app/run/identity.h"
#include "app/scene/check.h"
#include "app/scene/coarsen.h"
#include "app/setup/resolve.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "app/timeline/times.h"

namespace neve::app::run {

namespace {

namespace fs = std::filesystem;

/// Problems of the exports of the command line, as those of a scene file are found.
void check_exports(const scene::Scene& scene) {
  const std::optional<scene::Problem> problem = scene::find_problem(scene);
  if (!problem) return;
  std::string flag = "--body";
  for (const char* key : {"attributes", "format", "surface", "dust"})
    if (problem->address.ends_with(std::string(".") + key)) flag = std::string("--") + key;
  if (problem->address.ends_with(".carried")) flag = "--attributes";
  throw UsageError(flag, problem->message, problem->hint);
}

/// Cameras that frame the snow, for formats that have cameras.
void place_camera(scene::Scene& scene) {
  const bool has_camera = std::ranges::find(scene.exports, scene::ExportFormat::usda,
                                            &scene::Export::format) != scene.exports.end();
  if (has_camera) setup::resolve_cameras(scene);
}

const char* out_flag(const ExportJob& job) {
  return job.run.options.out.empty() ? "" : "--out";
}

/// The part of an earlier list that stays: exports of other names, with the hashes of their files.
struct Kept {
  Json exports = Json::array(), files = Json::object();
  std::set<std::string> begun{};  ///< files of exports that were cut off
  bool is_whole = true;
};

/// An earlier list of the folder.
struct Earlier {
  std::string scene_file, simulation;  ///< "": not said
  std::set<std::string> names{};       ///< of all files that it lists, or was to make
  Kept kept;
  Json replaced = Json::array();   ///< exports whose place is taken
  record::FileHashes their_files;  ///< of these, and of those that were cut off
};

/// @throws std::exception for an entry that neve has not written
void keep_export(const Json& one, const record::FileHashes& files, Kept& kept) {
  const std::string folder = one.at("name").get<std::string>() + "/";
  for (const Json& file : one.at("files"))
    for (const char* key : {"file", "number", "time", "state_hash"}) file.at(key);
  for (const auto& [file, hash] : files)
    if (file.starts_with(folder) || one.at("series") == file) kept.files[file] = hash;
  kept.exports.push_back(one);
}

/// Names all that the scene says of its simulation, and its files; another build may have other
/// bits.
std::string simulation_of(const RenderJob& run) {
  return record::hash_of(simulation_text(run.scene) + to_text(scene::to_json(run.changes)) +
                         record::file_lines(run.scene, run.changes));
}

/// @throws std::exception for a list that neve has not written
std::set<std::string> names_in(const Json& list) {
  auto names = list.value("begun", std::set<std::string>());
  for (const auto& [file, hash] : record::file_hashes(list)) names.insert(file);
  for (const Json& one : list.at("exports")) {
    if (one.at("series").is_string()) names.insert(one.at("series"));
    for (const Json& file : one.at("files")) names.insert(file.at("file"));
  }
  return names;
}

/// Exports with the same names, or of another scene, give their place to the new ones.
/// @throws UsageError for a list that cannot be read, unless the options replace it
Earlier earlier_exports(const ExportJob& job) {
  const fs::path file = output::export_list_path(job.run.folder);
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return {};
  const std::vector<scene::Export>& ours = job.run.scene.exports;
  try {
    const Json list = output::read_json(file);
    Earlier earlier;
    earlier.scene_file = list.at("scene_file").get<std::string>();
    earlier.simulation = list.value("simulation", "");
    earlier.their_files = record::files_made(job.run.folder, list);
    earlier.names = names_in(list);
    const bool is_of_scene = record::is_same_path(earlier.scene_file, job.run.scene_file) ||
                             earlier.simulation == simulation_of(job.run);
    for (const Json& one : list.at("exports")) {
      const bool is_ours = std::any_of(ours.begin(), ours.end(), [&](const scene::Export& e) {
        return one.at("name") == scene::folder_of(e);
      });
      if (is_of_scene && !is_ours)
        keep_export(one, record::file_hashes(list), earlier.kept);
      else
        earlier.replaced.push_back(one);
    }
    const auto begun = list.value("begun", std::set<std::string>());
    std::erase_if(earlier.their_files, [&](const auto& item) {
      const std::string& name = item.first;
      if (!is_of_scene || !begun.contains(name)) return earlier.kept.files.contains(name);
      const bool is_ours = std::ranges::any_of(ours, [&](const scene::Export& e) {
        return name.starts_with(scene::folder_of(e) + "/") || name == exports::series_name(e);
      });
      if (!is_ours) earlier.kept.begun.insert(name);
      return !is_ours;
    });
    earlier.kept.is_whole = earlier.kept.begun.empty() &&
                            (earlier.kept.exports.empty() || list.at("is_whole").get<bool>());
    return earlier;
  } catch (const IoError&) {
    throw;  // files of an earlier export would lie beside the new ones
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    if (job.run.options.replaces) return {};  // No list of ours: nothing is removed.
    throw UsageError(out_flag(job),
                     job.run.folder.string() +
                         " has an export.json that neve cannot read as a list of exports, so that "
                         "nothing tells which files are its own",
                     "add --replace, which writes over it, or choose another folder with --out");
  }
}

/// True if two entries of a list say the same of an export, but for its files.
bool has_same_settings(const Json& a, const Json& b) {
  return std::ranges::all_of(
      std::array{"format", "up", "scale", "attributes", "surface", "dust", "bodies"},
      [&](const char* key) { return a.value(key, Json()) == b.value(key, Json()); });
}

bool is_time(const Json& value, double time) {
  return value.is_number() && std::abs(value.get<double>() - time) <= 1e-9;
}

/// A frame of another time has the number now, where the scene begins with another number.
bool has_other_numbers(const Json& before, const ExportJob& job) {
  const scene::Scene& scene = job.run.scene;
  return std::ranges::any_of(before.value("files", Json::array()), [&](const Json& file) {
    const Json number = file.is_object() ? file.value("number", Json()) : Json();
    return !number.is_number() ||
           !is_time(file.value("time", Json()),
                    (number.get<double>() - scene::number_of(scene, 0)) / scene.fps);
  });
}

/// Files of moments are numbered from 0, whatever the moments are.
bool has_other_moments(const Json& before, const ExportJob& job) {
  const Json at = before.value("at", Json());
  if (job.are_frames != !at.is_array()) return true;
  if (job.are_frames) return has_other_numbers(before, job);
  for (std::size_t k = 0; k < at.size(); ++k)
    if (k >= job.times.size() || !is_time(at[k], job.times[k])) return true;
  return false;
}

std::set<std::string> files_to_write(const ExportJob& job) {
  std::set<std::string> names;
  for (const scene::Export& e : job.run.scene.exports) {
    const std::string folder = scene::folder_of(e) + "/", series = exports::series_name(e);
    if (!series.empty()) names.insert(series);
    if (e.format == scene::ExportFormat::usda) names.insert(folder + "manifest.usda");
    for (std::size_t k = 0; k < job.times.size(); ++k)
      names.insert(folder + exports::file_name(e, job.first_number + static_cast<int>(k)));
  }
  return names;
}

/// An export that is made again, or continued after an interruption, loses nothing: its files are
/// made again. All else that would go needs --replace.
/// @param ours  of the new exports, as in export.json
void refuse_lost_exports(const ExportJob& job, const Earlier& earlier, const Json& ours) {
  if (job.run.options.replaces) return;
  // Files are read only where there is something to refuse.
  const auto refuse = [&](const std::string& what, const record::FileHashes& lost) {
    const std::vector<std::string> files = record::unchanged_files(job.run.folder, lost);
    if (files.empty()) return;
    throw UsageError(out_flag(job),
                     fmt::format("{} has {}; it would replace {}", job.run.folder.string(), what,
                                 record::files_text(files)),
                     "add --replace, or choose another folder with --out");
  };
  const record::FileHashes& all = earlier.their_files;
  const bool is_same_simulation = earlier.simulation == simulation_of(job.run);
  if (!is_same_simulation && !record::is_same_path(earlier.scene_file, job.run.scene_file))
    refuse("exports of another scene, " + earlier.scene_file, all);
  for (const Json& before : earlier.replaced)
    for (const Json& now : ours)
      if (now.at("name") == before.at("name") && !has_same_settings(before, now))
        refuse("the export " + before.at("name").get<std::string>() +
                   " with other attributes, bodies, units or axes, or another surface",
               all);
  if (!earlier.simulation.empty() && !is_same_simulation)
    refuse(
        "this export of another simulation of the scene: parameters or files have changed since, "
        "or another build of neve has written it",
        all);
  for (const Json& before : earlier.replaced)
    if (has_other_moments(before, job)) refuse("this export at other frames or times", all);
  record::FileHashes gone = all;
  std::erase_if(gone, [written = files_to_write(job)](const auto& file) {
    return written.contains(file.first);
  });
  refuse("this export at other frames or times", gone);
}

/// An export that was cut off has made some of the files that its list names. Others are of people
/// or other programs, or of the run whose folder it is.
void refuse_foreign_exports(const ExportJob& job, const Earlier& earlier) {
  if (job.run.options.replaces) return;
  const std::vector<std::string> files =
      record::foreign_files(job.run.folder, files_to_write(job), earlier.names);
  if (files.empty()) return;
  throw UsageError(
      out_flag(job),
      fmt::format("{} has files that no neve export there has made; it would replace {}",
                  job.run.folder.string(), record::files_text(files)),
      "add --replace, or choose another folder with --out");
}

/// Goes to a time; a stage also has where things are at the frames on the way from the moment
/// before. @return false if the simulation stops before
bool go_through(timeline::Timeline& timeline, const scene::Scene& scene,
                std::optional<double> before, double time, exports::Exporter& exporter) {
  if (before && exporter.has_stage())
    for (int frame = timeline::frame_at(*before, scene.fps) + 1; frame / scene.fps < time;
         ++frame) {
      if (!timeline.go_to(frame / scene.fps)) return false;
      exporter.add_between(timeline.scene().colliders, timeline.simulation(),
                           scene::number_of(scene, frame), false);
    }
  return timeline.go_to(time);
}

/// A kept export of another state than the new one: the scene was changed in between.
void warn_of_other_states(const Json& exports, const Kept& kept, Progress& progress) {
  for (const Json& old : kept.exports)
    for (const Json& before : old.at("files"))
      for (const Json& now : exports.at(0).at("files")) {
        if (now.at("number") != before.at("number") || now.at("time") != before.at("time") ||
            now.at("state_hash") == before.at("state_hash"))
          continue;
        progress.warning(before.at("file").get<std::string>() +
                         " shows another state than this export: the scene has changed since; "
                         "export both formats together, as in --format ply,vdb");
        return;
      }
}

/// Files of dust that nothing raises are empty, whatever their header says.
void warn_of_no_dust(const scene::Scene& scene, Progress& progress) {
  if (std::ranges::any_of(scene.exports, &scene::Export::dust) && !scene::dusty_material(scene))
    progress.warning(
        "--dust: no snow of the scene sheds dust, and the files hold none; set "
        "material.NAME.dust, as in --set material." +
        scene::materials_of_snow(scene).front().name + ".dust=0.01");
}

void write_list(const ExportJob& job, const ExportResult& result, const Kept& kept,
                const std::vector<output::WrittenFile>& written) {
  record::FileHashes files;
  for (const output::WrittenFile& file : written)
    files[file.file.lexically_relative(job.run.folder).generic_string()] =
        record::hash_text(file.hash);
  Json json;
  json["version"] = version;
  json["scene_file"] = job.run.scene_file;
  json["simulation"] = simulation_of(job.run);
  json["fps"] = job.run.scene.fps;
  const std::optional<sim::Vec3d> offset = scene::world_offset(job.run.scene);
  json["world_offset"] = offset ? output::vector_json(*offset) : Json();
  json["is_whole"] = result.is_whole && kept.is_whole;
  json["exports"] = kept.exports;
  for (const Json& one : result.exports) {
    json["exports"].push_back(one);
    if (!job.are_frames) json["exports"].back()["at"] = job.times;
  }
  json["files"] = kept.files;
  for (const auto& [file, hash] : files) json["files"][file] = hash;
  // If this one is killed, the next one knows which files were to be its own.
  std::set<std::string> begun = kept.begun;
  if (result.moments == 0) begun.merge(files_to_write(job));
  if (!begun.empty()) json["begun"] = begun;
  output::write_file(output::export_list_path(job.run.folder), record::with_own_hash(json));
}

/// The run that has its exports in a folder, which is written to in its name.
std::optional<fs::path> run_with_exports_in(const fs::path& folder) {
  std::error_code error;
  const fs::path place = without_slash(fs::weakly_canonical(folder, error));
  const fs::path run = place.parent_path();
  if (error || place.filename() != output::exports_folder ||
      !fs::exists(output::run_json_path(run), error))
    return std::nullopt;
  return run;
}

}  // namespace

ExportJob make_export_job(const ExportOptions& options) {
  ExportJob job;
  job.run = make_job(options.run);
  job.lock_folder = job.run.folder;
  if (options.run.out.empty())
    job.run.folder /= output::exports_folder;
  else if (const auto run = run_with_exports_in(job.run.folder))
    job.lock_folder = *run;
  job.run.scene.exports = options.exports;
  check_exports(job.run.scene);
  job.times = options.at;
  // A strip shows moments, which may lie between frames.
  if (job.times.empty() && !options.run.frames && job.run.picture && job.run.picture->strip)
    job.times = job.run.picture->strip->times;
  job.are_frames = job.times.empty();
  if (!job.are_frames) {
    timeline::require_before_end("--at", job.times.back(), job.run);
    const double last = std::ceil(job.times.back() * job.run.scene.fps);
    job.run.frames = {0, static_cast<int>(std::min(last, 1e9))};
    return job;
  }
  job.first_number = scene::number_of(job.run.scene, job.run.frames.first);
  for (int frame = job.run.frames.first; frame <= job.run.frames.last; ++frame)
    job.times.push_back(frame / job.run.scene.fps);
  return job;
}

ExportResult run_export(const ExportJob& job, int threads, Progress& progress) {
  const output::FolderLock lock(job.lock_folder, "neve export");
  RenderJob run = job.run;
  place_camera(run.scene);
  for (const scene::Export& e : run.scene.exports)
    if (e.format == scene::ExportFormat::vdb && e.attributes != scene::Export{}.attributes)
      progress.warning(
          "vdb has mass, density and velocity of the nodes of the grid, and none of the attributes "
          "of particles that are asked for; another format has them, as in --format vdb,npz");
  warn_of_no_dust(run.scene, progress);
  timeline::warn_of_late_frame(job.times.back(), run, progress);
  timeline::Timeline timeline = timeline::open(run, threads, progress);
  const sim::Simulation& simulation = timeline.simulation();
  if (job.run.folder == job.lock_folder)
    output::make_folder(job.run.folder);
  else
    output::make_own_folder(job.run.folder);
  exports::Exporter exporter(run.scene, job.run.folder, timeline.seeded());
  const Earlier earlier = earlier_exports(job);
  refuse_lost_exports(job, earlier, exporter.to_json(""));
  refuse_foreign_exports(job, earlier);
  record::remove_listed(job.run.folder, earlier.their_files);
  ExportResult result;
  result.is_whole = false;
  write_list(job, result, earlier.kept, {});
  output::PictureWriter writer;
  progress.start(timeline::frame_at(job.times.back(), run.scene.fps),
                 scene::number_of(run.scene, 0));
  std::optional<double> before;
  for (const double time : job.times) {
    if (!go_through(timeline, run.scene, before, time, exporter)) break;
    before = time;
    const int number = job.first_number + static_cast<int>(result.moments++);
    if (job.are_frames)
      timeline::compare_with_run(run, scene::frame_of(run.scene, number), simulation.state_hash(),
                                 progress);
    if (const std::string other =
            timeline::difference_from_picture(run, time, simulation.state_hash());
        !other.empty())
      progress.warning(other);
    for (exports::Exporter::Work& work :
         exporter.add(timeline.scene().colliders, simulation, number, false))
      writer.write(std::move(work));
    if (const std::string warning = exporter.take_warning(); !warning.empty())
      progress.warning(warning);
  }
  writer.finish();
  std::vector<output::WrittenFile> written = writer.take_written();
  for (output::WrittenFile& file : exporter.finish()) written.push_back(std::move(file));
  progress.clear();
  result.is_whole = result.moments == job.times.size();
  result.divergence = simulation.divergence();
  result.exports = exporter.to_json("");
  warn_of_other_states(result.exports, earlier.kept, progress);
  write_list(job, result, earlier.kept, written);
  return result;
}

}  // namespace neve::app::run
