#pragma once
/// A person in place of a person: a robot that wants some snow and clicks the tile most like it. It
/// sees an emulator of real runs, so that hundreds of searches take seconds.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/pick/search/preference.h"
#include "sim/base/hash.h"

namespace neve::test {

using app::pick::search::Point;

/// Results of real runs: places in the unit cube and logarithms of their metrics.
struct RunTable {
  int axes = 0;
  std::vector<Point> places;
  std::vector<Eigen::VectorXd> metrics;
};

/// Reads a table of docs/pick: a head "u_NAME,...,METRIC,...", then one run a line.
inline RunTable read_run_table(const std::string& file) {
  std::ifstream in(file);
  RunTable table;
  std::string line, cell;
  if (!std::getline(in, line)) throw std::runtime_error("cannot read " + file);
  int columns = 0;
  for (std::istringstream head(line); std::getline(head, cell, ','); ++columns)
    table.axes += cell.starts_with("u_");
  while (std::getline(in, line)) {
    Eigen::VectorXd row(columns);
    std::istringstream cells(line);
    for (int k = 0; k < columns && std::getline(cells, cell, ','); ++k) row[k] = std::stod(cell);
    table.places.emplace_back(row.head(table.axes));
    table.metrics.emplace_back(row.tail(columns - table.axes));
  }
  for (Eigen::VectorXd& m : table.metrics) m = m.array().log();
  return table;
}

/// Metrics at any place, from those of real runs: Gaussian process regression with a fixed
/// covariance and noise.
class Emulator {
 public:
  static constexpr double noise = 0.03;  ///< of the logarithm of a metric

  explicit Emulator(const RunTable& table) : places_(table.places) {
    smoothness_ = {0.5, Eigen::VectorXd::Constant(table.axes, 0.8)};
    const auto n = Eigen::Index(places_.size()), m = table.metrics.front().size();
    Eigen::MatrixXd K(n, n), Y(n, m);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j)
        K(i, j) = covariance(smoothness_, places_[i], places_[j]);
      Y.row(i) = table.metrics[i];
    }
    K.diagonal().array() += noise * noise;
    mean_ = Y.colwise().mean();
    const Eigen::MatrixXd inverse = K.llt().solve(Eigen::MatrixXd::Identity(n, n));
    weights_ = inverse * (Y.rowwise() - mean_);
    // Source: Rasmussen and Williams (2006), equation 5.12.
    const Eigen::MatrixXd left_out = weights_.array().colwise() / inverse.diagonal().array();
    error_ = std::sqrt(left_out.array().square().mean());
  }

  Eigen::VectorXd metrics(const Point& x) const {
    Eigen::VectorXd k(Eigen::Index(places_.size()));
    for (Eigen::Index i = 0; i < k.size(); ++i) k[i] = covariance(smoothness_, places_[i], x);
    return mean_.transpose() + weights_.transpose() * k;
  }
  /// Root mean square error of the logarithms, for runs that are left out.
  double error() const { return error_; }

 private:
  std::vector<Point> places_;
  app::pick::search::Smoothness smoothness_;
  Eigen::RowVectorXd mean_;
  Eigen::MatrixXd weights_;
  double error_ = 0;
};

/// The robot's eyes and mistakes.
class Robot {
 public:
  Robot(const Emulator& emulator, Point target, double wrong_share, std::uint64_t seed)
      : emulator_(emulator),
        wanted_(emulator.metrics(target)),
        wrong_share_(wrong_share),
        seed_(seed) {}

  /// Root mean square over the metrics of their relative differences.
  double distance(const Point& x) const {
    return (emulator_.metrics(x) - wanted_).norm() / std::sqrt(double(wanted_.size()));
  }
  /// All metrics are within a share of those that are wanted.
  bool is_content(const Point& x, double share) const {
    return (emulator_.metrics(x) - wanted_).cwiseAbs().maxCoeff() <= std::log1p(share);
  }
  /// The most similar tile, or any tile by mistake.
  int click(const std::vector<Point>& tiles) {
    const std::uint64_t own = mix64(seed_, clicks_++);
    if (unit_double(mix64(own, 1)) < wrong_share_)
      return int(unit_double(mix64(own, 2)) * double(tiles.size()));
    int best = 0;
    for (int k = 1; k < int(tiles.size()); ++k)
      if (distance(tiles[k]) < distance(tiles[best])) best = k;
    return best;
  }

 private:
  const Emulator& emulator_;
  Eigen::VectorXd wanted_;
  double wrong_share_;
  std::uint64_t seed_, clicks_ = 0;
};

/// Number n of a sequence of random places.
inline Point random_place(int axes, std::uint64_t seed, std::uint64_t n) {
  Point x(axes);
  for (int a = 0; a < axes; ++a) x[a] = unit_double(mix64(mix64(seed, n), std::uint64_t(a)));
  return x;
}

}  // namespace neve::test
