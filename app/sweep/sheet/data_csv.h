#pragma once
/// data.csv of a Cinema database, specification D: one row per run.

#include <string>
#include <vector>

#include "app/predict/predict.h"
#include "app/sweep/store/results.h"

namespace neve::app::sweep::sheet {

/// Columns: run, label, one per parameter (three for vectors), state, reason, warnings (how many),
/// frames, metrics, with predictions full_by (copies, or runs at full resolution), with seeds how
/// many runs there were and how many broke, full_verdict and for each quantity that which is
/// expected at full resolution, with its interval, or mean, min and max of the runs there, and the
/// FILE columns last. A column's type comes from the parameter, never from its values: floats
/// always have a point or an exponent, whole numbers never. Metrics of runs that did not get to
/// their last frame are empty, but for steps and seconds.
/// @param with_times false leaves out values that differ between machines
/// @param predictions  of the points; none without --predict
std::string data_csv(const store::Manifest& manifest, const std::vector<store::RunResult>& results,
                     const std::vector<predict::Prediction>& predictions = {},
                     bool with_times = true);

/// points.csv of a sweep with seeds: one row per point. Columns: point, label, the parameters,
/// runs, ended, judged, broken, and for each metric its mean, min and max, its rank, which points
/// that are too close to call share, and the letters of its groups; then the predictions, as in
/// data.csv. "" without seeds.
std::string points_csv(const store::Manifest& manifest,
                       const std::vector<store::RunResult>& results,
                       const std::vector<predict::Prediction>& predictions = {},
                       bool with_times = true);

}  // namespace neve::app::sweep::sheet
