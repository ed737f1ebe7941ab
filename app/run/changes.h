#pragma once
/// Changes during a run: kept with its pictures, repeated by `neve render`.
///
/// A change belongs to the step after which it was made. Everything that happens to a run in these
/// terms is a function of the scene it started from and the list of its changes, which is why the
/// list alone makes the run again, bit for bit.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/scene/live_change.h"
#include "app/scene/scene.h"
#include "sim/retry.h"
#include "sim/simulation.h"

namespace neve::app::run {

/// The scene after the changes made at steps up to this one. Automatic values ("auto") are not
/// filled in. @throws UsageError for a change that no run can have made
scene::Scene with_changes(const scene::Scene& start, const std::vector<scene::LiveChange>& changes,
                          std::size_t up_to_step = static_cast<std::size_t>(-1));

/// The changes that concern the things of a scene: those of views and mosaics that it lacks, since
/// pictures are made again one view at a time, are left out.
std::vector<scene::LiveChange> changes_of(const scene::Scene& scene,
                                          std::vector<scene::LiveChange> changes);

/// The scene to keep with a picture: the start of the simulation, drawn as it is drawn now.
/// Changes of views, cameras, light and output then need not be kept as changes.
scene::Scene recorded_scene(const scene::Scene& start, const scene::Scene& now);

/// The colliders of the scene where those of the simulation are, to draw or measure them.
void follow_colliders(const sim::Simulation& simulation, scene::Scene& scene);

/// Gives a simulation the parts of a scene that may change in a run, and the scene the places of
/// its colliders. @throws std::invalid_argument, see sim::Simulation::apply
void apply_scene(scene::Scene& scene, sim::Simulation& simulation);

/// Advances a simulation and makes the changes again on the way, or new ones between two steps.
///
/// Whenever it returns, all changes with a step up to simulation.steps() have been made: which ones
/// have follows from the number of steps alone, also for a state that was saved and restored. With
/// on_divergence = "retry" a frame that breaks a rule, or still takes shorter steps for an earlier
/// one, is simulated as a whole: its steps are not final before its end, and changes that fall
/// inside are made there.
class ChangePlayer {
 public:
  /// @param start       resolved, the scene that the simulation was built from; changes of views
  ///                    that it lacks are passed over
  /// @param changes     in the order they were made
  /// @param after_each  is told the scene after each change, in the thread that advances; may be
  ///                    empty
  ChangePlayer(const scene::Scene& start, std::vector<scene::LiveChange> changes,
               sim::Simulation& simulation,
               std::function<void(const scene::Scene&)> after_each = {});

  /// The scene as it is now.
  const scene::Scene& scene() const { return *scene_; }
  const std::shared_ptr<const scene::Scene>& shared_scene() const { return scene_; }
  const std::vector<scene::LiveChange>& changes() const { return changes_; }

  /// Makes the changes that are due before the first step.
  void begin() { make_due(); }

  /// Makes the changes that lead from scene() to this one at the present step, and lists them.
  /// Throws like sim::Simulation::apply; nothing has changed then.
  void make_now(std::shared_ptr<const scene::Scene> scene);

  /// Before a state after so many steps is restored into the simulation.
  void go_to(std::size_t steps);
  /// The same for a simulation that has what it needs of this scene, the one of that state. Changes
  /// of later steps stay in the list.
  void go_to(std::size_t steps, std::shared_ptr<const scene::Scene> scene);

  /// Forgets the changes of later steps: the run takes another way from here.
  void forget_later();

  /// sim::Simulation::advance_to or sim::advance_retrying, as the settings want it by then.
  sim::AdvanceReport advance_to(double time, const sim::StepObserver& after_step,
                                std::vector<sim::Retry>& retries);

  /// One step towards a time. It is taken even if it breaks a rule.
  sim::AdvanceReport step_towards(double time, const sim::StepObserver& after_step);

 private:
  void make_due();
  void make(std::size_t end);
  sim::AdvanceReport advance(double time, const sim::StepObserver& after_step,
                             std::size_t last_step, std::vector<sim::Retry>& retries);

  scene::Scene start_;
  std::vector<scene::LiveChange> changes_;
  std::size_t made_ = 0;  ///< number of them
  sim::Simulation& simulation_;
  std::function<void(const scene::Scene&)> after_each_;
  std::shared_ptr<const scene::Scene> scene_;
};

}  // namespace neve::app::run
