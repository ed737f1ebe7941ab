#include "app/sweep/plan/sweep_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <future>
#include <set>

#include "app/forecast/forecast.h"
#include "app/options/languages.h"
#include "app/predict/copies.h"
#include "app/record/picture_record.h"
#include "app/run/fork.h"
#include "app/run/identity.h"
#include "app/scene/burn_in.h"
#include "app/scene/coarsen.h"
#include "app/scene/leaf.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/setup/curves.h"
#include "app/setup/resolve.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"
#include "app/sweep/plan/expand.h"
#include "app/sweep/plan/order.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/sweep/read/read_sweep.h"
#include "app/sweep/read/sweep_leaf.h"
#include "app/timeline/changes.h"
#include "app/timeline/times.h"

namespace neve::app::sweep::plan {

namespace {

namespace fs = std::filesystem;

constexpr int tile_width = 480;

/// A tile in the shape of the scene's pictures.
scene::PictureSize tile_size(const SweepOptions& options, const read::Sweep& sweep,
                             const scene::Scene& scene, const scene::View& view) {
  if (options.size) return *options.size;
  if (sweep.sheet.tile) return *sweep.sheet.tile;
  const scene::PictureSize own = setup::size_of(scene, view);
  const auto height = std::lround(static_cast<double>(tile_width) * own.height / own.width / 2) * 2;
  return {tile_width, std::clamp(static_cast<int>(height), 64, 4096)};
}

scene::View chosen_view(const SweepOptions& options, const read::Sweep& sweep,
                        const scene::Scene& scene) {
  if (!options.view.empty()) return scene::find_view(scene, options.view);
  if (sweep.sheet.view.empty()) return scene.views.front();
  try {
    return scene::find_view(scene, sweep.sheet.view);
  } catch (const UsageError& error) {
    sweep.fail("sheet.view", "sheet.view = \"" + sweep.sheet.view + "\": " + error.message,
               error.hint);
  }
}

/// One view, as large as a tile, without the words that the sheet has once; the others are known
/// by name. Colours of a frame would compare nothing: all tiles have the ranges of the scene.
void prepare_view(const SweepOptions& options, const read::Sweep& sweep, scene::Scene& scene) {
  scene::draw_only({chosen_view(options, sweep, scene)}, scene.views, scene.undrawn_views);
  scene::draw_only({}, scene.mosaics, scene.undrawn_mosaics);
  scene::View& view = scene.views.front();
  setup::set_size(tile_size(options, sweep, scene, view), scene);
  std::erase(view.layers, scene::Layer::legend);
  std::erase(view.layers, scene::Layer::caption);
  view.slice.range_from = scene::RangeFrom::scene;
}

/// True if runs branch off a common beginning, and do not have their values from the start.
bool is_forked(const SweepOptions& options, const read::Sweep& sweep) {
  return options.fork || options.from || !sweep.settings.fork.empty();
}

class SceneMaker {
 public:
  /// @param source  whose scene is varied; without one it is that of the sweep's file
  SceneMaker(const SweepOptions& options, const read::Sweep& sweep,
             const std::optional<run::RenderJob>& source)
      : options_(options), sweep_(sweep) {
    if (source)
      at_fork_ = run::scene_before_fork(*source);
    else
      text_ = scene::read_toml_file(sweep.scene_file);
  }

  /// The scene with the fixed settings, or the unchanged scene of a source.
  scene::Scene make_base() const { return make({}, options_.from ? none_ : sweep_.fixed); }

  scene::Scene make(const std::vector<scene::Override>& settings) const {
    return make(settings, sweep_.fixed);
  }

  /// Makes the scene of a run as it is before --coarsen.
  scene::Scene make_full(const std::vector<scene::Override>& settings) const {
    return make(settings, sweep_.fixed, 1);
  }
  /// Prepares a scene to be drawn as all runs of the sweep are.
  void prepare(scene::Scene& scene) const { prepare_view(options_, sweep_, scene); }

 private:
  scene::Scene make(const std::vector<scene::Override>& settings,
                    const std::vector<scene::Override>& fixed) const {
    scene::Scene scene = make(settings, fixed, options_.coarsening.value_or(1));
    prepare(scene);
    return scene;
  }

