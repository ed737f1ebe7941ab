#include "app/render_job.h"

#include <algorithm>
#include <cstdio>

#include "app/machine.h"
#include "app/picture_record.h"
#include "app/scene/coarsen.h"
#include "app/scene/read.h"

namespace neve::app {

namespace {

namespace fs = std::filesystem;

std::vector<Override> parse_overrides(const std::vector<std::string>& arguments) {
  std::vector<Override> overrides;
  for (const std::string& argument : arguments) overrides.push_back(parse_override(argument));
  return overrides;
}

RenderJob job_from_scene(const RenderOptions& options) {
  RenderJob job;
  job.scene_file = options.scene.empty() ? default_scene().string() : options.scene;
  job.scene = read_scene_file(job.scene_file, parse_overrides(options.overrides));
  job.folder = fs::path("out") / fs::path(job.scene_file).stem();
  job.frames = {0, job.scene.frames};
  return job;
}

/// The frame and view of a picture, from the scene inside it.
RenderJob job_from_picture(const RenderOptions& options) {
  const PictureRecord record = read_picture_record(options.scene);
  check_files(record);
  RenderJob job;
  job.scene_file = options.scene;
  job.scene = read_scene_text(record.scene, options.scene + " (its scene)", {},
                              parse_overrides(options.overrides));
  char name[32];
  std::snprintf(name, sizeof name, "%04d-again", record.frame);
  job.folder = fs::path("out") / name;
  job.frames = {record.frame, record.frame};
  job.quality = quality_named(record.quality);
  job.overrides = record.overrides;
  job.coarsening = record.coarsening;
  job.scene.views = {find_view(job.scene, record.view)};
  return job;
}

void choose_views(const RenderOptions& options, Scene& scene) {
  if (options.views.empty()) return;
  std::vector<View> chosen;
  for (const std::string& name : options.views) {
    const bool is_chosen = std::any_of(chosen.begin(), chosen.end(),
                                       [&](const View& view) { return view.name == name; });
    if (!is_chosen) chosen.push_back(find_view(scene, name));
  }
  scene.views = chosen;
}

void set_sizes(const RenderOptions& options, Scene& scene) {
  if (options.size) {
    scene.size = *options.size;
    for (View& view : scene.views) view.size.reset();
  }
  if (options.quality != Quality::draft) return;
  // The size of a draft is part of its scene, so that the picture can be made again.
  const auto halve = [](PictureSize& size) {
    size = {std::max(16, size.width / 2), std::max(16, size.height / 2)};
  };
  halve(scene.size);
  for (View& view : scene.views)
    if (view.size) halve(*view.size);
}

}  // namespace

RenderJob make_job(const RenderOptions& options) {
  const bool is_picture = !options.scene.empty() && is_png(options.scene);
  RenderJob job = is_picture ? job_from_picture(options) : job_from_scene(options);
  job.overrides.insert(job.overrides.end(), options.overrides.begin(), options.overrides.end());
  if (options.coarsening) {
    coarsen(job.scene, *options.coarsening);
    job.coarsening *= *options.coarsening;
  }
  choose_views(options, job.scene);
  set_sizes(options, job.scene);
  if (options.frames) job.frames = *options.frames;
  if (options.quality) job.quality = *options.quality;
  if (!options.out.empty()) job.folder = options.out;
  return job;
}

}  // namespace neve::app
