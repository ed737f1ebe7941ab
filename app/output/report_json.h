#pragma once
/// Reports of a simulation as JSON, shared by run.json, incident.json and checkpoints.

#include <vector>

#include "app/support/json.h"
#include "sim/checks/watch.h"
#include "sim/retry.h"
#include "sim/types/reports.h"

namespace neve::app::output {

/// "[x, y, z]"; a number that is not finite is null, and the other way round.
Json vector_json(const sim::Vec3d& v);
sim::Vec3d vector_of(const Json& json);
/// The rows of a matrix.
Json matrix_json(const sim::Mat3d& matrix);
/// The inverse of number_or_null.
double number_or_nan(const Json& json);

/// Every field, exactly.
Json to_json(const sim::AdvanceReport& advance);
/// @throws nlohmann::json::exception
sim::AdvanceReport advance_report(const Json& json);

Json to_json(const sim::Divergence& divergence);
/// Every check: check, worst, threshold, first_step (null if it held), times.
Json to_json(const std::vector<sim::checks::WatchRecord>& records);
Json to_json(const sim::Retry& retry);
/// @throws nlohmann::json::exception
sim::Retry retry_record(const Json& json);

}  // namespace neve::app::output
