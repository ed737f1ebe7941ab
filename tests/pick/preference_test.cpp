/// The taste learned from choices: its derivatives, its maximum, its indifference to axes that do
/// not matter.

#include "app/pick/search/preference.h"

#include <gtest/gtest.h>

#include "tests/support/robot.h"

namespace neve::test {
namespace {

using namespace app::pick::search;

const std::vector<Choice> some_choices = {{0, {0, 1, 2, 3}}, {2, {1, 2, 4}}, {4, {0, 4}}};

TEST(Preference, DerivativesMatchFiniteDifferences) {
  Eigen::VectorXd liking(5);
  liking << 0.3, -1.2, 0.8, 2.1, -0.4;
  const Eigen::VectorXd slope = gradient(some_choices, liking);
  const Eigen::MatrixXd W = curvature(some_choices, liking);
  // Central differences of a smooth function: an error of about step^2.
  constexpr double step = 1e-5, tolerance = 1e-8;
  for (int k = 0; k < 5; ++k) {
    Eigen::VectorXd up = liking, down = liking;
    up[k] += step;
    down[k] -= step;
    const double first = (log_likelihood(some_choices, up) - log_likelihood(some_choices, down));
    EXPECT_NEAR(slope[k], first / (2 * step), tolerance);
    const Eigen::VectorXd second = gradient(some_choices, up) - gradient(some_choices, down);
    for (int j = 0; j < 5; ++j) EXPECT_NEAR(W(j, k), -second[j] / (2 * step), tolerance);
  }
}

/// The mode makes the gradient of the objective zero: K^-1 liking is the slope of the likelihood.
TEST(Preference, MeansAreTheMaximumOfTheObjective) {
  std::vector<Point> points;
  for (int k = 0; k < 5; ++k) points.push_back(random_place(2, 7, std::uint64_t(k)));
  const Smoothness smoothness{2, Eigen::VectorXd::Constant(2, 0.5)};
  const Preference taste(points, some_choices, smoothness);
  const Eigen::VectorXd liking = taste.means(points);
  Eigen::MatrixXd K(5, 5);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) K(i, j) = covariance(smoothness, points[i], points[j]);
  // Newton ends when the objective gains less than 1e-8.
  EXPECT_LT((liking - K * gradient(some_choices, liking)).norm(), 1e-3);
}

/// Best of nine random places, 40 times over, by distance from a known place.
std::vector<Choice> choices_near(const Point& wanted, const Eigen::ArrayXd& weight,
                                 std::vector<Point>& points) {
  std::vector<Choice> choices;
  const auto miss = [&](const Point& x) { return ((x - wanted).array() * weight).matrix().norm(); };
  for (int round = 0; round < 40; ++round) {
    Choice choice;
    for (int k = 0; k < 9; ++k) {
      choice.among.push_back(int(points.size()));
      points.push_back(random_place(int(wanted.size()), 3, points.size()));
    }
    choice.best = *std::min_element(choice.among.begin(), choice.among.end(), [&](int a, int b) {
      return miss(points[std::size_t(a)]) < miss(points[std::size_t(b)]);
    });
    choices.push_back(choice);
  }
  return choices;
}

TEST(Preference, MeanIsGreatestAtTheWantedPlace) {
  Point wanted(2);
  wanted << 0.3, 0.7;
  std::vector<Point> points;
  const std::vector<Choice> choices = choices_near(wanted, Eigen::ArrayXd::Ones(2), points);
  const Preference taste(points, choices, {6, Eigen::VectorXd::Constant(2, 0.5)});
  Point best = wanted;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j) {
      Point x(2);
      x << i / 20.0, j / 20.0;
      if (taste.mean(x) > taste.mean(best)) best = x;
    }
  // The best of nine random places is about 0.15 away from the wanted one.
  EXPECT_LT((best - wanted).norm(), 0.1);
}

TEST(Preference, AxesThatDoNotMatterGetLongDistances) {
  Point wanted(2);
  wanted << 0.3, 0.5;
  std::vector<Point> points;
  Eigen::ArrayXd weight(2);
  weight << 1, 0;
  const std::vector<Choice> choices = choices_near(wanted, weight, points);
  const Smoothness found = fitted_smoothness({points.begin(), points.begin() + 90},
                                             {choices.begin(), choices.begin() + 10}, 2);
  EXPECT_GT(found.distance[1], 2 * found.distance[0]);
}

TEST(Preference, LittleIsKnownFarFromChoices) {
  std::vector<Point> points = {Point::Constant(1, 0.1), Point::Constant(1, 0.2)};
  const Preference taste(points, {{0, {0, 1}}}, {2, Eigen::VectorXd::Constant(1, 0.1)});
  EXPECT_GT(taste.mean(points[0]), taste.mean(points[1]));
  EXPECT_LT(taste.deviation(points[0]), 1.95);
  EXPECT_NEAR(taste.deviation(Point::Constant(1, 0.9)), 2, 0.01);
}

}  // namespace
}  // namespace neve::test
