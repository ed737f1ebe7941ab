#pragma once
/// Noise: what can be said of points of a sweep whose runs differ in their seed. The only place of
/// it; tables, sheets, plots, pages and screenings ask here.

#include <cstddef>
#include <utility>
#include <vector>

namespace neve::app::sweep::store {

/// A metric over the runs of a point.
struct Summary {
  std::size_t count = 0;
  double mean = 0, min = 0, max = 0;
  double variance = 0;  ///< of the values, with count - 1; 0 of less than two
  /// min to max is an interval that holds the value four times in five, and mean is expected.
  bool is_interval = false;
};

Summary summary_of(const std::vector<double>& values);

/// A difference that chance alone would make this often is too close to call.
inline constexpr double doubt = 0.05;

/// Probability that |t| of Student's distribution is this large or larger.
/// @param freedom  degrees of freedom, > 0, not necessarily whole
double t_tail(double t, double freedom);

/// Probability that F of the F distribution is this large or larger.
double f_tail(double f, double between, double within);

/// True if the means differ by more than noise: Welch's interval of their difference, at a
/// confidence of 1 - doubt, does not hold 0; where one of them is an interval, if min to max do not
/// overlap. False of points with less than two values.
/// Source: B. L. Welch 1947, The generalization of "Student's" problem.
bool differ(const Summary& a, const Summary& b);

/// The verdict of a test on a metric. Without a point of two values nothing is known of noise,
/// which is no evidence of it.
enum class Verdict { unknown, noise, real };

/// Returns real if the means of some of these points differ by more than the values within points
/// do: the F test of an analysis of variance. A metric for which they do not is noise. Unknown
/// without two points that have values, or without a point that has two.
Verdict vary(const std::vector<Summary>& points);

/// Real if these steps, each from one point to another, change the metric by more than noise: the F
/// test of the mean square of their changes. No point may belong to two steps. Unknown without
/// steps, or without a point of two values.
Verdict change(const std::vector<std::pair<Summary, Summary>>& steps);

/// 1 + the number of points that are greater by more than noise: those that are too close to call
/// with the greatest share rank 1. 0 of points without values.
std::vector<int> shared_ranks(const std::vector<Summary>& points);

/// The same by the means alone, where noise is not known.
std::vector<int> ranks_of_means(const std::vector<Summary>& points);

/// The groups that each point belongs to, from 0, the group of the greatest: two points share a
/// group exactly where they are too close to call. Points without values belong to none.
/// Source: H.-P. Piepho 2004, An algorithm for a letter-based representation of all-pairwise
/// comparisons.
std::vector<std::vector<int>> close_groups(const std::vector<Summary>& points);

/// The mean of each point where its rank is its own, and the mean of all points of its rank where
/// it shares it.
std::vector<double> shared_means(const std::vector<Summary>& points, const std::vector<int>& ranks);

}  // namespace neve::app::sweep::store
