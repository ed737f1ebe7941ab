#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/pick/search/rounds.h"
#include "app/sweep/plan/designs.h"
#include "sim/base/hash.h"

namespace neve::app::pick::search {

namespace {

/// Numbers of places among which the next tiles are chosen: all over the cube, and near the best.
constexpr std::uint32_t places_everywhere = 192, places_near = 192;

/// Spreads places evenly over the cube. @param first number of the first one in the sequence
std::vector<Point> spread_places(std::uint32_t first, std::uint32_t count, int dimension,
                                 std::uint64_t seed) {
  std::vector<Point> places(count, Point(dimension));
  for (std::uint32_t k = 0; k < count; ++k)
    for (int axis = 0; axis < dimension; ++axis)
      places[k][axis] = sweep::plan::sobol_place(first + k, static_cast<std::size_t>(axis), seed);
  return places;
}

/// Standard normal numbers, each from its own place in the stream of a seed.
double normal_number(std::uint64_t seed, std::uint64_t k) {
  const double u = 1 - unit_double(mix64(seed, 2 * k)), v = unit_double(mix64(seed, 2 * k + 1));
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

/// Draws normally distributed places around one, clamped into the cube.
std::vector<Point> places_around(const Point& middle, double reach, std::uint64_t seed) {
  std::vector<Point> places(places_near, middle);
  for (std::uint32_t k = 0; k < places_near; ++k) {
    // Some are close, some far.
    const double own = reach * std::exp2(-static_cast<double>(k % 4));
    for (Eigen::Index axis = 0; axis < middle.size(); ++axis)
      places[k][axis] = std::clamp(
          middle[axis] + own * normal_number(seed, k * static_cast<std::uint64_t>(middle.size()) +
                                                       static_cast<std::uint64_t>(axis)),
          0.0, 1.0);
  }
  return places;
}

/// Distance in which an axis counts less where liking changes slowly along it.
double felt_distance(const Smoothness& smoothness, const Point& x, const Point& y) {
  return ((x - y).array() / smoothness.distance.array()).matrix().norm();
}

class Selection {
 public:
  Selection(const Preference& taste, std::vector<Point> places, double min_distance)
      : taste_(taste), places_(std::move(places)), min_distance_(min_distance) {}

  bool is_full() const { return tiles_.size() >= tiles_in_round; }
  void add(const Point& x) { tiles_.push_back(x); }

  /// Adds the place with the greatest value that is not near a tile.
  void add_best(const Eigen::VectorXd& values) {
    for (double apart = min_distance_;; apart *= 0.5) {
      int best = -1;
      for (int k = 0; k < values.size(); ++k)
        if ((best < 0 || values[k] > values[best]) && is_apart(place(k), apart)) best = k;
      if (best >= 0) return add(place(best));
    }
  }

  const std::vector<Point>& places() const { return places_; }
  const std::vector<Point>& tiles() const { return tiles_; }

 private:
  const Point& place(int k) const { return places_[static_cast<std::size_t>(k)]; }

  bool is_apart(const Point& x, double apart) const {
    return std::all_of(tiles_.begin(), tiles_.end(), [&](const Point& tile) {
      return felt_distance(taste_.smoothness(), tile, x) >= apart && tile != x;
    });
  }

  const Preference& taste_;
  std::vector<Point> places_, tiles_;
  double min_distance_;
};

/// Likings as they may be: samples of the posterior at all places together.
class Sampler {
 public:
  Sampler(const Preference& taste, const std::vector<Point>& places) : means_(taste.means(places)) {
    Eigen::MatrixXd spread = taste.covariances(places);
    deviations_ = spread.diagonal().cwiseMax(0).cwiseSqrt();
    spread.diagonal().array() += 1e-6 * (1 + spread.diagonal().maxCoeff());
    root_ = spread.llt().matrixL();
  }
  /// Draws nearer to the means than a fair sample: few rounds are left, and those explore too long.
  Eigen::VectorXd sample(std::uint64_t seed) const {
    constexpr double boldness = 0.4;
    Eigen::VectorXd z(means_.size());
    for (Eigen::Index k = 0; k < z.size(); ++k)
      z[k] = normal_number(seed, static_cast<std::uint64_t>(k));
    return means_ + boldness * (root_ * z);
  }
  const Eigen::VectorXd& means() const { return means_; }
  const Eigen::VectorXd& deviations() const { return deviations_; }

 private:
  Eigen::VectorXd means_, deviations_;
  Eigen::MatrixXd root_;
};

/// Returns the reach of a search around the favourite, in shares of an axis. Choices shrink it.
double reach_after(std::size_t choices) {
  constexpr double first = 0.35, least = 0.04, shrink = 0.8;
  return std::max(least, first * std::pow(shrink, static_cast<double>(choices)));
}

}  // namespace

std::vector<Point> next_tiles(const std::vector<Round>& rounds, int dimension, std::uint64_t seed) {
  const auto round = static_cast<std::uint32_t>(rounds.size());
  const Preference taste = learn(rounds, dimension);
  const Point best = favourite(rounds, taste);
  // Nothing is known yet: continue the sequence.
  if (best.size() == 0)
    return spread_places(round * tiles_in_round, tiles_in_round, dimension, seed);

  const std::uint64_t own = mix64(seed, round);
  const double reach = reach_after(rounds.size());
  std::vector<Point> places = spread_places(0, places_everywhere, dimension, own);
  for (Point& x : places_around(best, reach, own)) places.push_back(std::move(x));
  Selection selection(taste, std::move(places), 0.5 * reach);
  const Sampler sampler(taste, selection.places());

  selection.add(best);
  selection.add_best(sampler.means());
  const int explored = rounds.size() < 2 ? 2 : rounds.size() < 4 ? 1 : 0;
  for (std::uint64_t k = 0; selection.tiles().size() < std::size_t(tiles_in_round - explored); ++k)
    selection.add_best(sampler.sample(mix64(own, k + 1)));
  while (!selection.is_full()) selection.add_best(sampler.means() + 2 * sampler.deviations());
  return selection.tiles();
}

}  // namespace neve::app::pick::search
