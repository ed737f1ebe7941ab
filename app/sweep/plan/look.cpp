#include "app/sweep/plan/look.h"

#include <algorithm>
#include <future>
#include <system_error>

#include "app/output/atomic_file.h"
#include "app/run/run_json.h"
#include "app/scene/names.h"
#include "app/scene/read.h"
#include "app/setup/coarse_run.h"
#include "app/setup/resolve.h"
#include "app/support/interrupt.h"
#include "app/sweep/plan/order.h"
#include "sim/base/hash.h"

namespace neve::app::sweep::plan {

namespace {

/// Dry runs take part of a second each; the corners come first and show the extremes.
constexpr std::size_t most_dry_runs = 8;

/// A range and what it is a range of: only equal ones are shared.
struct RangeSlot {
  std::optional<scene::Range>* range;
  std::string of;
};

std::vector<RangeSlot> range_slots(scene::View& view) {
  return {{&view.particles.range, scene::name_of(view.particles.color_by)},
          {&view.smoke.range, scene::name_of(view.smoke.field)},
          {&view.slice.range, scene::name_of(view.slice.field)},
          {&view.slice.scalar_range, scene::name_of(view.slice.scalar)},
          {&view.plots.energy, "energy"},
          {&view.plots.speed, "speed"},
          {&view.plots.dt, "dt"}};
}

/// Widens the look's ranges by those that were found for a run.
/// @param own the run's view before: its own settings apply to no other run
void widen(scene::View& look, scene::View own, scene::View resolved, const scene::View& base) {
  scene::View given = base;
  const std::vector<RangeSlot> shared = range_slots(look), mine = range_slots(own),
                               found = range_slots(resolved), fixed = range_slots(given);
  for (std::size_t k = 0; k < shared.size(); ++k) {
    if (*fixed[k].range || *mine[k].range || !*found[k].range || mine[k].of != shared[k].of)
      continue;
    std::optional<scene::Range>& range = *shared[k].range;
    const scene::Range& other = **found[k].range;
    range = range ? scene::Range{std::min(range->min, other.min), std::max(range->max, other.max)}
                  : other;
  }
}

/// Takes the values that the run leaves open from the look.
void apply(const scene::Scene& look, scene::Scene& scene) {
  if (setup::needs_framing(scene)) {
    if (!scene.camera || !scene.camera->eye) {
      const scene::CameraSettings own = scene.camera.value_or(scene::CameraSettings{});
      if (look.camera && own.keyframes.empty() && own.fov == look.camera->fov &&
          own.up == look.camera->up)
        scene.camera = look.camera;
    }
    if (!scene.views[0].camera) scene.views[0].camera = look.views[0].camera;
  }
  scene::View from = look.views[0];
  const std::vector<RangeSlot> shared = range_slots(from), own = range_slots(scene.views[0]);
  for (std::size_t k = 0; k < own.size(); ++k)
    if (!*own[k].range && own[k].of == shared[k].of) *own[k].range = *shared[k].range;
}

std::vector<std::vector<int>> coordinates_of(const SweepPlan& plan) {
  std::vector<std::vector<int>> places;
  for (const RunPlan& item : plan.runs) places.push_back(item.run.coordinates);
  return places;
}

std::vector<int> axis_sizes(const SweepPlan& plan) {
  std::vector<int> sizes;
  for (const read::Axis& axis : plan.sweep.axes) sizes.push_back(static_cast<int>(axis.size()));
  return sizes;
}

std::vector<setup::Moment> moments_of_corners(const SweepPlan& plan, int cores) {
  std::vector<const scene::Scene*> scenes;
  for (const std::size_t k : coarse_first(coordinates_of(plan), axis_sizes(plan)))
    if (scenes.size() < most_dry_runs && setup::needs_framing(plan.runs[k].scene))
      scenes.push_back(&plan.runs[k].scene);
  std::vector<setup::Moment> moments;
  const auto together = static_cast<std::size_t>(std::max(1, cores));
  for (std::size_t first = 0; first < scenes.size(); first += together) {
    std::vector<std::future<std::vector<setup::Moment>>> runs;
    for (std::size_t k = first; k < std::min(first + together, scenes.size()); ++k)
      runs.push_back(std::async(std::launch::async,
                                [scene = scenes[k]] { return setup::coarse_run(*scene); }));
    for (auto& run : runs)
      for (setup::Moment& moment : run.get()) moments.push_back(std::move(moment));
  }
  std::stable_sort(moments.begin(), moments.end(),
                   [](const setup::Moment& a, const setup::Moment& b) { return a.time < b.time; });
  return moments;
}

scene::Scene find_look(const SweepPlan& plan, int cores) {
  scene::Scene look = plan.base;
  if (setup::needs_framing(look)) setup::resolve_cameras(look, moments_of_corners(plan, cores));
  for (const RunPlan& item : plan.runs) {
    scene::Scene resolved = item.scene;
    setup::resolve_ranges(resolved, static_cast<std::size_t>(item.plan.particles));
    widen(look.views[0], item.scene.views[0], resolved.views[0], plan.base.views[0]);
  }
  return look;
}

/// Identity of the sweep for which the look was computed. Axes are excluded, because they may grow.
std::string mark_of(const SweepPlan& plan) {
  const std::string text = scene::write_scene(plan.base);
  return "# Camera and colour ranges of all runs. Of scene " +
         run::hash_text(hash_bytes(text.data(), text.size())) + "\n";
}

}  // namespace

std::filesystem::path look_path(const std::filesystem::path& folder) {
  return folder / "look.toml";
}

void share_look(SweepPlan& plan, int cores) {
  const std::filesystem::path file = look_path(plan.folder);
  const std::string mark = mark_of(plan);
  std::error_code error;
  std::optional<scene::Scene> look;
  if (std::filesystem::is_regular_file(file, error)) {
    const std::string text = scene::read_toml_file(file.string());
    if (text.starts_with(mark)) look = scene::read_scene_text(text, file.string());
  }
  if (!look) {
    look = find_look(plan, cores);
    // A framing that was cut short is another one.
    if (is_interrupted()) return;
    output::make_folder(plan.folder);
    output::write_file(file, mark + scene::write_scene(*look));
  }
  for (RunPlan& item : plan.runs) {
    apply(*look, item.scene);
    setup::resolve(item.scene, static_cast<std::size_t>(item.plan.particles));
  }
}

}  // namespace neve::app::sweep::plan