  scene::Scene make(const std::vector<scene::Override>& settings,
                    const std::vector<scene::Override>& fixed, double coarsening) const {
    std::vector<scene::Override> all = fixed;
    all.insert(all.end(), settings.begin(), settings.end());
    scene::Scene scene = at_fork_
                             ? scene::apply(*at_fork_, all, sweep_.scene_file)
                             : scene::read_scene_text(text_, sweep_.scene_file,
                                                      scene::base_dir_of(sweep_.scene_file), all);
    setup::refuse_followers(scene, all);
    scene::place_in_world(scene, sweep_.scene_file);
    setup::require_curve_values(scene, sweep_.scene_file);
    scene::coarsen(scene, coarsening);
    // A fork is told what it changes.
    if (!is_forked(options_, sweep_) && !settings.empty())
      scene::write_changes(scene::texts_of(all), scene);
    return scene;
  }

  const SweepOptions& options_;
  const read::Sweep& sweep_;
  std::string text_;  ///< of the sweep's scene
  std::optional<scene::Scene> at_fork_;
  std::vector<scene::Override> none_;
};

/// A setting of a run that says how many frames there are; null if none does.
const scene::Override* frames_setting(const read::Sweep& sweep) {
  for (const read::Axis& axis : sweep.axes)
    for (const read::Axis::Parameter& parameter : axis.parameters)
      if (parameter.address == "frames") return &parameter.values.front();
  for (const Run& row : sweep.rows)
    for (const scene::Override& setting : row.settings)
      if (setting.address == "frames") return &setting;
  return nullptr;
}

/// Returns frames counted from 0. @param source  a run may have more frames than its scene
setup::FrameRange frames_of(const SweepOptions& options, const read::Sweep& sweep,
                            const scene::Scene& scene,
                            const std::optional<run::RenderJob>& source = {}) {
  if (options.frames) return setup::frames_of(scene, *options.frames);
  if (!sweep.settings.frames.empty())
    return setup::frames_of(scene, options::frames().read("--frames", sweep.settings.frames));
  const bool is_length_set = frames_setting(sweep) || scene::sets(sweep.fixed, "frames");
  return {0, source && !is_length_set ? source->last_frame() : scene::last_frame(scene)};
}

/// Frames that are the same for all runs would hide those that differ.
void refuse_two_frames(const SweepOptions& options, const read::Sweep& sweep) {
  const scene::Override* setting = frames_setting(sweep);
  if (!setting) return;
  if (options.frames)
    throw UsageError("--frames", "the sweep varies frames",
                     "remove --frames, or remove frames from the axes and runs");
  if (!sweep.settings.frames.empty())
    sweep.fail("sweep.frames", "sweep.frames is for all runs, and the sweep varies frames",
               "remove one of them");
}

/// A run at an end of the axes, or of the rows.
struct Corner {
  const Run* run;
  scene::Scene scene;  ///< without settings of --fast
};

/// The first corner that becomes other snow by the settings that all runs have now; null: none.
const Run* other_snow_among(const std::vector<Corner>& corners, const SceneMaker& maker,
                            const std::function<int(const scene::Scene&)>& last_of) {
  std::vector<std::future<bool>> judged;
  for (const Corner& corner : corners)
    judged.push_back(std::async(
        std::launch::async,
        [&before = corner.scene, after = maker.make(corner.run->settings),
         last = last_of(corner.scene)] { return forecast::is_same_snow(before, after, last); }));
  const Run* other = nullptr;
  for (std::size_t k = 0; k < corners.size(); ++k)
    if (!judged[k].get() && !other) other = corners[k].run;
  return other;
}

/// The settings of --fast for all runs; what the sweep sets or varies stays. Runs are compared in
/// steps of one kind, and of a length that is right for all of them.
forecast::FastLook take_fast_look(const SweepOptions& options, const SceneMaker& maker,
                                  const scene::Scene& base, read::Sweep& sweep) {
  constexpr std::size_t max_corners = 8;
  std::vector<std::string> chosen = scene::addresses_of(sweep.fixed);
  std::vector<int> sizes;
  for (const read::Axis& axis : sweep.axes) {
    sizes.push_back(static_cast<int>(axis.size()));
    for (const read::Axis::Parameter& parameter : axis.parameters)
      chosen.push_back(parameter.address);
  }
  for (const Run& row : sweep.rows)
    for (std::string& address : scene::addresses_of(row.settings))
      chosen.push_back(std::move(address));
  const std::vector<Run> runs = expand(sweep);
  std::vector<std::vector<int>> places;
  for (const Run& run : runs) places.push_back(run.coordinates);
  double cfl = forecast::fast_cfl(base);
  std::vector<Corner> corners;
  std::set<std::string> known{run::simulation_text(base)};
  for (const std::size_t k : coarse_first(places, sizes)) {
    scene::Scene scene = maker.make(runs[k].settings);
    cfl = std::min(cfl, forecast::fast_cfl(scene));
    if (corners.size() < max_corners && known.insert(run::simulation_text(scene)).second)
      corners.push_back({&runs[k], std::move(scene)});
  }
  const auto last_of = [&](const scene::Scene& scene) {
    return frames_of(options, sweep, scene).last;
  };
  const std::vector<scene::Override> given = sweep.fixed;
  std::string kept;
  while (true) {
    forecast::FastLook look =
        forecast::fast_look(base, last_of(base), chosen, options.coarsening.value_or(1), cfl);
    look.kept = kept;
    sweep.fixed = given;
    for (const std::string& change : look.overrides)
      sweep.fixed.push_back(scene::parse_override(change));
    const std::vector<std::string> risks = look.risks();
    const Run* other = risks.empty() ? nullptr : other_snow_among(corners, maker, last_of);
    if (!other) return look;
    std::vector<std::string> settings;
    for (const scene::Override& setting : other->settings)
      settings.push_back(setting.address + "=" + setting.value);
    kept += fmt::format("{}{} {}: with {} it would make other snow", kept.empty() ? "" : "; ",
                        joined(risks, " and "), risks.size() == 1 ? "stays" : "stay",
                        joined(settings, ", "));
    chosen.insert(chosen.end(), risks.begin(), risks.end());
  }
}

/// The time of the fork; empty where there is none, see is_forked.
std::optional<double> fork_time(const SweepOptions& options, const read::Sweep& sweep) {
  if (!is_forked(options, sweep)) return std::nullopt;
  if (options.fork) return options.fork;
  if (options.from) return options.from;
  if (options.predicts)
    sweep.fail("sweep.fork", "sweep.fork cannot be combined with --predict",
               "copies are simulated from the start: remove one of them");
  if (options.refine > 0 || !options.refine_runs.empty())
    sweep.fail("sweep.fork",
               std::string("sweep.fork cannot be combined with ") +
                   (options.refine > 0 ? "--refine" : "--refine-runs"),
               "a run keeps its cells while it runs: remove one of them");
  try {
    return options::time().read("--fork", sweep.settings.fork);
  } catch (const UsageError& error) {
    sweep.fail("sweep.fork", "sweep.fork = \"" + sweep.settings.fork + "\" is not a time",
               "expected seconds, as in fork = \"0.8s\"");
  }
}

PlannedRun planned(Run run, scene::Scene scene, setup::Quality quality) {
  const setup::Plan needs =
      setup::make_plan(scene, setup::frames_of(scene, run.frames), quality, 1);
  run.particles = needs.particles;
  run.memory = static_cast<double>(needs.memory + program_memory);
  run.work = forecast::work_at_rest(scene, needs);
  return {std::move(run), std::move(scene), needs};
}

/// The job of the run or picture that the runs leave. @throws UsageError for another file
run::RenderJob source_job(const SweepOptions& options) {
  if (options.fork)
    throw UsageError("--fork", "cannot be combined with --from",
                     "--from forks an existing run or picture, --fork forks a scene");
  std::error_code error;
  if (!std::filesystem::exists(options.file, error))
    throw UsageError("--from", options.file + " does not exist",
                     "expected the folder of a run, or a picture made by neve");
  if (!timeline::is_folder(options.file) && !record::is_picture(options.file))
    throw UsageError("--from",
                     options.file + " is not the folder of a run, nor a picture made by neve",
                     fmt::format("for a scene or a sweep file, give --fork {}s", *options.from));
  run::RenderOptions render;
  render.scene = options.file;
  render.from = options.from;
  render.overrides = options.overrides;
  render.coarsening = options.coarsening;
  render.is_fast = options.is_fast;
  render.frames = options.frames;
  render.is_agreed = options.is_agreed;
  render.dry_run = options.is_dry_run;
  return run::make_job(render);
}

read::Sweep sweep_of(const SweepOptions& options, const std::optional<run::RenderJob>& source) {
  const read::SweepChanges changes{options.axes, options.overrides,
                                   options.fork.has_value() || source.has_value(), options.seeds};
  if (!source && !options.text.empty())
    return read::parse_sweep(options.text, options.file, changes);
  if (!source) return read::read_sweep(options.file, changes);
  read::Sweep sweep = read::parse_sweep("", options.file, changes);
  sweep.name = source->folder.filename().string();
  return sweep;
}

/// Returns the axis that an address or label means; -1: none is named.
int axis_called(const read::Sweep& sweep, const char* key, const std::string& wanted) {
  if (wanted.empty()) return -1;
  if (sweep.settings.method != read::Method::grid)
    sweep.fail(key,
               fmt::format("{} is not for method \"{}\", whose runs lie along no axis", key,
                           scene::name(sweep.settings.method)),
               "remove it; only a grid has columns and rows");
  std::vector<std::string> known;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a)
    for (const read::Axis::Parameter& parameter : sweep.axes[a].parameters) {
      if (parameter.address == wanted || parameter.label == wanted) return static_cast<int>(a);
      known.push_back(parameter.address);
    }
  sweep.fail(key, fmt::format("{} = \"{}\": no such axis", key, wanted),
             known.empty() ? "the sweep has no axes" : "expected " + scene::list_of(known));
}

/// The coarse copies by which a point is predicted. @throws UsageError where one cannot be
std::vector<PlannedVariant> copies_of(const SceneMaker& maker, const PlannedRun& point,
                                      setup::Quality quality) {
  const scene::Scene full = maker.make_full(point.run.settings);
  if (const std::string why = predict::why_not(full); !why.empty()) throw UsageError("", why);
  std::vector<PlannedVariant> copies;
  for (const predict::CopyPlan& plan : predict::copy_plans)
    for (int k = 0; k < plan.seeds; ++k) {
      scene::Scene scene =
          predict::copy_of(full, plan.coarsening, full.seed + static_cast<std::uint64_t>(k));
      Run run;
      run.label = fmt::format("copy of run {} with --coarsen {} and seed {}", point.run.index,
                              rough_text(plan.coarsening), scene.seed);
      run.settings = point.run.settings;
      run.settings.push_back({"seed", std::to_string(scene.seed), "--predict"});
      run.frames = {scene::number_of(scene, 0), point.run.frames.last};
      maker.prepare(scene);
      copies.push_back({static_cast<std::size_t>(point.run.index), plan.coarsening,
                        planned(std::move(run), std::move(scene), quality), ""});
    }
  return copies;
}

void plan_copies(const SceneMaker& maker, SweepPlan& plan) {
  const auto seeds = static_cast<std::size_t>(plan.sweep.runs_per_point());
  for (std::size_t k = 0; k < plan.runs.size(); k += seeds) {
    std::vector<PlannedVariant> copies;
    try {
      copies = copies_of(maker, plan.runs[k], plan.quality);
    } catch (const UsageError& error) {
      copies = {{k, 1, {}, error.what()}};
    }
    for (PlannedVariant& copy : copies) {
      copy.item.run.index = static_cast<int>(plan.runs.size() + plan.variants.size());
      plan.variants.push_back(std::move(copy));
    }
  }
}

/// The common beginning of the runs with the seed of this one.
PlannedRun beginning_for(const PlannedRun& item, int number, const SweepPlan& plan) {
  Run beginning;
  beginning.index = static_cast<int>(plan.beginnings.size());
  beginning.label = "the common beginning";
  beginning.frames = {number, number};
  if (plan.source) return planned(std::move(beginning), plan.source->scene, plan.quality);
  scene::Scene scene = plan.base;
  if (plan.sweep.settings.seeds > 0) {
    scene.seed = item.scene.seed;
    beginning.label += fmt::format(" with seed {}", scene.seed);
  }
  return planned(std::move(beginning), std::move(scene), plan.quality);
}

/// Takes the common beginning off the runs. @throws UsageError where they cannot have one
void share_beginning(double time, SweepPlan& plan) {
  const char* flag = plan.source ? "--from" : "--fork";
  const int frame = timeline::frame_at(time, plan.base.fps);
  run::require_whole_frame(plan.base, time, flag);
  plan.fork = time;
  const int start = scene::number_of(plan.base, 0), number = start + frame;
  const auto seeds = static_cast<std::size_t>(plan.sweep.runs_per_point());
  for (std::size_t k = 0; k < std::min(seeds, plan.runs.size()); ++k)
    plan.beginnings.push_back(beginning_for(plan.runs[k], number, plan));
  for (PlannedRun& item : plan.runs) {
    scene::Scene before = plan.base;
    before.seed = plan.source ? before.seed : plan.beginning_of(item.run).scene.seed;
    timeline::require_live(before, item.scene, flag);
    setup::FrameRange& frames = item.run.frames;
    if (frames.last <= number)
      throw UsageError(flag,
                       "the runs fork at frame " + std::to_string(number) +
                           ", and their last frame is " + std::to_string(frames.last),
                       "expected an earlier time, or later frames with --frames");
    item.run.work *= static_cast<double>(frames.last - number) / (frames.last - start);
    frames.first = std::max(frames.first, number + 1);
  }
}

}  // namespace

