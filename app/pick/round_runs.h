#pragma once
/// The runs of a round: nine tiles to choose from.

#include <filesystem>
#include <string>
#include <vector>

#include "app/pick/clicks.h"
#include "app/sweep/jobs/background.h"

namespace neve::app::pick {

/// The runs of a round by its tiles: of each point the first seed, which has ended once all have.
sweep::jobs::SweepProgress tiles_of(const sweep::jobs::SweepProgress& runs);

/// Pictures of a tile, in order, relative to the folder of the search.
std::vector<std::filesystem::path> pictures_of(const sweep::jobs::SweepProgress& runs,
                                               std::size_t run);

/// "tile 3 cannot be chosen: its run failed: DIVERGED frame 3", or "" if the click can be used.
std::string why_not(const sweep::jobs::SweepProgress& runs, const Click& click);

/// "all nine runs failed; the first: DIVERGED frame 3", or "" if one did not.
std::string all_failed_text(const sweep::jobs::SweepProgress& runs);

}  // namespace neve::app::pick
