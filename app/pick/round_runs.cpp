#include "app/pick/round_runs.h"

#include <algorithm>

#include "app/output/sequence.h"
#include "app/sweep/store/points.h"

namespace neve::app::pick {

using sweep::jobs::RunProgress;
using sweep::jobs::SweepProgress;

SweepProgress tiles_of(const SweepProgress& runs) {
  SweepProgress tiles{sweep::store::first_draws(runs.manifest), {}};
  const auto seeds = static_cast<std::size_t>(runs.manifest.seeds);
  for (std::size_t first = 0; first + seeds <= runs.runs.size(); first += seeds) {
    RunProgress& tile = tiles.runs.emplace_back(runs.runs[first]);
    for (std::size_t k = first; k < first + seeds; ++k)
      if (!runs.runs[k].has_ended()) tile.state = runs.runs[k].state;
  }
  return tiles;
}

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
