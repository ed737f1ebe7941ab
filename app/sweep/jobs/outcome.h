#pragma once
/// End of a run, in words for a tile and for the user.

#include <filesystem>
#include <string>

#include "app/sweep/jobs/child.h"
#include "app/sweep/store/manifest.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::jobs {

/// The error at the end of what a neve said, as text or as an event of --progress json: its last
/// line, of the last 64 KiB; "" if that is no error.
std::string last_error(const std::filesystem::path& log);

/// Fills in state, reason and the like from how the process ended and what it left: its log and, of
/// a diverged run, incident.json.
void judge(const ChildResult& result, const store::Manifest& manifest, const Run& run,
           const std::filesystem::path& run_folder, store::RunStatus& status);

/// An end that says nothing about the run: no room, no device, no OpenGL, no memory.
bool is_machine_failure(const store::RunStatus& status);

/// "DIVERGED frame 17: acoustic CFL 3.1", "TIMEOUT after 20 min 00 s", "CRASHED signal 11"
std::string tile_text(const store::RunStatus& status);

}  // namespace neve::app::sweep::jobs
