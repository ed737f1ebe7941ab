#include "app/run/render_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>

#include "app/output/file_hash.h"
#include "app/record/earlier.h"
#include "app/record/picture_files.h"
#include "app/record/verify.h"
#include "app/run/fork.h"
#include "app/run/passes.h"
#include "app/scene/flat.h"
#include "app/scene/read.h"
#include "app/setup/curves.h"
#include "app/setup/mosaic_layout.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "app/timeline/changes.h"

namespace neve::app::run {

namespace {

/// The look and the plate of all frames; numbered plates are those of their pictures.
void add_look_files(const RenderJob& job, record::FileHashes& files) {
  std::error_code error;
  if (!job.lut.empty()) files[job.lut] = record::hash_text(output::hash_file(job.lut));
  if (!job.plate.empty() && std::filesystem::is_regular_file(job.plate, error))
    files[job.plate] = record::hash_text(output::hash_file(job.plate));
}

/// Degrees at final quality: half of each frame, as film cameras have it.
constexpr double usual_shutter = 180;

/// Draws the views and mosaics of these names, and the views that the mosaics need.
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
  scene::draw_only(std::move(views), job.scene.views, job.scene.undrawn_views);
  scene::draw_only(std::move(mosaics), job.scene.mosaics, job.scene.undrawn_mosaics);
}

/// Checks that the last change of each address can be set, and that its passes are known.
void check_texts(const RenderJob& job) {
  const auto check = [&](const char* key, const auto& read) {
    try {
      read();
    } catch (const UsageError& error) {
      throw Error(exit_invalid_scene, job.scene_file + ": error: " + error.what(), job.scene_file,
                  std::string("its text ") + key + " was not written by neve");
    }
  };
  check("neve:changes",
        [&] { timeline::with_changes(job.scene, timeline::changes_of(job.scene, job.changes)); });
  check("neve:passes", [&] { pass_list(job.passes); });
}

/// Takes from a picture how it was drawn, but not its scene.
void take_drawing(const record::PictureRecord& picture, RenderJob& job) {
  job.quality = setup::quality_named(picture.quality);
  job.passes = picture.passes;
  job.shutter = picture.shutter;
  job.plate = picture.plate;
  job.lut = picture.lut;
  job.options.has_caption = job.options.has_caption && picture.has_caption;
}

/// The view of a picture, and how it was drawn.
void take_picture(const record::PictureRecord& picture, RenderJob& job) {
  job.folder = out_folder() / fmt::format("{:04}-again", picture.frame);
  job.prediction_lines = picture.prediction;
  take_drawing(picture, job);
  choose_views({picture.view}, job);
  job.scene.exports.clear();
  check_texts(job);
}

/// A run that is continued is drawn as its newest picture is, where the options say nothing else.
/// @return whether it has one
bool take_drawing_of_run(RenderJob& job) {
  const std::optional<record::Pictures> pictures =
      record::listed_pictures(record::read_run_json(job.run));
  if (!pictures) return false;
  bool has_drawing = false;
  for (const std::string& view : pictures->views) {
    const bool is_mosaic =
        std::ranges::find(job.scene.mosaics, view, &scene::Mosaic::name) != job.scene.mosaics.end();
    const bool is_drawn =
        std::ranges::find(job.only_tiles, view) == job.only_tiles.end() &&
        (is_mosaic ||
         std::ranges::find(job.scene.views, view, &scene::View::name) != job.scene.views.end());
    if (!is_drawn || (has_drawing && !is_mosaic)) continue;
    for (auto frame = pictures->frames.rbegin(); frame != pictures->frames.rend(); ++frame) {
      const std::string name = record::picture_name(view, frame->frame);
      const auto listed = pictures->files.find(name);
      if (!pictures->has(view, frame->frame) || listed == pictures->files.end() ||
          !record::has_hash(job.run / name, listed->second))
        continue;
      const record::PictureRecord picture = record::read_picture_record(job.run / name);
      // Only the picture of a mosaic says whether the run has captions: views have layers.
      if (has_drawing)
        job.options.has_caption = job.options.has_caption && picture.has_caption;
      else
        take_drawing(picture, job);
      has_drawing = true;
      break;
    }
  }
  return has_drawing;
}

bool is_only_mosaics(const RenderJob& job) {
  return !job.scene.mosaics.empty() && job.only_tiles.size() == job.scene.views.size();
}

void set_sizes(const RenderOptions& options, scene::Scene& scene) {
  if (options.size) setup::set_size(*options.size, scene);
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

/// Bodies of a frame, with the rotations that the history has.
std::vector<record::BodyRecord> with_rotations(std::vector<record::BodyRecord> bodies,
                                               const picture::PlotSample& sample) {
  for (record::BodyRecord& body : bodies)
    for (const picture::BodySample& known : sample.bodies)
      if (known.name == body.collider) body.rotation = known.rotation;
  return bodies;
}

}  // namespace

const scene::Mosaic* find_mosaic(const scene::Scene& scene, const std::string& name) {
  for (const std::vector<scene::Mosaic>* mosaics : {&scene.mosaics, &scene.undrawn_mosaics})
    if (const auto found = std::ranges::find(*mosaics, name, &scene::Mosaic::name);
        found != mosaics->end())
      return &*found;
  return nullptr;
}

bool RenderJob::draws_alone(const scene::View& view) const {
  return std::ranges::find(only_tiles, view.name) == only_tiles.end();
}

int RenderJob::caption_lines() const {
  if (!options.has_caption) return 0;
  const bool is_predicted = options.predicts || !prediction_lines.empty();
  return setup::caption_lines(scene, is_predicted || !overrides.empty());
}

bool RenderJob::is_drawn_in_place() const {
  return !run.empty() && record::is_same_path(folder.string(), run.string());
}

RenderJob make_job(const RenderOptions& options) {
  if (options.from && (options.coarsening || options.is_fast))
    throw UsageError(options.coarsening ? "--coarsen" : "--fast",
                     "cannot be combined with --from: a run keeps its cells and "
                     "settings while it runs",
                     "coarsen the run that is forked");
  timeline::Edits edits{options.overrides, options.coarsening, options.is_fast};
  if (options.frames) edits.last_frame = options.frames->last;
  if (options.is_agreed || options.dry_run) edits.agreement = timeline::Agreement::given;
  edits.coarsened = options.coarsened.value_or(1);
  edits.is_start_only = options.is_start_only;
  // A command for another folder makes another drawing of the frames that the run has.
  std::error_code error;
  edits.continues_run =
      options.resume &&
      (options.out.empty() || std::filesystem::equivalent(options.out, options.scene, error));
  if (options.from) edits.overrides.clear();  // changes on its way, see set_fork()
  RenderJob job{timeline::Origin::of(options.scene, edits), options};
  job.folder = job.run.empty() ? out_folder() / job.name() : job.run;
  if (job.picture) take_picture(*job.picture, job);
  // A fork is another future than the one that was predicted, and so is other snow.
  const bool is_other_snow =
      options.coarsening || options.from ||
      std::ranges::any_of(options.overrides, [](std::string_view change) {
        return scene::concerns_simulation(change.substr(0, change.find('=')));
      });
  if (is_other_snow) job.prediction_lines.clear();
  if (options.from) job.prediction = Json();
  if (job.prediction.is_object())
    job.prediction_lines = job.prediction.value("text", std::vector<std::string>());
  if (!options.views.empty()) choose_views(options.views, job);
  const bool has_drawing =
      job.picture || (edits.continues_run && !job.run.empty() && take_drawing_of_run(job));
  if (!options.has_caption)
    for (scene::View& view : job.scene.views) std::erase(view.layers, scene::Layer::caption);
  set_sizes(options, job.scene);
  if (options.frames) {
    job.frames = setup::frames_of(job.scene, *options.frames);
    if (options.frames->first == setup::FrameRange::from_start && job.first <= job.frames.last)
      job.frames.first = job.first;
  }
  if (options.quality) job.quality = *options.quality;
  if (!options.out.empty()) job.folder = options.out;
  if (options.shutter)
    job.shutter = *options.shutter;
  else if (!has_drawing || options.quality)  // a picture has its own
    job.shutter = job.quality == setup::Quality::final ? usual_shutter : 0;
  if (!options.plate.empty()) job.plate = options.plate;
  if (!options.lut.empty())
    job.lut = options.lut;
  else if (job.picture && !job.lut.empty())
    record::require_listed(*job.picture, job.lut, job.scene_file);
  if (!options.passes.empty()) job.passes = options.passes;
  if (is_only_mosaics(job)) {
    for (const auto& [flag, value] :
         {std::pair{"--passes", joined(options.passes, ",")}, std::pair{"--plate", options.plate}})
      if (!value.empty())
        throw UsageError(flag, "cannot be used with a mosaic", "name one of its views with --view");
    job.passes.clear();
    job.plate.clear();
  }
  job.passes = passes_of(job.scene, job.passes);
  if (options.from) set_fork(options, job);
  return job;
}

record::PictureRecord picture_record(const RenderJob& job, const std::string& scene,
                                     const std::string& simd) {
  record::PictureRecord picture;
  picture.scene = scene;
  picture.build = build_text(simd);
  picture.overrides = job.overrides;
  picture.changes = job.changes;
  picture.coarsening = job.coarsening;
  picture.prediction = job.prediction_lines;
  picture.seed = job.scene.seed;
  picture.version = version;
  picture.quality = setup::name(job.quality);
  picture.plate = job.plate;
  picture.lut = job.lut;
  picture.shutter = job.shutter;
  picture.passes = job.passes;
  picture.files = record::hash_files(job.scene, job.changes);
  add_look_files(job, picture.files);
  return picture;
}

record::RunRecord run_record(const RenderJob& job, const sim::Simulation& simulation) {
  record::RunRecord record;
  record.scene = scene::write_scene(job.scene);
  record.undrawn = scene::write_undrawn(job.scene);
  record.scene_file = job.scene_file;
  record.first_number = scene::number_of(job.scene, 0);
  record.world_offset = scene::world_offset(job.scene);
  record.overrides = job.overrides;
  record.changes = job.changes;
  record.coarsening = job.coarsening;
  record.prediction = job.prediction;
  record.forked = job.forked;
  record.threads = simulation.threads();
  record.simd = simulation.simd();
  return record;
}

record::RunStart start_of_run(const timeline::Timeline& timeline, const Json& before, int last) {
  if (auto known = record::start_of(before)) {
    known->before = record::extremes_until(before, last);
    return *known;
  }
  const auto start_in = [&](const sim::Simulation& simulation) {
    return record::RunStart{record::measure(simulation.particles(), timeline.start()),
                            with_rotations(record::bodies_of(simulation.colliders(), 0),
                                           timeline.here().history.front())};
  };
  if (timeline.simulation().steps() == 0) return start_in(timeline.simulation());
  return start_in(setup::make_simulation(setup::with_curves(timeline.start(), 0),
                                         timeline.seeded().particles, 1));
}

record::RunStart start_beside(const timeline::Timeline& timeline, const RenderJob& job, int last) {
  const Json run = job.run.empty() ? Json() : record::read_run_json(job.run);
  // Its numbers are of before this command gave other ones.
  const int first = scene::number_of(job.scene, 0),
            moved = run.is_object() ? first - whole_number_or(run, "first_number", first) : 0;
  record::RunStart start = start_of_run(timeline, run, last - moved);
  if (start.before) start.before->frame += moved;
  if (start.before && start.before->frame > last) start.before.reset();
  return start;
}

std::vector<record::BodyRecord> bodies_here(const timeline::Timeline& timeline) {
  const sim::Simulation& simulation = timeline.simulation();
  return with_rotations(record::bodies_of(simulation.colliders(), simulation.time()),
                        timeline.here().history.back());
}

void add_passed(const timeline::Timeline& timeline, record::Extremes& extremes) {
  record::FrameRecord passed;
  passed.frame = scene::number_of(timeline.start(), timeline.here().frame);
  if (passed.frame != extremes.frame + 1) return;
  passed.advance = timeline.here().advance;
  passed.summary = timeline.summary();
  passed.forces =
      record::forces_of(passed.advance, passed.summary, timeline.here().scene->colliders);
  passed.bodies = bodies_here(timeline);
  extremes.add(passed);
}

}  // namespace neve::app::run
