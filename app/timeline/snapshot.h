#pragma once
/// What pictures show of a run where it is.

#include <span>

#include "app/picture/snapshot.h"
#include "app/timeline/timeline.h"

namespace neve::app::timeline {

/// With the history, the steps and the changes of the run so far. The history is that of the
/// timeline: who draws while it moves keeps a copy.
/// @param scene  that is drawn: of the timeline, perhaps with other views
/// @param views  that will be drawn, not only those of the scene
picture::Snapshot take_snapshot(const Timeline& timeline, const scene::Scene& scene,
                                std::span<const scene::View> views, int frame);

}  // namespace neve::app::timeline
