#pragma once
/// A taste learned from choices: a Gaussian process over the unit cube whose values explain which
/// tiles a person chose.

#include <Eigen/Core>
#include <vector>

namespace neve::app::pick::search {

/// A place in the unit cube: one coordinate per axis, each from 0 to 1.
using Point = Eigen::VectorXd;

/// One tile was liked best among several.
struct Choice {
  int best = 0;            ///< index of a point
  std::vector<int> among;  ///< indices of points, `best` among them
};

/// Covariance of the process. Liking is measured in units of the person's carelessness: a tile
/// liked by 1 more than another is chosen e times as often.
struct Smoothness {
  double amplitude = 2;      ///< standard deviation of liking
  Eigen::VectorXd distance;  ///< per axis, over which liking changes; > 0
};

/// Matern covariance with exponent 5/2. Source: Rasmussen and Williams (2006), equation 4.17.
double covariance(const Smoothness& smoothness, const Point& x, const Point& y);

/// Logarithm of the probability of all choices, each as a multinomial logit: exp(liking) of the
/// best over the sum of those it was among. Source: Luce (1959).
/// @param liking of each point
double log_likelihood(const std::vector<Choice>& choices, const Eigen::VectorXd& liking);

/// Gradient of log_likelihood.
/// Check: Preference.DerivativesMatchFiniteDifferences
Eigen::VectorXd gradient(const std::vector<Choice>& choices, const Eigen::VectorXd& liking);

/// Negative Hessian of log_likelihood, n x n, positive semidefinite.
/// Check: Preference.DerivativesMatchFiniteDifferences
Eigen::MatrixXd curvature(const std::vector<Choice>& choices, const Eigen::VectorXd& liking);

/// Posterior of the liking, by Laplace's approximation. Source: Rasmussen and Williams (2006),
/// section 3.4, with the likelihood of choices after Chu and Ghahramani (2005).
class Preference {
 public:
  /// @param points   of all tiles that were shown, dimension d
  /// @param choices  indices into points
  Preference(std::vector<Point> points, const std::vector<Choice>& choices, Smoothness smoothness);

  /// Expected liking at a place; 0 far from all choices.
  double mean(const Point& x) const;
  /// Standard deviation of the liking at a place.
  double deviation(const Point& x) const;
  /// Means of several places, and the n x n covariance of their likings.
  Eigen::VectorXd means(const std::vector<Point>& places) const;
  Eigen::MatrixXd covariances(const std::vector<Point>& places) const;

  /// Logarithm of the approximate probability of the choices for this smoothness.
  double log_evidence() const { return log_evidence_; }
  const Smoothness& smoothness() const { return smoothness_; }

 private:
  Eigen::MatrixXd cross(const std::vector<Point>& places) const;

  std::vector<Point> points_;
  Smoothness smoothness_;
  Eigen::VectorXd weights_;    ///< K^-1 liking
  Eigen::MatrixXd precision_;  ///< W (I + K W)^-1: information of the choices
  double log_evidence_ = 0;
};

/// The smoothness that explains the choices best, among some distances and amplitudes: first the
/// same distance on all axes, then axis by axis. Weakly held to the usual one, so that few choices
/// do not decide much.
/// @param dimension  of the points, also where there are none
Smoothness fitted_smoothness(const std::vector<Point>& points, const std::vector<Choice>& choices,
                             int dimension);

}  // namespace neve::app::pick::search
