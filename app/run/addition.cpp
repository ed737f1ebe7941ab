#include "app/run/addition.h"

#include <fmt/core.h>

#include <algorithm>
#include <new>
#include <set>

#include "app/exports/series.h"
#include "app/output/movie_format.h"
#include "app/output/sequence.h"
#include "app/record/earlier.h"
#include "app/run/drawing.h"
#include "app/run/identity.h"
#include "app/scene/flat.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"

namespace neve::app::run {

namespace {

namespace fs = std::filesystem;

/// The scene without its views and what they can have of their own.
scene::Scene without_views(scene::Scene scene) {
  const scene::Scene plain;
  scene.views.clear();
  scene.mosaics.clear();
  scene.exports.clear();
  scene.size = plain.size;
  scene.camera = plain.camera;
  scene.background = plain.background;
  scene.limits = plain.limits;
  return scene;
}

/// Light, words and numbers of frames, which all pictures of a run share: where those of two scenes
/// differ, in the words of difference_text.
std::string difference_of_look(const scene::Scene& earlier, const scene::Scene& now) {
  scene::Scene before = without_views(earlier), after = without_views(now);
  before.frames = after.frames;
  const std::vector<scene::Difference> list = scene::differences(before, after);
  return list.empty() ? "" : difference_text(list);
}

/// Views with pictures that the command draws nothing of.
std::vector<std::string> other_views(const EarlierRun& earlier, const record::RunRecord& ours) {
  std::vector<std::string> views = earlier.pictures.views;
  std::erase_if(views, [&](const std::string& view) {
    return std::ranges::find(ours.views, view) != ours.views.end() ||
           earlier.frames_of(view).count() <= 0;
  });
  return views;
}

/// The scene of a run whose views are all drawn anew.
scene::Scene with_length_and_exports_of(const scene::Scene& earlier, scene::Scene now) {
  if (now.exports.empty()) now.exports = earlier.exports;
  now.frames = std::max(earlier.frames, now.frames);
  return now;
}

/// Views of both, those of `now` in the place of earlier ones; what they take from their scene
/// becomes their own where the two differ.
scene::Scene with_views_of(const scene::Scene& earlier, const scene::Scene& now) {
  scene::Scene merged = earlier;
  const auto put = [](auto& list, const auto& item) {
    for (auto& other : list)
      if (other.name == item.name) {
        other = item;
        return;
      }
    list.push_back(item);
  };
  scene::Scene alone = now;
  alone.views = earlier.views;
  alone.mosaics = earlier.mosaics;
  alone.exports = earlier.exports;
  const bool has_same_settings = scene::write_scene(alone) == scene::write_scene(earlier);
  for (const scene::View& view : now.views)
    put(merged.views, has_same_settings ? view : with_settings_of(now, view));
  for (const scene::Mosaic& mosaic : now.mosaics)
    put(merged.mosaics, has_same_settings ? mosaic : with_settings_of(now, mosaic));
  if (!now.exports.empty()) merged.exports = now.exports;
  merged.frames = std::max(earlier.frames, now.frames);
  return merged;
}

std::size_t count_below(const std::string& folder, const record::FileHashes& files) {
  return static_cast<std::size_t>(std::count_if(files.begin(), files.end(), [&](const auto& f) {
    return f.first.starts_with(folder + "/");
  }));
}

/// "49 pictures of snow, snow.mp4"
std::string files_text(const std::vector<std::string>& views, const EarlierRun& earlier) {
  std::vector<std::string> parts;
  for (const std::string& view : views) {
    const int count = earlier.frames_of(view).count();
    if (count > 0) parts.push_back(fmt::format("{} of {}", count_text(count, "picture"), view));
    const auto passes = std::ranges::count_if(earlier.pictures.files, [&](const auto& file) {
      return file.first.starts_with(view + "/") && file.first.ends_with(".exr");
    });
    if (passes > 0) parts.push_back(fmt::format("{} EXR of {}", passes, view));
    for (const std::string& movie : movies_of(view, earlier.pictures.files)) parts.push_back(movie);
  }
  return joined(parts, ", ");
}

/// Lists all files that another simulation takes the place of: exports too.
std::string all_files_text(const EarlierRun& earlier) {
  std::vector<std::string> parts{files_text(earlier.pictures.views, earlier)};
  if (const auto exports = count_below(output::exports_folder, earlier.pictures.files); exports > 0)
    parts.push_back(fmt::format("{} files in {}", exports, output::exports_folder));
  return joined(parts, ", ");
}

std::string exports_text(const scene::Scene& scene) {
  scene::Scene exports;
  exports.exports = scene.exports;
  return scene::write_scene(exports);
}

bool has_exports(const EarlierRun& earlier) {
  return count_below(output::exports_folder, earlier.pictures.files) > 0;
}

std::string drawing_before(const EarlierRun& earlier, const std::string& view) {
  const Json& json = earlier.json;
  return json.contains("drawings") && json["drawings"].is_object()
             ? json["drawings"].value(view, "")
             : "";
}

/// A movie of the same frames in another format, quality or speed than the one that is asked for.
bool has_other_movie(const RenderJob& job, const EarlierRun& earlier, const std::string& view) {
  if (!job.has_movies() || !job.options.movie.is_chosen) return false;
  const std::string name =
      output::movie_path({}, view, job.options.movie.format).filename().string();
  const Json styles = earlier.json.value("movies", Json::object());
  if (!earlier.pictures.files.contains(name) || !styles.is_object()) return false;
  const Json style = styles.value(name, Json());
  return style.is_string() && !has_movie_style(job, style.get<std::string>(), job.options.movie);
}

/// The first numbered plate that is another file than the one behind its picture; "": none is.
std::string other_plate(const RenderJob& job, const EarlierRun& earlier,
                        const record::RunRecord& ours) {
  std::error_code error;
  if (job.plate.empty() || fs::is_regular_file(job.plate, error)) return "";
  for (const std::string& view : ours.views)
    for (int frame = job.frames.first; frame <= job.frames.last && !find_mosaic(job.scene, view);
         ++frame) {
      const int number = scene::number_of(job.scene, frame);
      const std::string name = record::picture_name(view, number);
      if (!earlier.pictures.files.contains(name)) continue;
      const std::string plate = plate_path(job.plate, number).string();
      try {
        const record::FileHashes files = record::read_picture_record(job.folder / name).files;
        if (const auto listed = files.find(plate);
            listed != files.end() && !record::has_hash(plate, listed->second))
          return plate;
      } catch (const std::exception& failure) {
        rethrow_no_memory(failure);
        // The picture is damaged, and drawn again.
      }
    }
  return "";
}

std::string name_of_earlier(const EarlierRun& earlier) {
  return earlier.json.value("scene_file", "");
}

/// True where the folder is one that this command has by the name of the scene.
bool is_of_scene(const RenderJob& job, const EarlierRun& earlier) {
  return !job.run.empty() || job.picture ||
         scene::name_of_scene(name_of_earlier(earlier)) == job.name();
}

[[noreturn]] void refuse(const RenderJob& job, const std::string& what, const std::string& files,
                         const std::string& advice) {
  throw UsageError(job.options.out.empty() ? "" : "--out",
                   fmt::format("{} {}{}", job.folder.string(), what,
                               files.empty() ? "" : "; it would replace " + files),
                   advice);
}

}  // namespace

bool are_exports_kept(const RenderJob& job, const EarlierRun& earlier) {
  return job.scene.exports.empty() || !has_exports(earlier) ||
         exports_text(job.scene) == exports_text(earlier.scene);
}

bool EarlierRun::has(const std::string& view) const {
  return std::ranges::find(pictures.views, view) != pictures.views.end();
}

record::ViewFrames EarlierRun::frames_of(const std::string& view) const {
  if (!has(view) || pictures.frames.empty()) return {};
  const auto part = pictures.view_frames.find(view);
  if (part != pictures.view_frames.end()) return part->second;
  return {pictures.frames.front().frame, pictures.frames.back().frame};
}

std::vector<std::string> other_drawings(const EarlierRun& earlier, const record::RunRecord& ours) {
  std::vector<std::string> views;
  for (const std::string& view : ours.views)
    if (earlier.has(view) && drawing_before(earlier, view) != ours.view_records.at(view).drawing)
      views.push_back(view);
  return views;
}

std::vector<std::string> movies_of(const std::string& view, const record::FileHashes& files) {
  std::vector<std::string> movies;
  for (const output::MovieFormat format : output::all_movie_formats)
    if (const std::string name = output::movie_path({}, view, format).string();
        files.contains(name) && std::ranges::find(movies, name) == movies.end())
      movies.push_back(name);
  return movies;
}

std::optional<EarlierRun> earlier_run(const RenderJob& job, const record::RunRecord& ours) {
  EarlierRun earlier;
  earlier.json = record::read_run_json(job.folder);
  std::optional<record::Pictures> pictures = record::listed_pictures(earlier.json);
  if (!pictures || (pictures->files.empty() && pictures->frames.empty())) return std::nullopt;
  earlier.pictures = *std::move(pictures);
  try {
    earlier.scene = scene::read_scene_text(earlier.json.at("scene").get<std::string>(), "run.json");
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;  // what it lists goes if it is of a run, as ever
  }
  earlier.has_same_numbers = scene::number_of(earlier.scene, 0) == ours.first_number;
  earlier.is_same =
      earlier.has_same_numbers && earlier.json.value("simulation", Json()) == ours.simulation;
  return earlier;
}

std::string drawing_of(const RenderJob& job, record::PictureRecord picture,
                       const std::string& view) {
  scene::Scene scene = without_views(job.scene);
  const auto add = [&](const std::string& name) {
    for (const scene::View& own : job.scene.views)
      if (own.name == name) scene.views.push_back(with_settings_of(job.scene, own));
  };
  if (const scene::Mosaic* mosaic = find_mosaic(job.scene, view)) {
    scene.mosaics.push_back(with_settings_of(job.scene, *mosaic));
    for (const std::string& tile : mosaic->views) add(tile);
    picture.passes.clear();
    picture.files.erase(picture.plate);
    picture.plate.clear();
    picture.has_caption = job.options.has_caption;
  } else {
    add(view);
  }
  // Captions show no others.
  std::erase_if(picture.overrides, [](const std::string& change) {
    return !scene::concerns_simulation(change.substr(0, change.find('=')));
  });
  picture.scene = scene::write_scene(scene);
  return identity_of(std::move(picture));
}

void refuse_sweep_folder(const RenderJob& job) {
  std::error_code error;
  if (is_sweep_folder(job.folder) && std::filesystem::is_directory(job.folder / "runs", error))
    refuse(job, "is the folder of a sweep", "", "choose another folder with --out");
}

void refuse_unreadable_run(const RenderJob& job) {
  const fs::path file = output::run_json_path(job.folder);
  std::error_code error;
  if (job.options.replaces || !fs::exists(file, error)) return;
  const Json json = record::read_json(file);
  // A power cut leaves less than a text of JSON, which --resume is for.
  if (json.is_null() && job.options.resume) return;
  if (const auto listed = record::listed_pictures(json);
      listed && listed->files.empty() && listed->frames.empty())
    return;
  refuse(job,
         "has a run.json that neve cannot read as the list of a run, so that nothing tells which "
         "files are its own",
         "", "add --replace, which writes over it, or choose another folder with --out");
}

void refuse_foreign_files(const RenderJob& job, const record::RunRecord& ours) {
  std::error_code error;
  if (job.options.replaces || fs::exists(output::run_json_path(job.folder), error)) return;
  const setup::FrameRange numbers = setup::numbers_of(job.scene, job.frames);
  std::vector<std::string> files;
  const auto look_at = [&](const fs::path& file) {
    // A link or a folder that cannot be written over is told when it is written.
    if (fs::is_regular_file(fs::symlink_status(file, error)))
      files.push_back(file.lexically_relative(job.folder).generic_string());
  };
  for (const std::string& view : ours.views) {
    // The folder is listed, as few of very many frames may exist.
    for (fs::directory_iterator at(job.folder / view, error), end; !error && at != end;
         at.increment(error)) {
      const auto number = number_of<int>(at->path().stem().string());
      if (number && *number >= numbers.first && *number <= numbers.last &&
          at->path() == output::frame_path(job.folder, view, *number))
        look_at(at->path());
    }
    if (job.has_movies()) look_at(output::movie_path(job.folder, view, job.options.movie.format));
  }
  for (const scene::Export& e : job.scene.exports) {
    const fs::path exports = job.folder / output::exports_folder, own = exports / folder_of(e);
    if (!exports::series_name(e).empty()) look_at(exports / exports::series_name(e));
    if (!fs::is_directory(own, error)) continue;
    for (int frame = job.frames.first; frame <= job.frames.last; ++frame)
      if (frame % e.every == 0)
        look_at(own / exports::file_name(e, scene::number_of(job.scene, frame)));
  }
  if (files.empty()) return;
  std::ranges::sort(files);
  refuse(job, "has files that no run there has made", record::files_text(files),
         "add --replace, or choose another folder with --out");
}

void refuse_loss(const RenderJob& job, const EarlierRun& earlier, const record::RunRecord& ours,
                 const record::PictureRecord& picture) {
  const std::string elsewhere = "choose another folder with --out";
  if (!earlier.is_same) {
    if (!is_of_scene(job, earlier))
      refuse(job, "is the folder of another scene, " + name_of_earlier(earlier), "", elsewhere);
    if (!earlier.has_same_numbers && (!job.options.replaces || job.is_drawn_in_place()))
      refuse(job,
             fmt::format("has frames from {} on, and these begin with {}",
                         scene::number_of(earlier.scene, 0), ours.first_number),
             all_files_text(earlier),
             (job.is_drawn_in_place() ? "" : "add --replace, or ") + elsewhere);
    if (!job.options.replaces)
      refuse(job, "has another simulation: " + difference_from_run(job.folder, picture, ours.simd),
             all_files_text(earlier), "add --replace, or " + elsewhere);
    return;
  }
  // The scene in run.json is that of all pictures.
  if (const std::vector<std::string> others = other_views(earlier, ours); !others.empty())
    if (const std::string what = difference_of_look(earlier.scene, job.scene); !what.empty())
      refuse(job,
             fmt::format("has pictures of {} drawn otherwise, and all of a run share it: {}",
                         joined(others, ", "), what),
             "", elsewhere + ", or draw all of its views anew in one command, with --replace");
  if (job.options.replaces) return;
  const std::vector<std::string> views = other_drawings(earlier, ours);
  if (!views.empty())
    refuse(job,
           "has " + joined(views, ", ") +
               " of this run, drawn otherwise: " + difference_from_run(job.folder, picture),
           files_text(views, earlier), "add --replace, or " + elsewhere);
  if (const std::string plate = other_plate(job, earlier, ours); !plate.empty())
    refuse(job, "has pictures over " + plate + ", which has changed since",
           files_text(ours.views, earlier), "add --replace, or " + elsewhere);
  for (const std::string& view : ours.views)
    if (has_other_movie(job, earlier, view))
      refuse(job, "has a movie of the same pictures in another format, quality or speed",
             output::movie_path({}, view, job.options.movie.format).filename().string(),
             "add --replace, or make another format with --movie");
  if (!are_exports_kept(job, earlier))
    refuse(
        job, "has other exports of this run",
        fmt::format("{} files in {}", count_below(output::exports_folder, earlier.pictures.files),
                    output::exports_folder),
        "add --replace, or " + elsewhere);
}

void keep_views(const RenderJob& job, const EarlierRun& earlier, record::RunRecord& ours) {
  const auto& with_passes = earlier.pictures.views_of_passes;
  const auto short_movies = record::short_movies(earlier.json);
  for (const std::string& view : earlier.pictures.views) {
    for (const std::string& movie : movies_of(view, earlier.pictures.files)) {
      const auto found = short_movies.find(movie);
      ours.movie_frames[movie] =
          found != short_movies.end() ? found->second : earlier.frames_of(view);
    }
    ours.earlier_views.push_back(view);
    record::ViewRecord& record = ours.view_records[view];
    record.frames = earlier.frames_of(view);
    if (std::ranges::find(ours.views, view) != ours.views.end()) continue;
    record.drawing = drawing_before(earlier, view);
    record.has_passes = std::ranges::find(with_passes, view) != with_passes.end();
  }
  for (const std::string& view : ours.views)
    if (!earlier.has(view)) ours.view_records[view].frames = record::ViewFrames{};
  scene::Scene merged = other_views(earlier, ours).empty()
                            ? with_length_and_exports_of(earlier.scene, job.scene)
                            : with_views_of(earlier.scene, job.scene);
  merged.undrawn_views = scene::others_than(merged.views, job.scene.undrawn_views);
  merged.undrawn_mosaics = scene::others_than(merged.mosaics, job.scene.undrawn_mosaics);
  ours.scene = scene::write_scene(merged);
  ours.undrawn = scene::write_undrawn(merged);
  if (!job.run.empty()) ours.scene_file = name_of_earlier(earlier);
  for (const char* key : {"forked", "prediction", "slate", "validation", "divergence", "exports",
                          "passes", "retries"})
    if (earlier.json.contains(key)) ours.carried[key] = earlier.json[key];
  if (const Json styles = earlier.json.value("movies", Json::object()); styles.is_object())
    for (const auto& [file, style] : styles.items())
      if (style.is_string()) ours.movies[file] = style;
}

record::FileHashes add_to_run(const RenderJob& job, const EarlierRun& earlier,
                              record::RunRecord& ours) {
  record::FileHashes removed;
  ours.files = earlier.pictures.files;
  ours.frames = earlier.pictures.frames;
  const auto remove = [&](const auto& is_meant) {
    for (auto file = ours.files.begin(); file != ours.files.end();) {
      const bool goes = is_meant(file->first);
      if (goes) removed.insert(*file);
      file = goes ? ours.files.erase(file) : std::next(file);
    }
  };
  const std::vector<std::string> others = other_drawings(earlier, ours);
  keep_views(job, earlier, ours);
  for (const std::string& view : ours.views) {
    const bool goes = job.options.replaces || std::ranges::find(others, view) != others.end();
    if (!earlier.has(view) || !goes) continue;
    ours.view_records[view].frames = record::ViewFrames{};
    const std::vector<std::string> movies = movies_of(view, ours.files);
    remove([&](const std::string& name) {
      return name.starts_with(view + "/") || std::ranges::find(movies, name) != movies.end();
    });
  }
  if (!are_exports_kept(job, earlier))
    remove([](const std::string& name) {
      return name.starts_with(std::string(output::exports_folder) + "/");
    });
  return removed;
}

setup::FrameRange frames_without_gaps(const RenderJob& job, const record::RunRecord& ours) {
  setup::FrameRange frames = job.frames;
  const auto join = [&](const record::ViewFrames& there) {
    if (there.count() <= 0) return;
    const int first = scene::frame_of(job.scene, there.first),
              last = scene::frame_of(job.scene, there.last);
    frames.first = std::min(frames.first, last + 1);
    frames.last = std::max(frames.last, first - 1);
  };
  if (!ours.frames.empty()) join({ours.frames.front().frame, ours.frames.back().frame});
  for (const std::string& view : ours.views)
    if (const auto record = ours.view_records.find(view);
        record != ours.view_records.end() && record->second.frames)
      join(*record->second.frames);
  return frames;
}

}  // namespace neve::app::run
