#include "app/sweep/plan/shared_view.h"

#include <algorithm>
#include <future>
#include <numeric>
#include <system_error>

#include "app/output/atomic_file.h"
#include "app/picture/legends.h"
#include "app/record/picture_files.h"
#include "app/record/run_json.h"
#include "app/scene/flat.h"
#include "app/scene/names.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/setup/camera_path.h"
#include "app/setup/coarse_run.h"
#include "app/setup/curves.h"
#include "app/setup/resolve.h"
#include "app/support/interrupt.h"
#include "app/sweep/plan/order.h"

namespace neve::app::sweep::plan {

namespace fs = std::filesystem;

namespace {

/// Dry runs take part of a second each; the corners come first and show the extremes.
constexpr std::size_t max_dry_runs = 8;

/// A range and its quantity: only ranges of equal quantities are shared.
struct RangeSlot {
  std::optional<scene::Range>* range;
  std::string of;
};

std::vector<RangeSlot> range_slots(scene::View& view) {
  return {{&view.particles.range, scene::name(view.particles.color_by)},
          {&view.smoke.range, scene::name(view.smoke.field)},
          {&view.slice.range, scene::name(view.slice.field)},
          {&view.slice.scalar_range, scene::name(view.slice.scalar)},
          {&view.plots.energy, "energy"},
          {&view.plots.speed, "speed"},
          {&view.plots.force, "force"},
          {&view.plots.dt, "dt"},
          {&view.plots.body_height, "height of bodies"},
          {&view.plots.body_speed, "speed of bodies"}};
}

/// Widens the shared ranges by those that were found for a run.
/// @param own the run's view before: its own settings apply to no other run
void widen(scene::View& shared, scene::View own, scene::View resolved, const scene::View& base) {
  scene::View given = base;
  const std::vector<RangeSlot> all = range_slots(shared), mine = range_slots(own),
                               found = range_slots(resolved), fixed = range_slots(given);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (*fixed[k].range || *mine[k].range || !*found[k].range || mine[k].of != all[k].of) continue;
    std::optional<scene::Range>& range = *all[k].range;
    const scene::Range& other = **found[k].range;
    range = range ? scene::Range{std::min(range->min, other.min), std::max(range->max, other.max)}
                  : other;
  }
}

bool has_same_lens(const scene::CameraSettings& a, const scene::CameraSettings& b) {
  return a.fov == b.fov && a.up == b.up;
}

/// Puts the shared camera in the place of one that has none and frames as that of the sweep's
/// scene, for which it was found: with the same lens, and following the same body. A camera keeps
/// its own turns.
/// @param base  that of the sweep's scene
void share_place(const scene::CameraSettings& base,
                 const std::optional<scene::CameraSettings>& shared,
                 std::optional<scene::CameraSettings>& camera) {
  const scene::CameraSettings own = camera.value_or(scene::CameraSettings{});
  if (!shared || setup::has_place(own) || !own.keyframes.empty() || !has_same_lens(own, base) ||
      own.push_in != base.push_in || own.follow != base.follow)
    return;
  camera = shared;
  camera->orbit = own.orbit;
  camera->turntable = own.turntable;
}

/// Fills in the automatic values of the run.
/// @param base  the sweep's scene
void apply(const scene::Scene& base, const scene::Scene& shared, scene::Scene& scene) {
  if (setup::needs_framing(scene)) {
    const scene::CameraSettings none, base_camera = base.camera.value_or(none);
    scene::View& view = scene.views[0];
    const scene::View& base_view = base.views[0];
    if (view.camera)
      share_place(base_view.camera.value_or(none), shared.views[0].camera, view.camera);
    else if (view.slice.normal == base_view.slice.normal &&
             has_same_lens(scene.camera.value_or(none), base_camera))
      view.camera = shared.views[0].camera;  // that was found for a plane, if any
    share_place(base_camera, shared.camera, scene.camera);
  }
  scene::View from = shared.views[0];
  const std::vector<RangeSlot> all = range_slots(from), own = range_slots(scene.views[0]);
  for (std::size_t k = 0; k < own.size(); ++k)
    if (!*own[k].range && own[k].of == all[k].of) *own[k].range = *all[k].range;
}

std::vector<std::vector<int>> coordinates_of(const SweepPlan& plan) {
  std::vector<std::vector<int>> places;
  for (const PlannedRun& item : plan.runs) places.push_back(item.run.coordinates);
  return places;
}

/// The scene as far as its tile shows it: all that it does is in its frames.
scene::Scene until_last_frame(const PlannedRun& item) {
  scene::Scene scene = item.scene;
  scene.frames = std::min(scene::last_frame(scene), scene::frame_of(scene, item.run.frames.last));
  scene.handles = 0;  // they are among these frames
  return scene;
}

/// Makes coarse runs of these scenes, side by side.
std::vector<std::vector<setup::CoarseMoment>> coarse_runs(const std::vector<scene::Scene>& scenes,
                                                          int cores) {
  std::vector<std::vector<setup::CoarseMoment>> found;
  const auto together = static_cast<std::size_t>(std::max(1, cores));
  for (std::size_t first = 0; first < scenes.size(); first += together) {
    std::vector<std::future<std::vector<setup::CoarseMoment>>> runs;
    for (std::size_t k = first; k < std::min(first + together, scenes.size()); ++k)
      runs.push_back(std::async(std::launch::async,
                                [scene = &scenes[k]] { return setup::coarse_run(*scene); }));
    for (auto& run : runs) found.push_back(run.get());
  }
  return found;
}

/// The moment of the sheet; the whole run where the coarse one ends long before it.
std::vector<setup::CoarseMoment> moment_of_sheet(const scene::Scene& scene,
                                                 std::vector<setup::CoarseMoment> moments) {
  constexpr double near_the_end = 0.9;
  if (moments.empty() || moments.back().time < near_the_end * scene::duration(scene))
    return moments;
  return {std::move(moments.back())};
}

std::vector<setup::CoarseMoment> moments_of_corners(const SweepPlan& plan, int cores) {
  const bool is_whole = plan.sweep.sheet.framing == read::Framing::fall;
  std::vector<scene::Scene> scenes;
  for (const std::size_t k : coarse_first(coordinates_of(plan), axis_sizes(plan), draws_of(plan)))
    if (scenes.size() < max_dry_runs && setup::needs_framing(plan.runs[k].scene))
      scenes.push_back(is_whole ? plan.runs[k].scene : until_last_frame(plan.runs[k]));
  std::vector<setup::CoarseMoment> moments;
  std::vector<std::vector<setup::CoarseMoment>> runs = coarse_runs(scenes, cores);
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (setup::CoarseMoment& moment :
         is_whole ? std::move(runs[k]) : moment_of_sheet(scenes[k], std::move(runs[k])))
      moments.push_back(std::move(moment));
  std::stable_sort(
      moments.begin(), moments.end(),
      [](const setup::CoarseMoment& a, const setup::CoarseMoment& b) { return a.time < b.time; });
  return moments;
}

/// A camera for each run that has none.
void frame_each(std::vector<PlannedRun*> items, int cores) {
  std::erase_if(items, [](const PlannedRun* item) { return !setup::needs_framing(item->scene); });
  std::vector<scene::Scene> scenes;
  for (const PlannedRun* item : items) scenes.push_back(until_last_frame(*item));
  std::vector<std::vector<setup::CoarseMoment>> runs = coarse_runs(scenes, cores);
  for (std::size_t k = 0; k < items.size(); ++k)
    setup::resolve_cameras(items[k]->scene, moment_of_sheet(scenes[k], std::move(runs[k])),
                           setup::Shown::moments);
}

scene::Scene find_shared_view(const SweepPlan& plan, int cores) {
  scene::Scene shared = plan.base;
  const read::Framing framing = plan.sweep.sheet.framing;
  if (framing != read::Framing::each && setup::needs_framing(shared))
    setup::resolve_cameras(
        shared, moments_of_corners(plan, cores),
        framing == read::Framing::fall ? setup::Shown::fall : setup::Shown::moments);
  for (const PlannedRun& item : plan.runs) {
    scene::Scene resolved = item.scene;
    setup::resolve_ranges(resolved, static_cast<std::size_t>(item.plan.particles));
    widen(shared.views[0], item.scene.views[0], resolved.views[0], plan.base.views[0]);
  }
  return shared;
}

/// Returns the changes of a forked run, so that it does and shows what was planned: --coarsen and
/// [set] have had their say in its scene, and from that of the beginning alone it would find
/// cameras and ranges anew.
/// @param before  the scene at the fork
std::vector<scene::Override> changes_of(const scene::Scene& before, const PlannedRun& item) {
  const auto is_look = [](const std::string& address) {
    return address.starts_with("camera.") || address.starts_with("view.");
  };
  std::vector<scene::Override> changes;
  bool is_seen_otherwise = false;
  for (const scene::Difference& d : scene::differences(before, item.scene)) {
    // The seed is that of its beginning, whose particles it has drawn; curves stay what they are.
    if (d.address == "seed" || (is_look(d.address) && d.address.ends_with(".found")) ||
        setup::curve_of(before, d.address))
      continue;
    changes.push_back({d.address, d.after ? scene::toml::toml_literal(*d.after) : "none"});
    is_seen_otherwise |= is_look(d.address);
  }
  if (!is_seen_otherwise) return changes;
  // A camera that is given is not found anew for the settings beside it.
  for (const scene::FlatParam& param : scene::flatten(item.scene))
    for (const char* place : {"camera.eye", "camera.target", "camera.push_in", "camera.keyframes"})
      if (param.value && is_look(param.address) && param.address.ends_with(place))
        changes.push_back({param.address, param.text()});
  return changes;
}

/// Runs that colour other values, or by another scale, cannot share the legend of the sheet: then
/// each tile has its own.
void put_legends_on_tiles(const scene::Scene& shared, SweepPlan& plan) {
  const auto legends = [](const scene::Scene& scene) {
    return picture::legends_of(scene, scene.views[0]);
  };
  plan.have_tiles_legends = std::ranges::any_of(
      plan.runs, [&](const PlannedRun& item) { return legends(item.scene) != legends(shared); });
  if (!plan.have_tiles_legends) return;
  const auto put = [](PlannedRun& item) {
    scene::View& view = item.scene.views[0];
    if (!scene::has_layer(view, scene::Layer::legend)) view.layers.push_back(scene::Layer::legend);
  };
  std::ranges::for_each(plan.runs, put);
  std::ranges::for_each(plan.beginnings, put);
  for (PlannedVariant& variant : plan.variants)
    if (variant.failure.empty()) put(variant.item);
}

/// Names the scene that the camera and ranges belong to, and what the camera holds. Axes are no
/// part of it: they may grow. Nor are the pixels of tiles, but their shape.
std::string mark_of(const SweepPlan& plan) {
  scene::Scene seen = plan.base;
  const int pixels = std::gcd(seen.size.width, seen.size.height);
  seen.size = {seen.size.width / pixels, seen.size.height / pixels};
  std::string held;
  if (plan.sweep.sheet.framing == read::Framing::each) held = ", each run by itself";
  if (plan.sweep.sheet.framing == read::Framing::sheet && !plan.runs.empty())
    held = ", at frame " + std::to_string(plan.runs.front().run.frames.last);
  return "# Camera and colour ranges of all runs. Of scene " +
         record::hash_of(scene::write_scene(seen) + record::file_lines(seen)) + held + "\n";
}

std::string as_found(const std::string& look) {
  return "# As found: " + record::hash_of(look) + "\n" + look;
}

/// True if nobody has written into the look since it was found.
bool is_as_found(const std::string& text) {
  const std::size_t mark_end = text.find('\n') + 1, look = text.find('\n', mark_end) + 1;
  return text.substr(mark_end) == as_found(text.substr(look));
}

/// Puts a look that a person may have written aside. Shards come here together: it stays what they
/// all have read.
fs::path put_aside(const fs::path& folder, const std::string& look) {
  const fs::path aside = folder / ("look_" + record::hash_of(look) + ".toml");
  output::write_file(aside, look);
  return aside;
}

}  // namespace

