#include "app/changes.h"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "app/resolve.h"
#include "app/scene/flat.h"
#include "app/scene/read.h"

namespace neve::app {

namespace {

constexpr std::size_t no_step = std::numeric_limits<std::size_t>::max();

/// Of two changes to one address the earlier one has no effect on the scene.
std::vector<Override> overrides_of(const std::vector<LiveChange>& changes, std::size_t count) {
  std::vector<Override> overrides;
  std::set<std::string> later;
  for (std::size_t k = count; k-- > 0;) {
    const LiveChange& change = changes[k];
    if (!later.insert(change.address).second) continue;
    Override override{change.address, change.value};
    override.flag = "change at step " + std::to_string(change.step) + ":";
    overrides.push_back(std::move(override));
  }
  std::reverse(overrides.begin(), overrides.end());
  return overrides;
}

Scene read_with(const SceneSource& source, const std::vector<LiveChange>& changes,
                std::size_t count) {
  std::vector<Override> overrides = source.overrides;
  for (Override& override : overrides_of(changes, count)) overrides.push_back(std::move(override));
  return read_scene_text(source.text, source.name, source.base_dir, overrides);
}

/// Of a view or mosaic that the scene does not have.
bool is_drawn_nowhere(const Scene& scene, const std::string& address) {
  const auto has = [&](const auto& items, const std::string& prefix) {
    return std::any_of(items.begin(), items.end(), [&](const auto& item) {
      return address.starts_with(prefix + item.name + ".");
    });
  };
  if (address.starts_with("view.")) return !has(scene.views, "view.");
  return address.starts_with("mosaic.") && !has(scene.mosaics, "mosaic.");
}

}  // namespace

Json to_json(const std::vector<LiveChange>& changes) {
  Json list = Json::array();
  for (const LiveChange& change : changes)
    list.push_back({{"step", change.step}, {"address", change.address}, {"value", change.value}});
  return list;
}

std::vector<LiveChange> live_changes(const Json& json) {
  std::vector<LiveChange> changes;
  if (!json.is_array()) throw std::runtime_error("the changes are no list");
  for (const Json& item : json) {
    const bool is_change = item.is_object() && item.contains("step") && item.contains("address") &&
                           item.contains("value") && item["step"].is_number_unsigned() &&
                           item["address"].is_string() && item["value"].is_string();
    if (!is_change) throw std::runtime_error("a change is not made of step, address and value");
    changes.push_back({item["step"].get<std::size_t>(), item["address"].get<std::string>(),
                       item["value"].get<std::string>()});
    const LiveChange& change = changes.back();
    if (!is_live(change.address))
      throw std::runtime_error("nothing that may change while a simulation runs is called \"" +
                               change.address + "\"");
    if (changes.size() > 1 && change.step < changes[changes.size() - 2].step)
      throw std::runtime_error("the steps of the changes go back");
  }
  return changes;
}

std::string text_of(const LiveChange& change) {
  return "step " + std::to_string(change.step) + ": " + change.address + " = " + change.value;
}

void note_change(std::vector<LiveChange>& changes, LiveChange change) {
  const auto is_same = [&](const LiveChange& other) {
    return other.step == change.step && other.address == change.address;
  };
  const std::size_t count = changes.size();
  if (count >= 2 && is_same(changes[count - 1]) && is_same(changes[count - 2])) changes.pop_back();
  changes.push_back(std::move(change));
}

void forget_changes_after(std::vector<LiveChange>& changes, std::size_t step) {
  std::erase_if(changes, [&](const LiveChange& change) { return change.step > step; });
}

Scene with_changes(const SceneSource& source, const std::vector<LiveChange>& changes,
                   std::size_t up_to_step) {
  const auto later = std::find_if(changes.begin(), changes.end(), [&](const LiveChange& change) {
    return change.step > up_to_step;
  });
  return read_with(source, changes, static_cast<std::size_t>(later - changes.begin()));
}

Scene recorded_scene(const Scene& start, const Scene& now) {
  Scene scene = now;
  scene.solver = start.solver;
  scene.materials = start.materials;
  scene.bodies = start.bodies;
  scene.emitters = start.emitters;
  scene.sinks = start.sinks;
  scene.fps = start.fps;
  scene.seed = start.seed;
  scene.colliders = start.colliders;
  for (Collider& collider : scene.colliders)
    for (const Collider& other : now.colliders)
      if (other.name == collider.name) collider.style = other.style;
  return scene;
}

void follow_colliders(const sim::Simulation& simulation, Scene& scene) {
  const std::vector<sim::Collider> colliders = simulation.colliders();
  for (std::size_t k = 0; k < std::min(colliders.size(), scene.colliders.size()); ++k)
    scene.colliders[k].travel = colliders[k].travel;
}

void apply_scene(Scene& scene, sim::Simulation& simulation) {
  simulation.apply(scene.solver, scene.materials, sim_colliders(scene));
  follow_colliders(simulation, scene);
}

std::vector<LiveChange> changes_of(const Scene& scene, std::vector<LiveChange> changes) {
  std::erase_if(changes,
                [&](const LiveChange& change) { return is_drawn_nowhere(scene, change.address); });
  return changes;
}

ChangePlayer::ChangePlayer(const Scene& start, std::vector<LiveChange> changes,
                           sim::Simulation& simulation,
                           std::function<void(const Scene&)> after_each)
    : changes_(changes_of(start, std::move(changes))),
      simulation_(simulation),
      after_each_(std::move(after_each)),
      scene_(start) {
  if (!changes_.empty()) source_ = {write_scene(start), "the scene of the run", {}, {}};
}

void ChangePlayer::make(std::size_t end) {
  scene_ = read_with(source_, changes_, end);
  resolve_ranges(scene_, simulation_.particle_count());
  made_ = end;
  apply_scene(scene_, simulation_);
  if (after_each_) after_each_(scene_);
}

/// Changes of one step at once, but a second one to an address after the first: both leave a trace.
void ChangePlayer::make_due() {
  const auto is_due = [&](std::size_t k) {
    return k < changes_.size() && changes_[k].step <= simulation_.steps();
  };
  while (is_due(made_)) {
    std::size_t end = made_;
    std::set<std::string> addresses;
    while (is_due(end) && changes_[end].step == changes_[made_].step &&
           addresses.insert(changes_[end].address).second)
      ++end;
    make(end);
  }
}

void ChangePlayer::go_to(std::size_t steps) {
  std::size_t end = 0;
  while (end < changes_.size() && changes_[end].step <= steps) ++end;
  if (end > 0) make(end);
}

/// As far as the next change, or to the end of the frame.
sim::AdvanceReport ChangePlayer::advance(double time, bool (*interrupted)(), std::size_t last_step,
                                         std::vector<sim::Retry>& retries) {
  if (scene_.solver.on_divergence == sim::OnDivergence::stop)
    return simulation_.advance_to(time, interrupted, last_step);
  if (last_step == no_step || simulation_.dt_scale() < 1)
    return sim::advance_retrying(simulation_, time, interrupted, retries);
  // While nothing breaks, steps with and without retrying are the same.
  const std::vector<std::uint8_t> good = simulation_.save();
  const sim::AdvanceReport report = simulation_.advance_to(time, interrupted, last_step);
  const bool has_broken = simulation_.divergence().has_value();
  if (!has_broken && (simulation_.time() >= time || simulation_.steps() >= last_step))
    return report;
  simulation_.restore(good);
  return has_broken ? sim::advance_retrying(simulation_, time, interrupted, retries)
                    : sim::AdvanceReport{};  // interrupted: the frame is simulated as a whole
}

sim::AdvanceReport ChangePlayer::advance_to(double time, bool (*interrupted)(),
                                            std::vector<sim::Retry>& retries) {
  sim::AdvanceReport report;
  for (;;) {
    const std::size_t next = made_ < changes_.size() ? changes_[made_].step : no_step;
    report.append(advance(time, interrupted, next, retries));
    if (simulation_.divergence()) return report;
    make_due();
    if (simulation_.time() >= time || simulation_.steps() != next) return report;
  }
}

}  // namespace neve::app
