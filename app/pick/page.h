#pragma once
/// A page with the nine moving tiles of a round, for any browser; it needs no server.

#include <filesystem>
#include <string>
#include <vector>

#include "app/pick/round_noise.h"

namespace neve::app::pick {

/// The contents of the page of a round.
struct RoundPage {
  int round = 1, rounds = 8;
  double fps = 24;
  /// Pictures of each tile in order, relative to the folder of the page; none if a run has none.
  std::vector<std::vector<std::string>> tiles;
  RoundNoise noise;
  std::vector<std::string> learned;  ///< sentences
  std::string map;                   ///< SVG, or ""
  bool has_favourite = false;        ///< the first tile is the favourite so far
};

/// Returns a page of nine tiles that play together, again and again, above what was learned.
std::string page_html(const RoundPage& page);

}  // namespace neve::app::pick
