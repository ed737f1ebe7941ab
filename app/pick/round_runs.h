#pragma once
/// The runs of a round as they are on disk: how far each tile is, and its pictures.

#include <filesystem>
#include <string>
#include <vector>

#include "app/pick/clicks.h"

namespace neve::app::pick {

struct TileRun {
  enum class State { waiting, running, done, failed };
  State state = State::waiting;
  std::string reason;  ///< of a failed run, for a tile
  int frames = 0;      ///< that the whole run has
  /// Pictures that are there, in order, relative to the folder of the search.
  std::vector<std::filesystem::path> pictures;

  bool has_ended() const { return state == State::done || state == State::failed; }
};

struct RoundRuns {
  double fps = 24;
  int tile_width = 480, tile_height = 270;  ///< px
  std::vector<TileRun> tiles;
};

/// Runs of the sweep that the folder has now. @throws Error where it has none
RoundRuns read_round(const std::filesystem::path& folder);

/// "tile 3 cannot be chosen: its run failed: DIVERGED frame 3", or "" where the click can be used.
std::string why_not(const RoundRuns& runs, const Click& click);

/// True where all tiles are done or failed.
bool have_all_ended(const RoundRuns& runs);

/// "all nine runs failed; the first: DIVERGED frame 3", or "" where one did not.
std::string all_failed_text(const RoundRuns& runs);

}  // namespace neve::app::pick
