#include "app/run/changes.h"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "app/scene/flat.h"
#include "app/scene/read.h"
#include "app/setup/resolve.h"

namespace neve::app::run {

namespace {

constexpr std::size_t no_step = std::numeric_limits<std::size_t>::max();

/// Number of changes, from the first, that are made once so many steps are taken.
std::size_t count_until(const std::vector<scene::LiveChange>& changes, std::size_t steps) {
  const auto later =
      std::find_if(changes.begin(), changes.end(),
                   [&](const scene::LiveChange& change) { return change.step > steps; });
  return static_cast<std::size_t>(later - changes.begin());
}

/// Overrides from changes: of two changes to one address, only the later one has an effect.
std::vector<scene::Override> overrides_of(const std::vector<scene::LiveChange>& changes,
                                          std::size_t count) {
  std::vector<scene::Override> overrides;
  std::set<std::string> later;
  for (std::size_t k = count; k-- > 0;) {
    const scene::LiveChange& change = changes[k];
    if (!later.insert(change.address).second) continue;
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

}  // namespace

scene::Scene with_changes(const scene::Scene& start, const std::vector<scene::LiveChange>& changes,
                          std::size_t up_to_step) {
  return scene::apply(start, overrides_of(changes, count_until(changes, up_to_step)),
                      "the scene of the run");
}

scene::Scene recorded_scene(const scene::Scene& start, const scene::Scene& now) {
  scene::Scene scene = now;
  scene.solver = start.solver;
  scene.materials = start.materials;
  scene.bodies = start.bodies;
  scene.emitters = start.emitters;
  scene.sinks = start.sinks;
  scene.fps = start.fps;
  scene.seed = start.seed;
  scene.colliders = start.colliders;
  for (scene::Collider& collider : scene.colliders)
    for (const scene::Collider& other : now.colliders)
      if (other.name == collider.name) collider.style = other.style;
  return scene;
}

void follow_colliders(const sim::Simulation& simulation, scene::Scene& scene) {
  const std::vector<sim::shapes::Collider> colliders = simulation.colliders();
  for (std::size_t k = 0; k < std::min(colliders.size(), scene.colliders.size()); ++k)
    scene.colliders[k].pose_offset = colliders[k].pose_offset;
}

void apply_scene(scene::Scene& scene, sim::Simulation& simulation) {
  simulation.apply(scene.solver, scene.materials, scene::sim_colliders(scene));
  follow_colliders(simulation, scene);
}

std::vector<scene::LiveChange> changes_of(const scene::Scene& scene,
                                          std::vector<scene::LiveChange> changes) {
  std::erase_if(changes, [&](const scene::LiveChange& change) {
    return is_drawn_nowhere(scene, change.address);
  });
  return changes;
}

ChangePlayer::ChangePlayer(const scene::Scene& start, std::vector<scene::LiveChange> changes,
                           sim::Simulation& simulation,
                           std::function<void(const scene::Scene&)> after_each)
    : start_(start),
      changes_(changes_of(start, std::move(changes))),
      simulation_(simulation),
      after_each_(std::move(after_each)),
      scene_(std::make_shared<scene::Scene>(start)) {}

void ChangePlayer::make(std::size_t end) {
  auto scene = std::make_shared<scene::Scene>(
      scene::apply(start_, overrides_of(changes_, end), "the scene of the run"));
  setup::resolve_ranges(*scene, simulation_.particle_count());
  made_ = end;
  apply_scene(*scene, simulation_);
  scene_ = std::move(scene);
  if (after_each_) after_each_(*scene_);
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
  if (const std::size_t end = count_until(changes_, steps); end > 0) make(end);
}

void ChangePlayer::make_now(std::shared_ptr<const scene::Scene> scene) {
  simulation_.apply(scene->solver, scene->materials, scene::sim_colliders(*scene));
  // Compares the values of the simulation, not the typed ones: they differ in a coarsened scene.
  for (const scene::Difference& change : scene::differences(*scene_, *scene))
    if (change.is_live && scene::concerns_simulation(change.address))
      scene::note_change(changes_,
                         {simulation_.steps(), change.address,
                          change.after ? scene::toml::toml_literal(*change.after) : "none"});
  made_ = changes_.size();
  scene_ = std::move(scene);
}

void ChangePlayer::go_to(std::size_t steps, std::shared_ptr<const scene::Scene> scene) {
  made_ = count_until(changes_, steps);
  scene_ = std::move(scene);
}

void ChangePlayer::forget_later() {
  scene::forget_changes_after(changes_, simulation_.steps());
  made_ = std::min(made_, changes_.size());
}

/// As far as the next change, or to the end of the frame.
sim::AdvanceReport ChangePlayer::advance(double time, const sim::StepObserver& after_step,
                                         std::size_t last_step, std::vector<sim::Retry>& retries) {
  if (scene_->solver.on_divergence != sim::OnDivergence::retry)
    return simulation_.advance_to(time, after_step, last_step);
  if (last_step == no_step || simulation_.dt_scale() < 1)
    return sim::advance_retrying(simulation_, time, after_step, retries);
  // While nothing breaks, steps with and without retrying are the same.
  const std::vector<std::uint8_t> good = simulation_.save();
  const sim::AdvanceReport report = simulation_.advance_to(time, after_step, last_step);
  const bool has_broken = simulation_.divergence().has_value();
  if (!has_broken && (simulation_.time() >= time || simulation_.steps() >= last_step))
    return report;
  simulation_.restore(good);
  return has_broken ? sim::advance_retrying(simulation_, time, after_step, retries)
                    : sim::AdvanceReport{};  // interrupted: the frame is simulated as a whole
}

sim::AdvanceReport ChangePlayer::advance_to(double time, const sim::StepObserver& after_step,
                                            std::vector<sim::Retry>& retries) {
  sim::AdvanceReport report;
  for (;;) {
    const std::size_t next = made_ < changes_.size() ? changes_[made_].step : no_step;
    report.append(advance(time, after_step, next, retries));
    if (simulation_.divergence()) return report;
    make_due();
    if (simulation_.time() >= time || simulation_.steps() != next) return report;
  }
}

sim::AdvanceReport ChangePlayer::step_towards(double time, const sim::StepObserver& after_step) {
  const sim::AdvanceReport report =
      simulation_.advance_to(time, after_step, simulation_.steps() + 1);
  if (!simulation_.divergence()) make_due();
  return report;
}

}  // namespace neve::app::run