SweepPlan plan_sweep(const SweepOptions& options) {
  SweepPlan plan;
  if (options.from) plan.source = source_job(options);
  plan.sweep = sweep_of(options, plan.source);
  plan.keeps_states = options.keeps_states || plan.sweep.settings.keep_states;
  plan.quality = options.quality;
  if (plan.source) prepare_view(options, plan.sweep, plan.source->scene);
  refuse_two_frames(options, plan.sweep);
  plan.folder =
      options.out.empty() ? out_folder() / (plan.sweep.name + ".cdb") : fs::path(options.out);
  if (options.wrap > 0) plan.sweep.sheet.wrap = options.wrap;
  plan.columns = axis_called(plan.sweep, "sheet.columns", plan.sweep.sheet.columns);
  plan.rows = axis_called(plan.sweep, "sheet.rows", plan.sweep.sheet.rows);
  const SceneMaker maker(options, plan.sweep, plan.source);
  plan.base = maker.make_base();
  if (options.is_fast) {
    plan.fast = take_fast_look(options, maker, plan.base, plan.sweep);
    plan.base = maker.make_base();
  }
  plan.view = plan.base.views.front().name;
  plan.title = plan.sweep.settings.title;
  if (plan.title.empty()) plan.title = plan.base.title;
  if (plan.title.empty()) plan.title = plan.sweep.name;
  std::vector<Run> runs = expand(plan.sweep);
  if (const int seeds = plan.sweep.settings.seeds; seeds > 0)
    runs = with_seeds(runs, plan.base.seed, seeds);
  for (Run& run : runs) {
    scene::Scene scene = maker.make(run.settings);
    run.frames = setup::numbers_of(scene, frames_of(options, plan.sweep, scene, plan.source));
    plan.runs.push_back(planned(std::move(run), std::move(scene), plan.quality));
  }
  plan.coarsening = options.coarsening.value_or(1);
  if (options.predicts) plan_copies(maker, plan);
  if (const auto time = fork_time(options, plan.sweep)) share_beginning(*time, plan);
  if (plan.source) plan.source->fork->changes.clear();  // the runs make them
  return plan;
}

