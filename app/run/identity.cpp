#include "app/run/identity.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "app/output/json_file.h"
#include "app/output/sequence.h"
#include "app/record/picture_files.h"
#include "app/run/resume.h"
#include "app/scene/read.h"
#include "app/setup/plan.h"
#include "app/setup/resolve.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/support/version.h"

namespace neve::app::run {

namespace {

std::string value_or_none(const std::optional<scene::toml::Value>& value) {
  return value ? scene::toml::toml_literal(*value, 60) : "none";
}

/// Gives views all that they take from the scene as their own, and removes the cameras that neve
/// found for them: these follow from something else, such as the size.
scene::Scene comparable(scene::Scene scene) {
  setup::reopen_cameras(scene);
  for (scene::View& view : scene.views) view = with_settings_of(scene, view);
  const scene::Scene plain;
  scene.camera = plain.camera;
  scene.size = plain.size;
  scene.background = plain.background;
  return scene;
}

}  // namespace

scene::View with_settings_of(const scene::Scene& scene, scene::View view) {
  view.size = setup::size_of(scene, view);
  if (!view.camera) view.camera = scene.camera;
  view.background = scene::background_of(scene, view);
  return view;
}

scene::Mosaic with_settings_of(const scene::Scene& scene, scene::Mosaic mosaic) {
  if (!mosaic.width) mosaic.width = scene.size.width;
  return mosaic;
}

std::string simulation_text(const scene::Scene& scene) {
  // The text lacks what only pictures, exports and the length of a run read.
  const scene::Scene plain;
  scene::Scene simulated = scene;
  simulated.title.clear();
  simulated.frames = plain.frames;
  simulated.first_frame = plain.first_frame;
  simulated.handles = plain.handles;
  simulated.shot = plain.shot;
  simulated.burn_in = plain.burn_in;
  simulated.limits = plain.limits;
  simulated.camera = plain.camera;
  simulated.light = plain.light;
  simulated.views = plain.views;
  simulated.mosaics = plain.mosaics;
  simulated.exports = plain.exports;
  simulated.size = plain.size;
  simulated.background = plain.background;
  for (scene::Collider& collider : simulated.colliders) collider.style = scene::Collider{}.style;
  return scene::write_scene(simulated);
}

std::string surroundings_of(const scene::Scene& scene,
                            const std::vector<scene::LiveChange>& changes) {
  return std::string("\nversion ") + version + "\nsources " + build().sources +
         record::file_lines(scene, changes);
}

std::string identity_of_states(const RenderJob& job, const std::string& simd) {
  return record::hash_of(simulation_text(job.scene) + to_text(scene::to_json(job.changes)) +
                         surroundings_of(job.scene, job.changes) + simd);
}

std::string identity_of(record::PictureRecord picture) {
  picture.frame = 0;
  picture.view.clear();
  picture.state_hash.clear();
  picture.build.clear();
  return record::hash_of(to_text(to_json(picture)));
}

std::string difference_text(const std::vector<scene::Difference>& list) {
  const std::size_t more = list.size() - 1;
  return list.front().address + " was " + value_or_none(list.front().before) + " and is " +
         value_or_none(list.front().after) +
         (more > 0 ? ", and " + std::to_string(more) + " more differ" : "");
}

std::string difference_from_run(const std::filesystem::path& folder,
                                const record::PictureRecord& picture, const std::string& simd) {
  const bool of_simulation = !simd.empty();
  try {
    const Json run = output::read_json(output::run_json_path(folder));
    const scene::Scene before =
        scene::read_scene_text(run.at("scene").get<std::string>(), "run.json");
    const scene::Scene after = scene::read_scene_text(picture.scene, "the scene");
    std::vector<scene::Difference> list = scene::differences(comparable(before), comparable(after));
    // A command may draw some of the views that the folder has.
    std::erase_if(list, [&](const scene::Difference& d) {
      return of_simulation ? !scene::concerns_simulation(d.address)
                           : d.address == "view" || d.address == "mosaic";
    });
    if (!list.empty()) return difference_text(list);
    const auto version = run.at("version").get<std::string>();
    if (version != picture.version) return "it was made by version " + version;
    if (run.at("changes") != scene::to_json(picture.changes)) return "it had other changes";
    const Json files = run.value("scene_files", Json::object());
    for (const auto& [file, hash] : picture.files)
      if (files.contains(file) && files.at(file) != hash)
        return file + " has changed since the run began";
    if (of_simulation && run.at("simulation") == simulation_in_parts())
      return "different instructions or programs have made its parts";
    if (of_simulation && run.value("simd", Json()) != simd)
      return "it was made with other instructions, " + run.at("simd").get<std::string>();
    if (of_simulation)
      return "files that its scene names have changed since, or it was made by another build of "
             "neve";
    if (run.at("coarsen") != picture.coarsening)
      return "--coarsen was " + rough_text(run.at("coarsen").get<double>());
    if (run.at("overrides") != Json(picture.overrides)) return "it had other --set";
    const Json passes = run.value("passes", Json::array());
    if (passes != Json(picture.passes))
      return passes.empty() ? "it had no --passes"
                            : "--passes was " + joined(passes.get<std::vector<std::string>>(), ",");
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    // An unreadable scene changes nothing here: the identity alone says that the run differs.
  }
  return "its scene, changes, views, quality or version differ";
}

namespace {

/// Returns the text as earlier builds wrote it: three digits of the rate, and no format.
std::string earlier_style_text(int quality, double rate) {
  return fmt::format("quality {}, {} frames per second", quality, rough_text(rate));
}

double rate_of(const RenderJob& job, const output::MovieStyle& style) {
  return style.fps > 0 ? style.fps : job.scene.fps;
}

}  // namespace

std::string movie_style_text(const RenderJob& job, const output::MovieStyle& style) {
  return fmt::format("quality {}, {} frames per second, {}", style.quality,
                     scene::toml::number_text(rate_of(job, style)), output::name(style.format));
}

bool has_movie_style(const RenderJob& job, const std::string& text,
                     const output::MovieStyle& style) {
  return text == movie_style_text(job, style) ||
         text == earlier_style_text(style.quality, rate_of(job, style));
}

output::MovieStyle movie_style_of(const RenderJob& job, const std::string& text,
                                  const std::filesystem::path& movie) {
  output::MovieStyle style;
  double rate = 0;
  char format[16] = {};
  const int count = std::sscanf(text.c_str(), "quality %d, %lf frames per second, %15s",
                                &style.quality, &rate, format);
  if (const auto named = output::movie_format_named(format)) style.format = *named;
  const std::string suffix = movie.extension().string();
  if (output::info_of(style.format).suffix != suffix)
    style.format = output::movie_format_named(suffix.substr(1)).value_or(style.format);
  const bool is_of_scene =
      rate == job.scene.fps || text == earlier_style_text(style.quality, job.scene.fps);
  if (count >= 2 && !is_of_scene) style.fps = rate;
  return style;
}

}  // namespace neve::app::run
