#pragma once
/// How a run ended, in words for a tile and for a person.

#include <filesystem>

#include "app/sweep/child.h"
#include "app/sweep/manifest.h"
#include "app/sweep/store.h"

namespace neve::app {

/// Fills in state, reason and the like from how the process ended and what it left: its log and, of
/// a diverged run, incident.json.
void judge(const ChildResult& result, const Manifest& manifest, const ManifestRun& run,
           const std::filesystem::path& run_folder, RunReport& report);

/// "DIVERGED frame 17: acoustic CFL 3.1", "TIMEOUT after 20 min 00 s", "CRASHED signal 11"
std::string tile_text(const RunReport& report);

}  // namespace neve::app
