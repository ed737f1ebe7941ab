#include "app/sweep/store/statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace neve::app::sweep::store {

namespace {

/// Rounding of a metric, as a share of its size: a difference below it is none.
constexpr double rounding = 1e-9;

/// The continued fraction of the incomplete beta function, by the modified method of Lentz.
/// Source: Abramowitz and Stegun 26.5.8.
double beta_fraction(double x, double a, double b) {
  constexpr double tiny = 1e-300, precision = 1e-15;
  constexpr int max_terms = 500;
  const auto kept = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1, d = 1 / kept(1 - (a + b) * x / (a + 1)), fraction = d;
  for (int m = 1; m <= max_terms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / kept(1 + even * d);
    c = kept(1 + even / c);
    fraction *= c * d;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / kept(1 + odd * d);
    c = kept(1 + odd / c);
    fraction *= c * d;
    if (std::abs(c * d - 1) < precision) break;
  }
  return fraction;
}

/// The regularized incomplete beta function I_x(a, b).
double incomplete_beta(double x, double a, double b) {
  if (!(x > 0)) return 0;
  if (x >= 1) return 1;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  // The fraction converges fast on this side of the mean.
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(x, a, b) / a;
  return 1 - front * beta_fraction(1 - x, b, a) / b;
}

/// A mean square that is due to rounding.
double rounding_square(const Summary& point) {
  const double size = rounding * std::max(std::abs(point.min), std::abs(point.max));
  return size * size;
}

/// @param between, within  mean squares; of values that agree within points any change is one
Verdict verdict_of(double between, double within, double freedom_between, double freedom_within,
                   double least) {
  if (freedom_within < 1) return Verdict::unknown;
  if (!(between > least)) return Verdict::noise;
  const bool is_real =
      !(within > 0) || f_tail(between / within, freedom_between, freedom_within) < doubt;
  return is_real ? Verdict::real : Verdict::noise;
}

/// Sets of points no two of which differ; Piepho's inserting and absorbing.
using Set = std::vector<bool>;

bool is_within(const Set& small, const Set& large) {
  for (std::size_t k = 0; k < small.size(); ++k)
    if (small[k] && !large[k]) return false;
  return true;
}

/// Adds a set in place of those that it holds, unless another holds it.
void add_set(Set set, std::vector<Set>& sets) {
  for (const Set& other : sets)
    if (is_within(set, other)) return;
  std::erase_if(sets, [&](const Set& other) { return is_within(other, set); });
  sets.push_back(std::move(set));
}

/// Splits each set that holds both points.
void separate(std::size_t a, std::size_t b, std::vector<Set>& sets) {
  std::vector<Set> kept, split;
  for (Set& set : sets) (set[a] && set[b] ? split : kept).push_back(std::move(set));
  for (const Set& set : split)
    for (const std::size_t out : {a, b}) {
      Set part = set;
      part[out] = false;
      add_set(std::move(part), kept);
    }
  sets = std::move(kept);
}

/// Points by their means, the greatest first; those without values are left out.
std::vector<std::size_t> greatest_first(const std::vector<Summary>& points) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (points[k].count > 0) order.push_back(k);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return points[a].mean > points[b].mean; });
  return order;
}

/// Sets in the order in which their first member comes.
std::vector<Set> close_sets(const std::vector<Summary>& points,
                            const std::vector<std::size_t>& order) {
  // Values of strangers could make any number of sets: then all are said to be close.
  const std::size_t max_sets = 4 * order.size() + 64;
  const Set all(order.size(), true);
  std::vector<Set> sets{all};
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      if (!differ(points[order[a]], points[order[b]])) continue;
      separate(a, b, sets);
      if (sets.size() > max_sets) return {all};
    }
  std::sort(sets.begin(), sets.end(), std::greater<>());
  return sets;
}

}  // namespace

Summary summary_of(const std::vector<double>& values) {
  Summary summary;
  summary.count = values.size();
  if (values.empty()) return summary;
  const auto count = static_cast<double>(values.size());
  summary.min = *std::min_element(values.begin(), values.end());
  summary.max = *std::max_element(values.begin(), values.end());
  summary.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  // Rounding of the sum may lie beyond the values.
  summary.mean = std::clamp(summary.mean, summary.min, summary.max);
  if (values.size() < 2) return summary;
  for (const double x : values) summary.variance += (x - summary.mean) * (x - summary.mean);
  summary.variance /= count - 1;
  return summary;
}

double t_tail(double t, double freedom) {
  return incomplete_beta(freedom / (freedom + t * t), 0.5 * freedom, 0.5);
}

