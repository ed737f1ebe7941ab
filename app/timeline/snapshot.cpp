#include "app/timeline/snapshot.h"

namespace neve::app::timeline {

picture::Snapshot take_snapshot(const Timeline& timeline, const scene::Scene& scene,
                                std::span<const scene::View> views, int frame) {
  const sim::Simulation& simulation = timeline.simulation();
  picture::Snapshot snapshot = picture::take_snapshot(scene, views, simulation, frame);
  snapshot.history = timeline.here().history;
  snapshot.advance = timeline.here().advance;
  snapshot.changes = timeline.changes();
  scene::forget_changes_after(snapshot.changes, simulation.steps());
  return snapshot;
}

}  // namespace neve::app::timeline
