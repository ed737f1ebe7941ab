#pragma once
/// The inside of a step in a few numbers, for panels.

#include <optional>

#include "app/dump/quantities.h"
#include "app/view/live_frame.h"

namespace neve::app {

StageLook stage_look(const Inside& inside, sim::Stage stage);

/// The view with arrows of what a stage works out, where it works out a field of arrows.
View view_of_stage(const Scene& scene, View view, sim::Stage stage);

/// The particles as a stage leaves them; stress stays that of the step's beginning.
void show_after_stage(const Inside& inside, sim::Stage stage, Snapshot& snapshot);

/// @param stage the last one that was done; nothing: before the step
/// @return nothing where there is no such particle, or no node
std::optional<ProbeReading> read_probe(const Inside& inside, const ProbeTarget& target,
                                       const std::optional<sim::Stage>& stage);

}  // namespace neve::app
