#include "app/pick/search/rounds.h"

#include <algorithm>

namespace neve::app::pick::search {

namespace {

int index_of(std::vector<Point>& points, const Point& x) {
  const auto known = std::find(points.begin(), points.end(), x);
  if (known != points.end()) return static_cast<int>(known - points.begin());
  points.push_back(x);
  return static_cast<int>(points.size()) - 1;
}

/// The choices that one answered round adds.
/// @param tiles  indices of points @param earlier  index of the tile chosen last, or -1
void add_choices(const Round& round, const std::vector<int>& tiles, int earlier,
                 std::vector<Choice>& choices) {
  std::vector<int> others;
  for (int k = 0; k < static_cast<int>(tiles.size()); ++k)
    if (std::find(round.chosen.begin(), round.chosen.end(), k) == round.chosen.end())
      others.push_back(tiles[static_cast<std::size_t>(k)]);
  const auto beats_others = [&](int best) {
    Choice choice{best, others};
    std::erase(choice.among, best);
    choice.among.push_back(best);
    choices.push_back(std::move(choice));
  };
  for (const int k : round.chosen) beats_others(tiles[static_cast<std::size_t>(k)]);
  if (round.chosen.empty() && earlier >= 0) beats_others(earlier);
}

}  // namespace

Evidence evidence_of(const std::vector<Round>& rounds) {
  Evidence evidence;
  int earlier = -1;
  for (const Round& round : rounds) {
    std::vector<int> tiles;
    for (const Point& x : round.tiles) tiles.push_back(index_of(evidence.points, x));
    add_choices(round, tiles, earlier, evidence.choices);
    if (!round.chosen.empty()) earlier = tiles[static_cast<std::size_t>(round.chosen.front())];
  }
  return evidence;
}

Preference learn(const std::vector<Round>& rounds, int dimension) {
  Evidence evidence = evidence_of(rounds);
  Smoothness smoothness = fitted_smoothness(evidence.points, evidence.choices, dimension);
  return {std::move(evidence.points), evidence.choices, std::move(smoothness)};
}

Point favourite(const std::vector<Round>& rounds, const Preference& taste) {
  const Evidence evidence = evidence_of(rounds);
  if (evidence.choices.empty()) return {};
  Eigen::Index best = 0;
  taste.means(evidence.points).maxCoeff(&best);
  return evidence.points[static_cast<std::size_t>(best)];
}

Point result_of(const std::vector<Round>& rounds, const Preference& taste) {
  if (rounds.empty() || rounds.back().chosen.empty()) return favourite(rounds, taste);
  std::vector<Point> chosen;
  for (const int k : rounds.back().chosen)
    chosen.push_back(rounds.back().tiles[static_cast<std::size_t>(k)]);
  Eigen::Index best = 0;
  taste.means(chosen).maxCoeff(&best);
  return chosen[static_cast<std::size_t>(best)];
}

}  // namespace neve::app::pick::search
