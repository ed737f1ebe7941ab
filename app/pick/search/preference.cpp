#include "app/pick/search/preference.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace neve::app::pick::search {

namespace {

/// Probability of each alternative of a choice.
Eigen::VectorXd probabilities(const Choice& choice, const Eigen::VectorXd& liking) {
  Eigen::VectorXd p(choice.among.size());
  for (Eigen::Index k = 0; k < p.size(); ++k) p[k] = liking[choice.among[std::size_t(k)]];
  p = (p.array() - p.maxCoeff()).exp();
  return p / p.sum();
}

Eigen::MatrixXd prior_covariance(const Smoothness& smoothness, const std::vector<Point>& points) {
  const auto n = Eigen::Index(points.size());
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      K(i, j) = K(j, i) = covariance(smoothness, points[std::size_t(i)], points[std::size_t(j)]);
  return K;
}

/// The most probable liking: a maximum of psi = log_likelihood - liking K^-1 liking / 2.
struct Mode {
  Eigen::VectorXd liking, weights;  ///< weights = K^-1 liking
  double psi = 0;
};

Mode mode_along(const std::vector<Choice>& choices, const Eigen::MatrixXd& K,
                const Eigen::VectorXd& weights) {
  Mode mode{K * weights, weights, 0};
  mode.psi = log_likelihood(choices, mode.liking) - 0.5 * weights.dot(mode.liking);
  return mode;
}

/// Newton's method; psi is concave, so halved steps always reach its only maximum.
Mode find_mode(const std::vector<Choice>& choices, const Eigen::MatrixXd& K) {
  constexpr int max_steps = 50;
  constexpr double tolerance = 1e-8;
  const Eigen::Index n = K.rows();
  Mode mode = mode_along(choices, K, Eigen::VectorXd::Zero(n));
  for (int step = 0; step < max_steps; ++step) {
    const Eigen::MatrixXd W = curvature(choices, mode.liking);
    const Eigen::VectorXd b = W * mode.liking + gradient(choices, mode.liking);
    // weights = b - W (I + K W)^-1 K b
    const Eigen::MatrixXd B = Eigen::MatrixXd::Identity(n, n) + K * W;
    const Eigen::VectorXd target = b - W * B.partialPivLu().solve(K * b);
    Mode next;
    for (double share = 1; share > 1e-6; share *= 0.5) {
      next = mode_along(choices, K, mode.weights + share * (target - mode.weights));
      if (next.psi >= mode.psi) break;
    }
    const double gain = next.psi - mode.psi;
    if (gain > 0) mode = std::move(next);
    if (!(gain > tolerance)) break;
  }
  return mode;
}

}  // namespace

double covariance(const Smoothness& smoothness, const Point& x, const Point& y) {
  const double r = std::sqrt(5.0) * ((x - y).array() / smoothness.distance.array()).matrix().norm();
  return smoothness.amplitude * smoothness.amplitude * (1 + r + r * r / 3) * std::exp(-r);
}

double log_likelihood(const std::vector<Choice>& choices, const Eigen::VectorXd& liking) {
  double sum = 0;
  for (const Choice& choice : choices) {
    double greatest = liking[choice.best], total = 0;
    for (const int k : choice.among) greatest = std::max(greatest, liking[k]);
    for (const int k : choice.among) total += std::exp(liking[k] - greatest);
    sum += liking[choice.best] - greatest - std::log(total);
  }
  return sum;
}

Eigen::VectorXd gradient(const std::vector<Choice>& choices, const Eigen::VectorXd& liking) {
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(liking.size());
  for (const Choice& choice : choices) {
    const Eigen::VectorXd p = probabilities(choice, liking);
    slope[choice.best] += 1;
    for (std::size_t k = 0; k < choice.among.size(); ++k)
      slope[choice.among[k]] -= p[Eigen::Index(k)];
  }
  return slope;
}

Eigen::MatrixXd curvature(const std::vector<Choice>& choices, const Eigen::VectorXd& liking) {
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(liking.size(), liking.size());
  for (const Choice& choice : choices) {
    const Eigen::VectorXd p = probabilities(choice, liking);
    for (std::size_t i = 0; i < choice.among.size(); ++i) {
      W(choice.among[i], choice.among[i]) += p[Eigen::Index(i)];
      for (std::size_t j = 0; j < choice.among.size(); ++j)
        W(choice.among[i], choice.among[j]) -= p[Eigen::Index(i)] * p[Eigen::Index(j)];
    }
  }
  return W;
}

Preference::Preference(std::vector<Point> points, const std::vector<Choice>& choices,
                       Smoothness smoothness)
    : points_(std::move(points)), smoothness_(std::move(smoothness)) {
  const auto n = Eigen::Index(points_.size());
  if (n == 0) return;
  const Eigen::MatrixXd K = prior_covariance(smoothness_, points_);
  const Mode mode = find_mode(choices, K);
  weights_ = mode.weights;
  const Eigen::MatrixXd W = curvature(choices, mode.liking);
  const Eigen::PartialPivLU<Eigen::MatrixXd> B(Eigen::MatrixXd::Identity(n, n) + W * K);
  // W (I + K W)^-1 = (I + W K)^-1 W
  precision_ = B.solve(W);
  precision_ = 0.5 * (precision_ + precision_.transpose()).eval();
  log_evidence_ = mode.psi - 0.5 * B.matrixLU().diagonal().array().abs().log().sum();
}

Eigen::MatrixXd Preference::cross(const std::vector<Point>& places) const {
  Eigen::MatrixXd k(Eigen::Index(points_.size()), Eigen::Index(places.size()));
  for (Eigen::Index i = 0; i < k.rows(); ++i)
    for (Eigen::Index j = 0; j < k.cols(); ++j)
      k(i, j) = covariance(smoothness_, points_[std::size_t(i)], places[std::size_t(j)]);
  return k;
}

Eigen::VectorXd Preference::means(const std::vector<Point>& places) const {
  if (points_.empty()) return Eigen::VectorXd::Zero(Eigen::Index(places.size()));
  return cross(places).transpose() * weights_;
}

Eigen::MatrixXd Preference::covariances(const std::vector<Point>& places) const {
  const Eigen::MatrixXd prior = prior_covariance(smoothness_, places);
  if (points_.empty()) return prior;
  const Eigen::MatrixXd k = cross(places);
  return prior - k.transpose() * (precision_ * k);
}

double Preference::mean(const Point& x) const {
  return means({x})[0];
}

double Preference::deviation(const Point& x) const {
  return std::sqrt(std::max(0.0, covariances({x})(0, 0)));
}

}  // namespace neve::app::pick::search
