#pragma once
/// The data of a sweep that report.html holds: columns, runs, axes, commands.

#include <string>
#include <vector>

#include "app/predict/predict.h"
#include "app/support/json.h"
#include "app/sweep/store/results.h"

namespace neve::app::sweep::sheet {

/// "columns" and "rows" of the table; each row also with the frames that have pictures, where these
/// are from the folder of the sweep, its levels on "axes", and commands to paste.
/// With seeds or predictions also "outcomes" of the points and "noise" of the metrics.
/// @param folder as the commands name it
/// @param predictions  of the points: a column each of verdict and quantities; none without
Json report_data(const std::string& folder, const store::Manifest& manifest,
                 const std::vector<store::RunResult>& results,
                 const std::vector<predict::Prediction>& predictions);

}  // namespace neve::app::sweep::sheet