double work_ratio(const SweepPlan& plan, double coarsening) {
  return std::pow(plan.coarsening / coarsening, 4);
}

void add_full_runs(const SweepOptions& options, const std::vector<std::size_t>& points,
                   SweepPlan& plan) {
  const SceneMaker maker(options, plan.sweep, plan.source);
  const auto seeds = static_cast<std::size_t>(plan.sweep.runs_per_point());
  // First seeds first: then the sheet, which shows these, is soon complete.
  for (std::size_t draw = 0; draw < seeds; ++draw)
    for (const std::size_t point : points) {
      const Run& coarse = plan.runs[point + draw].run;
      scene::Scene scene = maker.make_full(coarse.settings);
      maker.prepare(scene);
      Run run;
      run.label = fmt::format("run {} at full resolution", coarse.index);
      run.settings = coarse.settings;
      run.frames = coarse.frames;
      PlannedVariant full{point + draw, 1, planned(std::move(run), std::move(scene), plan.quality),
                          ""};
      full.item.run.index = static_cast<int>(plan.runs.size() + plan.variants.size());
      plan.variants.push_back(std::move(full));
    }
}

std::vector<int> axis_sizes(const SweepPlan& plan) {
  std::vector<int> sizes;
  for (const read::Axis& axis : plan.sweep.axes) sizes.push_back(static_cast<int>(axis.size()));
  return sizes;
}

std::string seeds_text(const read::Sweep& sweep) {
  const int seeds = sweep.settings.seeds;
  return seeds > 0 ? fmt::format(", {} seeds of each point", seeds) : "";
}

std::vector<int> draws_of(const SweepPlan& plan) {
  std::vector<int> draws;
  for (const PlannedRun& item : plan.runs)
    draws.push_back(item.run.index % plan.sweep.runs_per_point());
  return draws;
}

double bytes_of_states(const PlannedRun& item) {
  return run::state_bytes_per_particle * item.run.particles * item.run.frames.count();
}

double bytes_of_states(const SweepPlan& plan) {
  double bytes = 0;
  for (const PlannedRun& item : plan.runs) bytes += bytes_of_states(item);
  for (const PlannedVariant& variant : plan.variants)
    if (variant.failure.empty()) bytes += bytes_of_states(variant.item);
  return bytes;
}

}  // namespace neve::app::sweep::plan
