#include <cmath>

#include "app/pick/search/preference.h"

namespace neve::app::pick::search {

namespace {

/// Distances that are tried, in shares of an axis; the last one makes an axis all but indifferent.
constexpr double tried_distances[] = {0.3, 0.5, 0.8, 1.3, 3};
constexpr double tried_amplitudes[] = {1.5, 3, 6};

constexpr double usual_distance = 0.6, usual_amplitude = 3;

/// Log evidence, with a mild preference for the usual distance and amplitude.
double score(const std::vector<Point>& points, const std::vector<Choice>& choices,
             const Smoothness& smoothness) {
  const Eigen::ArrayXd off = (smoothness.distance.array() / usual_distance).log();
  const double louder = std::log(smoothness.amplitude / usual_amplitude);
  return Preference(points, choices, smoothness).log_evidence() - 0.5 * off.square().sum() -
         0.5 * louder * louder;
}

}  // namespace

Smoothness fitted_smoothness(const std::vector<Point>& points, const std::vector<Choice>& choices,
                             int dimension) {
  Smoothness best{usual_amplitude, Eigen::VectorXd::Constant(dimension, usual_distance)};
  if (choices.empty()) return best;
  double best_score = score(points, choices, best);
  const auto try_one = [&](const Smoothness& smoothness) {
    const double found = score(points, choices, smoothness);
    if (found <= best_score) return;
    best = smoothness;
    best_score = found;
  };
  for (const double amplitude : tried_amplitudes)
    for (const double distance : tried_distances)
      try_one({amplitude, Eigen::VectorXd::Constant(dimension, distance)});
  // Few choices cannot tell axes apart.
  constexpr std::size_t enough_choices = 3;
  if (choices.size() < enough_choices) return best;
  for (int axis = 0; axis < dimension; ++axis)
    for (const double distance : tried_distances) {
      Smoothness changed = best;
      changed.distance[axis] = distance;
      try_one(changed);
    }
  return best;
}

}  // namespace neve::app::pick::search
