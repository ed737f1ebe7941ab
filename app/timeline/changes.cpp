#include "app/timeline/changes.h"

#include <algorithm>
#include <set>

#include "app/scene/flat.h"
#include "app/scene/override.h"
#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::timeline {

namespace {

/// Overrides from changes: of two changes to one address, only the later one has an effect, and
/// none inside of an object that comes or goes as a whole later. Whole objects come and go as they
/// did, which gives each its place in its list.
std::vector<scene::Override> overrides_of(const std::vector<scene::LiveChange>& changes,
                                          std::size_t count) {
  std::vector<scene::Override> overrides;
  std::set<std::string> later;
  for (std::size_t k = count; k-- > 0;) {
    const scene::LiveChange& change = changes[k];
    const bool is_object = scene::is_object_address(change.address);
    if (!is_object && later.contains(scene::object_of(change.address))) continue;
    if (!later.insert(change.address).second && !is_object) continue;
    scene::Override override{change.address, change.value};
    override.flag = "change at step " + std::to_string(change.step) + ":";
    overrides.push_back(std::move(override));
  }
  std::reverse(overrides.begin(), overrides.end());
  return overrides;
}

/// True for the address of a view or mosaic that the scene does not have.
bool is_drawn_nowhere(const scene::Scene& scene, const std::string& address) {
  const auto has = [&](const auto& items, const std::string& prefix) {
    return std::any_of(items.begin(), items.end(), [&](const auto& item) {
      return address.starts_with(prefix + item.name + ".");
    });
  };
  if (address.starts_with("view.")) return !has(scene.views, "view.");
  return address.starts_with("mosaic.") && !has(scene.mosaics, "mosaic.");
}

/// Addresses that may change while a simulation runs and concern it; of shapes and keyframes, which
/// have many, the part that they share.
std::string live_addresses() {
  std::vector<std::string> addresses;
  for (const scene::ParamInfo& param : scene::params()) {
    if (!param.is_live || !scene::concerns_simulation(param.address)) continue;
    std::string address = param.address;
    for (const char* part : {".shape.", ".keyframes"})
      if (const std::size_t at = address.find(part); at != std::string::npos)
        address = address.substr(0, at + std::string(part).size()) + "...";
    if (addresses.empty() || addresses.back() != address) addresses.push_back(address);
  }
  return joined(addresses, ", ");
}

}  // namespace

std::size_t count_until(const std::vector<scene::LiveChange>& changes, std::size_t steps) {
  const auto later = std::ranges::find_if(
      changes, [&](std::size_t step) { return step > steps; }, &scene::LiveChange::step);
  return static_cast<std::size_t>(later - changes.begin());
}

scene::Scene with_first_changes(const scene::Scene& start,
                                const std::vector<scene::LiveChange>& changes, std::size_t count) {
  return scene::apply(start, overrides_of(changes, count), "the scene of the run");
}

scene::Scene with_changes(const scene::Scene& start, const std::vector<scene::LiveChange>& changes,
                          std::size_t up_to_step) {
  return with_first_changes(start, changes, count_until(changes, up_to_step));
}

std::vector<scene::LiveChange> changes_of(const scene::Scene& scene,
                                          std::vector<scene::LiveChange> changes) {
  std::erase_if(changes, [&](const scene::LiveChange& change) {
    return is_drawn_nowhere(scene, change.address);
  });
  return changes;
}

scene::Scene recorded_scene(const scene::Scene& start, const scene::Scene& now) {
  scene::Scene scene = now;
  scene.solver = start.solver;
  scene.materials = start.materials;
  scene.bodies = start.bodies;
  scene.emitters = start.emitters;
  scene.sinks = start.sinks;
  scene.curves = start.curves;
  scene.fps = start.fps;
  scene.seed = start.seed;
  scene.colliders = start.colliders;
  for (scene::Collider& collider : scene.colliders)
    for (const scene::Collider& other : now.colliders)
      if (other.name == collider.name) collider.style = other.style;
  return scene;
}

void require_live(const scene::Scene& before, const scene::Scene& after, const char* flag) {
  std::vector<scene::Difference> restart = scene::split_live(before, after).restart;
  std::erase_if(restart,
                [](const scene::Difference& d) { return !scene::concerns_simulation(d.address); });
  if (restart.empty()) return;
  std::vector<std::string> names;
  for (const scene::Difference& d : restart) names.push_back(d.address);
  throw UsageError(flag, joined(names, ", ") + " cannot change while a simulation runs",
                   "parameters that can: " + live_addresses());
}

scene::Scene in_order_of(const scene::Scene& before, scene::Scene after) {
  std::ranges::stable_sort(after.colliders, {}, [&](const scene::Collider& collider) {
    return std::ranges::find(before.colliders, collider.name, &scene::Collider::name);
  });
  return after;
}

void follow_colliders(const sim::Simulation& simulation, scene::Scene& scene) {
  const std::vector<sim::shapes::Collider> colliders = simulation.colliders();
  for (std::size_t k = 0; k < std::min(colliders.size(), scene.colliders.size()); ++k)
    scene.colliders[k].pose_offset = colliders[k].pose_offset;
}

}  // namespace neve::app::timeline
