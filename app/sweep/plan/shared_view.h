#pragma once
/// One camera and one range of each field for all runs, so that their pictures can be compared.

#include "app/sweep/plan/sweep_plan.h"

namespace neve::app::sweep::plan {

std::filesystem::path shared_view_path(const std::filesystem::path& folder);

/// Fills in the cameras and ranges of all runs, from DIR/look.toml where it belongs to the same
/// scene, otherwise from dry runs of the corners of the sweep and the ranges of all runs together;
/// then it is written there. So later runs look like earlier ones, and another camera can be
/// written into that file. Settings of a run are kept.
/// @param cores for dry runs side by side
/// @return the file that now has what was in DIR/look.toml for another scene, if a person may have
/// written it; empty: there was nothing
/// @throws SceneError for a broken look.toml, IoError
std::filesystem::path share_camera_and_ranges(SweepPlan& plan, int cores);

}  // namespace neve::app::sweep::plan