fs::path shared_view_path(const fs::path& folder) {
  return folder / "look.toml";
}

fs::path share_camera_and_ranges(SweepPlan& plan, int cores) {
  const fs::path file = shared_view_path(plan.folder);
  const std::string mark = mark_of(plan);
  std::error_code error;
  std::optional<scene::Scene> shared;
  std::string earlier;
  if (fs::is_regular_file(file, error)) earlier = scene::read_toml_file(file.string());
  if (earlier.starts_with(mark)) shared = scene::read_scene_text(earlier, file.string());
  fs::path aside;
  if (!shared) {
    shared = find_shared_view(plan, cores);
    // A framing that was cut short is another one.
    if (is_interrupted()) return aside;
    output::make_folder(plan.folder);
    if (!earlier.empty() && !is_as_found(earlier)) aside = put_aside(plan.folder, earlier);
    output::write_file(file, mark + as_found(scene::write_scene(*shared)));
  }
  if (plan.sweep.sheet.framing == read::Framing::each) {
    std::vector<PlannedRun*> items;
    for (PlannedRun& item : plan.runs) items.push_back(&item);
    for (PlannedVariant& variant : plan.variants)
      if (variant.failure.empty()) items.push_back(&variant.item);
    frame_each(std::move(items), cores);
  }
  const auto complete = [&](PlannedRun& item) {
    apply(plan.base, *shared, item.scene);
    setup::resolve(item.scene, static_cast<std::size_t>(item.plan.particles));
  };
  for (PlannedRun& item : plan.runs) complete(item);
  for (PlannedVariant& variant : plan.variants)
    if (variant.failure.empty()) complete(variant.item);
  for (PlannedRun& item : plan.beginnings) complete(item);
  put_legends_on_tiles(*shared, plan);
  if (plan.beginnings.empty()) return aside;
  PlannedRun before = plan.beginnings.front();
  if (plan.source) {  // which may have changed on its way to the fork
    before.scene = plan.base;
    complete(before);
  }
  for (PlannedRun& item : plan.runs) item.run.changes = changes_of(before.scene, item);
  return aside;
}

}  // namespace neve::app::sweep::plan
