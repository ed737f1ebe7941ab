#pragma once
/// Summary of a stage for panels.

#include <optional>

#include "app/dump/quantities.h"
#include "app/view/session/live_frame.h"

namespace neve::app::view::session {

StageSummary summarize_stage(const dump::StepInspection& inside, sim::Stage stage);

/// The view with arrows of the result of a stage, if that is a field of arrows.
scene::View view_of_stage(const scene::Scene& scene, scene::View view, sim::Stage stage);

/// The particles as a stage leaves them; stress stays that of the step's beginning.
void show_after_stage(const dump::StepInspection& inside, sim::Stage stage,
                      picture::Snapshot& snapshot);

/// Returns what the stage did to each particle, or to the nodes next to it; nothing for those that
/// show in no particle: the volumes of the first step, and the colliders, which a copy leaves.
std::optional<picture::StageChange> change_of_stage(const dump::StepInspection& inside,
                                                    sim::Stage stage);

/// @param stage the last one that was done; nothing: before the step
/// @return empty if there is no such particle, or no node
std::optional<ProbeReading> read_probe(const dump::StepInspection& inside,
                                       const dump::Probe& target,
                                       const std::optional<sim::Stage>& stage);

/// @param stage as above
HistogramReading read_histogram(const dump::StepInspection& inside, const FieldName& field,
                                const std::optional<sim::Stage>& stage);

}  // namespace neve::app::view::session
