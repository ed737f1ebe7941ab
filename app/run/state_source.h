#pragma once
/// The states of a run at one time after another: from its checkpoints, or simulated again.

#include "app/run/past_run.h"
#include "app/run/render_job.h"
#include "app/run/walk.h"
#include "app/setup/seed_scene.h"

namespace neve::app::run {

class StateSource {
 public:
  /// @param job    with a resolved scene
  /// @param first  s, the earliest time that will be asked for
  /// @throws IoError, sim::ShapeError
  StateSource(const RenderJob& job, PastRun past, double first, int threads, Progress& progress);
  StateSource(const StateSource&) = delete;
  StateSource& operator=(const StateSource&) = delete;

  /// Times must not decrease, see Walk. @return whether it got there
  bool go_to(double time) { return walk_.go_to(time); }

  const sim::Simulation& simulation() const { return simulation_; }
  const setup::SeededScene& seeded() const { return seeded_; }
  const PastRun& past() const { return past_; }
  /// With the changes made so far, and its colliders where they are.
  scene::Scene scene() const;

 private:
  PastRun past_;
  setup::SeededScene seeded_;
  sim::Simulation simulation_;
  ChangePlayer player_;
  Walk walk_;
};

}  // namespace neve::app::run
