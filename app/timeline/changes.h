#pragma once
/// Changes during a run: a change belongs to the step after which it was made.
///
/// Everything that happens to a run in these terms is a function of the scene it started from and
/// the list of its changes, which is why the list alone makes the run again, bit for bit.

#include <cstddef>
#include <vector>

#include "app/scene/live_change.h"
#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::timeline {

/// Returns how many changes, from the first, are made once so many steps are taken.
std::size_t count_until(const std::vector<scene::LiveChange>& changes, std::size_t steps);

/// The scene after the first of its changes. Automatic values ("auto") are not filled in.
/// @throws UsageError for a change that no run can have made
scene::Scene with_first_changes(const scene::Scene& start,
                                const std::vector<scene::LiveChange>& changes, std::size_t count);

/// The same for the changes made at steps up to this one.
scene::Scene with_changes(const scene::Scene& start, const std::vector<scene::LiveChange>& changes,
                          std::size_t up_to_step = static_cast<std::size_t>(-1));

/// The changes that concern the things of a scene: those of views and mosaics that it lacks, since
/// pictures are made again one view at a time, are left out.
std::vector<scene::LiveChange> changes_of(const scene::Scene& scene,
                                          std::vector<scene::LiveChange> changes);

/// The scene to keep with a picture: the start of the simulation, drawn as it is drawn now.
/// Changes of views, cameras, light and output then need not be kept as changes.
scene::Scene recorded_scene(const scene::Scene& start, const scene::Scene& now);

/// @throws UsageError for differences that cannot arise while a simulation runs, with the
/// parameters that can change
void require_live(const scene::Scene& before, const scene::Scene& after, const char* flag);

/// Puts the colliders in the order of an earlier scene, new ones behind: as the list of changes
/// makes it again, wherever the new ones were put.
scene::Scene in_order_of(const scene::Scene& before, scene::Scene after);

/// The colliders of the scene where those of the simulation are, to draw or measure them.
void follow_colliders(const sim::Simulation& simulation, scene::Scene& scene);

}  // namespace neve::app::timeline
