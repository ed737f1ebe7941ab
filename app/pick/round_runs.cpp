#include "app/pick/round_runs.h"

#include <algorithm>

#include "app/output/sequence.h"

namespace neve::app::pick {

using sweep::jobs::RunProgress;
using sweep::jobs::SweepProgress;

std::vector<std::filesystem::path> pictures_of(const SweepProgress& runs, std::size_t run) {
  const sweep::Run& planned = runs.manifest.runs[run];
  std::vector<std::filesystem::path> pictures;
  for (int frame = 0; frame < runs.runs[run].made; ++frame)
    pictures.push_back(output::frame_path(std::filesystem::path("runs") / planned.folder,
                                          runs.manifest.view, planned.frames.first + frame));
  return pictures;
}

std::string why_not(const SweepProgress& runs, const Click& click) {
  for (const int tile : click) {
    const auto k = static_cast<std::size_t>(tile);
    if (k < runs.runs.size() && runs.runs[k].has_failed())
      return "tile " + std::to_string(tile + 1) +
             " cannot be chosen: its run failed: " + runs.runs[k].reason;
  }
  return {};
}

std::string all_failed_text(const SweepProgress& runs) {
  const bool has_all_failed = std::all_of(runs.runs.begin(), runs.runs.end(),
                                          [](const RunProgress& run) { return run.has_failed(); });
  if (!has_all_failed || runs.runs.empty()) return {};
  return "all nine runs failed; the first: " + runs.runs.front().reason;
}

}  // namespace neve::app::pick
