#include "app/sweep/store/refine.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/sweep/store/points.h"

namespace neve::app::sweep::store {

namespace {

constexpr const char* min_suffix = ":least";

bool is_open(const predict::Prediction& prediction) {
  return prediction.verdict == predict::Verdict::undecided;
}

/// Ranks values from 1; equal ones have the mean of their ranks.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<double> ranks;
  for (const double value : values) {
    double below = 0, equal = 0;
    for (const double other : values) {
      below += other < value;
      equal += other == value;
    }
    ranks.push_back(below + (equal + 1) / 2);
  }
  return ranks;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

Best Best::parse(const std::string& flag, const std::string& text) {
  Best best;
  std::string name = text;
  if (name.ends_with(min_suffix)) {
    best.is_min = true;
    name.resize(name.size() - std::string(min_suffix).size());
  }
  std::vector<std::string> known;
  for (std::size_t k = 0; k < metric_infos().size(); ++k) {
    if (metric_infos()[k].is_time) continue;
    known.emplace_back(metric_infos()[k].name);
    if (name != known.back()) continue;
    best.metric = k;
    return best;
  }
  throw UsageError(flag, "there is no metric \"" + name + "\"",
                   "expected " + joined(known, ", ") + "; with " + min_suffix +
                       " for the least, as in spread" + min_suffix);
}

std::string Best::text() const {
  return metric_infos()[metric].name + std::string(is_min ? min_suffix : "");
}

std::vector<std::size_t> points_to_refine(const Manifest& manifest,
                                          const std::vector<RunResult>& results,
                                          const std::vector<predict::Prediction>& predictions,
                                          std::size_t count, const Best& best) {
  const std::vector<Point> points = points_of(manifest, results);
  const auto is_measured = [&](std::size_t k) { return points[k].metrics[best.metric].count > 0; };
  const auto open = [&](std::size_t k) {
    return predictions.empty() ? is_undecided(points[k]) : is_open(predictions[k]);
  };
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (open(k) || is_measured(k)) order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (open(a) != open(b)) return open(a);
    // Points without the metric are no worse and no better than each other.
    if (!is_measured(a) || !is_measured(b)) return is_measured(a) && !is_measured(b);
    const double x = points[a].metrics[best.metric].mean, y = points[b].metrics[best.metric].mean;
    return best.is_min ? x < y : x > y;
  });
  std::vector<std::size_t> runs;
  for (std::size_t k = 0; k < std::min(count, order.size()); ++k)
    runs.push_back(points[order[k]].first);
  return runs;
}

std::optional<double> rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr std::size_t least = 3;
  if (a.size() < least || a.size() != b.size()) return std::nullopt;
  const std::vector<double> x = ranks_of(a), y = ranks_of(b);
  const double x_mean = mean_of(x), y_mean = mean_of(y);
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xy += (x[k] - x_mean) * (y[k] - y_mean);
    xx += (x[k] - x_mean) * (x[k] - x_mean);
    yy += (y[k] - y_mean) * (y[k] - y_mean);
  }
  if (!(xx > 0 && yy > 0)) return std::nullopt;
  return xy / std::sqrt(xx * yy);
}

namespace {

/// The number of runs that tell whether the snow breaks, and of those in which it does.
struct Outcome {
  std::size_t judged = 0, broken = 0;

  bool is_told() const { return judged > 0; }
  bool is_like(const Outcome& other) const {
    return (broken == 0) == (other.broken == 0) &&
           (broken == judged) == (other.broken == other.judged);
  }
};

Outcome outcome_of(const std::vector<const RunResult*>& runs) {
  Outcome outcome;
  for (const RunResult* run : runs) {
    outcome.judged += run->has_broken.has_value();
    outcome.broken += run->has_broken.value_or(false);
  }
  return outcome;
}

}  // namespace

std::string ranking_line(const Manifest& manifest, const std::vector<RunResult>& results,
                         const std::vector<std::optional<RunResult>>& full) {
  const std::vector<Point> points = points_of(manifest, results);
  std::vector<std::vector<const RunResult*>> of_points;
  std::vector<std::string> found;
  std::size_t made = 0, same = 0, judged = 0;
  for (const Point& point : points) {
    of_points.push_back(full_results_of(full, point.first, manifest.seeds));
    if (of_points.back().empty()) continue;
    ++made;
    const Outcome coarse{point.judged, point.broken}, fine = outcome_of(of_points.back());
    if (!coarse.is_told() || !fine.is_told()) continue;
    ++judged;
    same += coarse.is_like(fine);
  }
  for (int q = 0; q < predict::quantity_count; ++q) {
    const auto quantity = static_cast<predict::Quantity>(q);
    const std::size_t metric = metric_of(quantity);
    std::vector<double> coarse, fine;
    for (std::size_t k = 0; k < points.size(); ++k) {
      std::vector<double> values;
      for (const RunResult* run : of_points[k])
        if (run->metrics[metric]) values.push_back(*run->metrics[metric]);
      if (values.empty() || points[k].metrics[metric].count == 0) continue;
      coarse.push_back(points[k].metrics[metric].mean);
      fine.push_back(summary_of(values).mean);
    }
    if (const std::optional<double> rho = rank_correlation(coarse, fine))
      found.push_back(fmt::format("{} {}", predict::info_of(quantity).title, fixed_text(*rho, 2)));
  }
  if (found.empty()) return "";
  const bool has_seeds = manifest.seeds > 1;
  return fmt::format(
      "{} points at full resolution: {} of {} {} as the coarse {} did; rank correlation of "
      "{}coarse "
      "and full: {}",
      made, same, judged, has_seeds ? "break in all, some or none of their seeds" : "break or hold",
      has_seeds ? "runs" : "run", has_seeds ? "the means of " : "", joined(found, ", "));
}

}  // namespace neve::app::sweep::store
