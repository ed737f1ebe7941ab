#pragma once
/// Rounds of nine tiles: the choices so far, and the nine places to show next.

#include <cstdint>
#include <vector>

#include "app/pick/search/preference.h"

namespace neve::app::pick::search {

inline constexpr int tiles_in_round = 9;

/// A round that was shown and answered.
struct Round {
  std::vector<Point> tiles;  ///< tiles_in_round
  std::vector<int> chosen;   ///< positions 0 to 8; none, one or two
};

/// Distinct points of all rounds, and what the clicks say about them. One chosen tile beats the
/// eight others; each of two beats the seven others. None of them: the favourite of earlier rounds
/// beats all nine; in the first round that says nothing.
struct Evidence {
  std::vector<Point> points;
  std::vector<Choice> choices;
};
Evidence evidence_of(const std::vector<Round>& rounds);

/// The taste that explains all rounds. @param dimension number of axes
Preference learn(const std::vector<Round>& rounds, int dimension);

/// The tile, of all that were shown, that is liked most; an empty point before the first choice.
Point favourite(const std::vector<Round>& rounds, const Preference& taste);

/// The tile that is the result of the rounds: the last one chosen, the better liked of two; the
/// favourite where the last round had none.
Point result_of(const std::vector<Round>& rounds, const Preference& taste);

/// Chooses nine places: at first spread evenly; then the favourite again, the best that is
/// expected, some that may be the best (Thompson samples), and some where little is known; none
/// near another. They depend on the arguments alone. @param seed of the whole search
std::vector<Point> next_tiles(const std::vector<Round>& rounds, int dimension, std::uint64_t seed);

}  // namespace neve::app::pick::search
