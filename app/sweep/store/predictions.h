#pragma once
/// Predictions for the points of a coarse sweep at full resolution: by coarse copies, or by runs
/// that were made.

#include <filesystem>
#include <vector>

#include "app/predict/predict.h"
#include "app/sweep/store/manifest.h"
#include "app/sweep/store/results.h"
#include "app/sweep/store/statistics.h"

namespace neve::app::sweep::store {

/// The results of the runs at full resolution that have ended and are whole, one place for each run
/// of the sweep; empty for a sweep without --refine.
std::vector<std::optional<RunResult>> full_results(const std::filesystem::path& folder,
                                                   const Manifest& manifest);

/// Returns the results of the seeds of a point that ended at full resolution.
/// @param full  see full_results() @param first  run of the point
std::vector<const RunResult*> full_results_of(const std::vector<std::optional<RunResult>>& full,
                                              std::size_t first, int seeds);

/// One for each point: its runs at full resolution where it has some, otherwise what its copies
/// say; none of a sweep without --predict and --refine.
std::vector<predict::Prediction> predictions_of(const std::filesystem::path& folder,
                                                const Manifest& manifest);

/// A quantity of all points, as intervals; without values where copies cannot say. That of a lone
/// run at full resolution is where one with another seed may lie.
std::vector<Summary> summaries_of(const std::vector<predict::Prediction>& predictions,
                                  predict::Quantity quantity);

/// The metric that a quantity is, of metric_infos().
std::size_t metric_of(predict::Quantity quantity);

/// The first quantity that tells some points apart; nothing if none does.
std::optional<predict::Quantity> telling_quantity(
    const std::vector<predict::Prediction>& predictions);

/// Counts the points that break, hold and are undecided, in a sentence; "" without predictions.
std::string prediction_line(const std::vector<predict::Prediction>& predictions);

}  // namespace neve::app::sweep::store
