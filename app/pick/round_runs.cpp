#include "app/pick/round_runs.h"

#include <algorithm>

#include "app/output/sequence.h"
#include "app/sweep/store/manifest.h"
#include "app/sweep/store/store.h"

namespace neve::app::pick {

namespace fs = std::filesystem;

namespace {

TileRun::State state_of(sweep::store::RunState state) {
  if (state == sweep::store::RunState::ok) return TileRun::State::done;
  if (state == sweep::store::RunState::running) return TileRun::State::running;
  return sweep::store::has_failed(state) ? TileRun::State::failed : TileRun::State::waiting;
}

TileRun read_tile(const fs::path& folder, const sweep::Run& run, const std::string& view) {
  TileRun tile;
  tile.frames = run.frames.last - run.frames.first + 1;
  const sweep::store::RunStatus status =
      sweep::store::read_status(sweep::store::runs_folder(folder) / run.folder);
  // The folder may still have a run of another round.
  if (status.key != run.key) return tile;
  tile.state = state_of(status.state);
  if (tile.state == TileRun::State::failed)
    tile.reason = status.short_reason.empty() ? status.reason : status.short_reason;
  for (int frame = run.frames.first; frame <= run.frames.last; ++frame) {
    fs::path picture = output::frame_path(fs::path("runs") / run.folder, view, frame);
    std::error_code error;
    if (fs::exists(folder / picture, error)) tile.pictures.push_back(std::move(picture));
  }
  return tile;
}

}  // namespace

RoundRuns read_round(const fs::path& folder) {
  const sweep::store::Manifest manifest = sweep::store::read_manifest(folder);
  RoundRuns runs{manifest.fps, manifest.tile_width, manifest.tile_height, {}};
  for (const sweep::Run& run : manifest.runs)
    runs.tiles.push_back(read_tile(folder, run, manifest.view));
  return runs;
}

std::string why_not(const RoundRuns& runs, const Click& click) {
  for (const int tile : click) {
    const auto k = static_cast<std::size_t>(tile);
    if (k < runs.tiles.size() && runs.tiles[k].state == TileRun::State::failed)
      return "tile " + std::to_string(tile + 1) +
             " cannot be chosen: its run failed: " + runs.tiles[k].reason;
  }
  return {};
}

bool have_all_ended(const RoundRuns& runs) {
  return !runs.tiles.empty() && std::all_of(runs.tiles.begin(), runs.tiles.end(),
                                            [](const TileRun& tile) { return tile.has_ended(); });
}

std::string all_failed_text(const RoundRuns& runs) {
  const bool is_any_usable =
      std::any_of(runs.tiles.begin(), runs.tiles.end(),
                  [](const TileRun& tile) { return tile.state != TileRun::State::failed; });
  if (is_any_usable || runs.tiles.empty()) return {};
  return "all nine runs failed; the first: " + runs.tiles.front().reason;
}

}  // namespace neve::app::pick