double f_tail(double f, double between, double within) {
  return incomplete_beta(within / (within + between * f), 0.5 * within, 0.5 * between);
}

bool differ(const Summary& a, const Summary& b) {
  if (a.count == 0 || b.count == 0) return false;
  if (a.is_interval || b.is_interval) return a.min > b.max || b.min > a.max;
  if (a.count < 2 || b.count < 2) return false;
  const double difference = a.mean - b.mean;
  if (difference * difference <= std::max(rounding_square(a), rounding_square(b))) return false;
  const auto n_a = static_cast<double>(a.count), n_b = static_cast<double>(b.count);
  const double u = a.variance / n_a, v = b.variance / n_b, sum = u + v;
  if (!(sum > 0)) return true;
  const double freedom = sum * sum / (u * u / (n_a - 1) + v * v / (n_b - 1));
  return t_tail(difference / std::sqrt(sum), freedom) < doubt;
}

Verdict vary(const std::vector<Summary>& points) {
  double count = 0, groups = 0, sum = 0, least = 0;
  for (const Summary& point : points) {
    if (point.count == 0) continue;
    const auto n = static_cast<double>(point.count);
    ++groups;
    count += n;
    sum += n * point.mean;
    least = std::max(least, rounding_square(point));
  }
  if (groups < 2) return Verdict::unknown;
  double between = 0, within = 0;
  for (const Summary& point : points) {
    if (point.count == 0) continue;
    const auto n = static_cast<double>(point.count);
    between += n * (point.mean - sum / count) * (point.mean - sum / count);
    within += (n - 1) * point.variance;
  }
  const double freedom = count - groups;
  return verdict_of(between / (groups - 1), freedom > 0 ? within / freedom : 0, groups - 1, freedom,
                    least);
}

Verdict change(const std::vector<std::pair<Summary, Summary>>& steps) {
  double between = 0, within = 0, count = 0, freedom = 0, least = 0;
  for (const auto& [a, b] : steps) {
    if (a.count == 0 || b.count == 0) continue;
    const auto n_a = static_cast<double>(a.count), n_b = static_cast<double>(b.count);
    between += (a.mean - b.mean) * (a.mean - b.mean) * n_a * n_b / (n_a + n_b);
    within += (n_a - 1) * a.variance + (n_b - 1) * b.variance;
    freedom += n_a + n_b - 2;
    ++count;
    least = std::max({least, rounding_square(a), rounding_square(b)});
  }
  if (count == 0) return Verdict::unknown;
  return verdict_of(between / count, freedom > 0 ? within / freedom : 0, count, freedom, least);
}

namespace {

/// 1 + the number of points that are above one; 0 where no run tells.
template <class Above>
std::vector<int> ranks_by(const std::vector<Summary>& points, const Above& is_above) {
  std::vector<int> ranks;
  for (const Summary& point : points) {
    int rank = point.count > 0 ? 1 : 0;
    for (const Summary& other : points)
      if (point.count > 0 && other.count > 0 && is_above(other, point)) ++rank;
    ranks.push_back(rank);
  }
  return ranks;
}

}  // namespace

std::vector<int> shared_ranks(const std::vector<Summary>& points) {
  return ranks_by(points, [](const Summary& other, const Summary& point) {
    return other.mean > point.mean && differ(other, point);
  });
}

std::vector<int> ranks_of_means(const std::vector<Summary>& points) {
  return ranks_by(
      points, [](const Summary& other, const Summary& point) { return other.mean > point.mean; });
}

std::vector<std::vector<int>> close_groups(const std::vector<Summary>& points) {
  const std::vector<std::size_t> order = greatest_first(points);
  std::vector<std::vector<int>> groups(points.size());
  const std::vector<Set> sets = close_sets(points, order);
  for (std::size_t s = 0; s < sets.size(); ++s)
    for (std::size_t k = 0; k < order.size(); ++k)
      if (sets[s][k]) groups[order[k]].push_back(static_cast<int>(s));
  return groups;
}

std::vector<double> shared_means(const std::vector<Summary>& points,
                                 const std::vector<int>& ranks) {
  std::vector<double> means;
  for (std::size_t k = 0; k < points.size(); ++k) {
    double sum = 0, count = 0;
    for (std::size_t other = 0; other < points.size(); ++other) {
      if (ranks[other] != ranks[k] || points[other].count == 0) continue;
      sum += points[other].mean;
      ++count;
    }
    means.push_back(count > 0 ? sum / count : 0);
  }
  return means;
}

}  // namespace neve::app::sweep::store
