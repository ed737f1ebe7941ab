#include "app/run/render_job.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "app/run/fork.h"
#include "app/run/picture_record.h"
#include "app/scene/coarsen.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"

namespace neve::app::run {

namespace {

namespace fs = std::filesystem;

/// Degrees at final quality: half of each frame, as film cameras have it.
constexpr double usual_shutter = 180;

/// Reads the scene with the changes of the user, and with those of --fast where it was given.
/// @param read  scene(overrides)
template <class Read>
void read_scene(const RenderOptions& options, const Read& read, RenderJob& job) {
  job.overrides.insert(job.overrides.end(), options.overrides.begin(), options.overrides.end());
  std::vector<scene::Override> changes = scene::parse_overrides(options.overrides);
  job.scene = read(changes);
  if (!options.is_fast) return;
  scene::Scene coarse = job.scene;
  if (options.coarsening) scene::coarsen(coarse, *options.coarsening);
  const int last = options.frames ? options.frames->last : job.scene.frames;
  job.fast = health::fast_look(coarse, last, scene::addresses_of(changes));
  for (const std::string& change : job.fast->overrides) {
    changes.push_back(scene::parse_override(change));
    job.overrides.push_back(change);
  }
  job.scene = read(changes);
}

RenderJob job_from_scene(const RenderOptions& options) {
  RenderJob job;
  job.scene_file = options.scene.empty() ? default_scene().string() : options.scene;
  read_scene(
      options,
      [&](const std::vector<scene::Override>& changes) {
        return scene::read_scene_file(job.scene_file, changes);
      },
      job);
  job.folder = out_folder() / scene::name_of_scene(job.scene_file);
  job.frames = {0, job.scene.frames};
  return job;
}

const scene::Mosaic* find_mosaic(const scene::Scene& scene, const std::string& name) {
  for (const scene::Mosaic& mosaic : scene.mosaics)
    if (mosaic.name == name) return &mosaic;
  return nullptr;
}

/// Keeps the views and mosaics of these names, and the views that the mosaics need.
void choose_views(const std::vector<std::string>& names, RenderJob& job) {
  std::vector<scene::View> views;
  std::vector<scene::Mosaic> mosaics;
  const auto add_view = [&](const std::string& name) {
    const auto has_name = [&](const scene::View& view) { return view.name == name; };
    if (std::any_of(views.begin(), views.end(), has_name)) return false;
    views.push_back(scene::find_view(job.scene, name));
    return true;
  };
  const std::set<std::string> chosen(names.begin(), names.end());
  for (const std::string& name : names)
    if (!find_mosaic(job.scene, name)) add_view(name);
  for (const std::string& name : chosen)
    if (const scene::Mosaic* mosaic = find_mosaic(job.scene, name)) {
      mosaics.push_back(*mosaic);
      for (const std::string& tile : mosaic->views)
        if (add_view(tile)) job.only_tiles.push_back(tile);
    }
  job.scene.views = views;
  job.scene.mosaics = mosaics;
}

/// Checks that the last change of each address can be set.
void check_changes(const RenderJob& job) {
  try {
    with_changes({scene::write_scene(job.scene), job.scene_file, {}, {}},
                 changes_of(job.scene, job.changes));
  } catch (const UsageError& error) {
    throw Error(exit_invalid_scene, job.scene_file + ": error: " + error.what(), job.scene_file,
                "its text neve:changes was not written by neve");
  }
}

/// The frame and view of a picture, from the scene inside it.
RenderJob job_from_picture(const RenderOptions& options) {
  const PictureRecord record = read_picture_record(options.scene);
  check_files(record);
  RenderJob job;
  job.scene_file = options.scene;
  job.overrides = record.overrides;
  read_scene(
      options,
      [&](const std::vector<scene::Override>& changes) {
        return scene::read_scene_text(record.scene, options.scene + " (its scene)", {}, changes);
      },
      job);
  char name[32];
  std::snprintf(name, sizeof name, "%04d-again", record.frame);
  job.folder = out_folder() / name;
  job.frames = {record.frame, record.frame};
  job.quality = setup::quality_named(record.quality);
  job.changes = record.changes;
  job.passes = record.passes;
  job.shutter = record.shutter;
  job.plate = record.plate;
  job.coarsening = record.coarsening;
  choose_views({record.view}, job);
  job.scene.exports.clear();
  check_changes(job);
  return job;
}

bool is_only_mosaics(const RenderJob& job) {
  return !job.scene.mosaics.empty() && job.only_tiles.size() == job.scene.views.size();
}

void set_sizes(const RenderOptions& options, scene::Scene& scene) {
  if (options.size) {
    scene.size = *options.size;
    for (scene::View& view : scene.views) view.size.reset();
    for (scene::Mosaic& mosaic : scene.mosaics) mosaic.width.reset();
  }
  if (options.quality != setup::Quality::draft) return;
  // The size of a draft is part of its scene, so that the picture can be made again.
  const auto halve = [](scene::PictureSize& size) {
    size = {std::max(16, size.width / 2), std::max(16, size.height / 2)};
  };
  halve(scene.size);
  for (scene::View& view : scene.views)
    if (view.size) halve(*view.size);
  for (scene::Mosaic& mosaic : scene.mosaics)
    if (mosaic.width) mosaic.width = std::max(64, *mosaic.width / 2);
}

}  // namespace

namespace {

/// The overrides of a fork are changes on its way, see set_fork().
RenderJob job_of_source(const RenderOptions& options) {
  RenderOptions start = options;
  if (options.from) start.overrides.clear();
  if (!options.scene.empty() && is_picture(options.scene)) return job_from_picture(start);
  return options.from && is_folder(options.scene) ? job_from_run(start) : job_from_scene(start);
}

}  // namespace

RenderJob make_job(const RenderOptions& options) {
  if (options.from && (options.coarsening || options.is_fast))
    throw UsageError(options.coarsening ? "--coarsen" : "--fast",
                     "cannot be combined with --from: a run keeps its cells and "
                     "settings while it runs",
                     "coarsen the run that is forked");
  RenderJob job = job_of_source(options);
  if (options.coarsening) {
    scene::coarsen(job.scene, *options.coarsening);
    job.coarsening *= *options.coarsening;
  }
  if (!options.views.empty()) choose_views(options.views, job);
  if (!options.has_caption)
    for (scene::View& view : job.scene.views) std::erase(view.layers, scene::Layer::caption);
  set_sizes(options, job.scene);
  if (options.frames) job.frames = *options.frames;
  if (options.quality) job.quality = *options.quality;
  if (!options.out.empty()) job.folder = options.out;
  // A picture has its own shutter, unless another quality is asked for.
  const bool has_own = !options.scene.empty() && is_picture(options.scene) && !options.quality;
  if (options.shutter)
    job.shutter = *options.shutter;
  else if (!has_own)
    job.shutter = job.quality == setup::Quality::final ? usual_shutter : 0;
  if (!options.plate.empty()) job.plate = options.plate;
  if (!options.passes.empty()) job.passes = options.passes;
  if (is_only_mosaics(job)) {
    for (const auto& [flag, value] :
         {std::pair{"--passes", joined(options.passes, ",")}, std::pair{"--plate", options.plate}})
      if (!value.empty())
        throw UsageError(flag, "cannot be used with a mosaic", "name one of its views with --view");
    job.passes.clear();
    job.plate.clear();
  }
  job.validate = options.validate;
  job.resume = options.resume;
  job.checkpoint_every = options.checkpoint_every;
  job.keeps_states = options.keeps_states;
  job.has_movies = options.has_movies && options.movie.is_made;
  job.movie = options.movie;
  if (options.from) set_fork(options, job);
  return job;
}

}  // namespace neve::app::run
