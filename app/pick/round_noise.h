#pragma once
/// The noise of a round from its seeds: how often the snow of a tile breaks, and which tiles are
/// too close to call.

#include <filesystem>
#include <string>
#include <vector>

namespace neve::app::pick {

struct RoundNoise {
  std::vector<std::string> tiles;  ///< "breaks in 1 of 4, spread 0.42 m a"; none without seeds
  std::vector<std::string>
      letters;      ///< theirs alone, "-" where all are too close to call, or none can be compared
  std::string key;  ///< explains the letters
};

/// @param folder  of a search whose round is made @throws IoError
RoundNoise noise_of_round(const std::filesystem::path& folder);

}  // namespace neve::app::pick
