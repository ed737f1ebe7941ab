#include "app/run/state_source.h"

#include <utility>

namespace neve::app::run {

namespace {

/// @return the frame that the simulation is brought to; 0: the start
int begin_early_enough(const PastRun& past, double first, double fps, ChangePlayer& player,
                       sim::Simulation& simulation, Progress& progress) {
  player.begin();
  const std::optional<ResumedRun> checkpoint = checkpoint_before(past, first, fps, simulation);
  if (!checkpoint) return 0;
  go_to_checkpoint(*checkpoint, fps, player, simulation);
  progress.note("continues from the checkpoint of frame " + std::to_string(checkpoint->frame));
  return checkpoint->frame;
}

}  // namespace

StateSource::StateSource(const RenderJob& job, PastRun past, double first, int threads,
                         Progress& progress)
    : past_(std::move(past)),
      seeded_(setup::seed_scene(job.scene)),
      simulation_(setup::make_simulation(job.scene, seeded_.particles, threads)),
      player_(job.scene, job.changes, simulation_),
      walk_(job.scene.fps, simulation_, player_, progress,
            begin_early_enough(past_, first, job.scene.fps, player_, simulation_, progress)) {}

scene::Scene StateSource::scene() const {
  scene::Scene now = player_.scene();
  follow_colliders(simulation_, now);
  return now;
}

}  // namespace neve::app::run
