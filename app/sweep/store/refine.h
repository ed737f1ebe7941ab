#pragma once
/// Coarse first, fine where it counts: which points of a coarse sweep are made at full resolution
/// as well, and how well the coarse runs ranked them.

#include <string>
#include <vector>

#include "app/sweep/store/predictions.h"

namespace neve::app::sweep::store {

/// A metric by which points are best, and which end of it.
struct Best {
  std::size_t metric = 0;  ///< of metric_infos()
  bool is_min = false;

  /// "spread" or "spread:least". @throws UsageError for another word
  static Best parse(const std::string& flag, const std::string& text);
  std::string text() const;
};

/// Points whose verdict is open first, then the best ones; each by the best of its coarse runs.
/// Points without a run that reached its end are left out.
/// @param predictions  of the points; none without --predict
/// @return first runs of at most `count` points, in the order in which they were chosen
std::vector<std::size_t> points_to_refine(const Manifest& manifest,
                                          const std::vector<RunResult>& results,
                                          const std::vector<predict::Prediction>& predictions,
                                          std::size_t count, const Best& best);

/// Spearman's rank correlation, ties sharing the mean of their ranks; nothing for less than three
/// pairs, or where all values are equal.
std::optional<double> rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

/// Tells how well the coarse runs ranked the points that were made at full resolution as well, in a
/// sentence; "" with less than three of them.
std::string ranking_line(const Manifest& manifest, const std::vector<RunResult>& results,
                         const std::vector<std::optional<RunResult>>& full);

}  // namespace neve::app::sweep::store
