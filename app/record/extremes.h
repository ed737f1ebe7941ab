#pragma once
/// The greatest that happened in a run, over all of its frames: also those that were not drawn.

#include <limits>
#include <optional>
#include <vector>

#include "app/support/json.h"

namespace neve::app::record {

struct FrameRecord;
struct RunStart;

struct Extremes {
  int frame = 0;     ///< number of the last frame that they know
  double steps = 0;  ///< in all
  double max_speed = 0, max_force = 0, max_pressure = 0;  ///< m/s, N, Pa
  std::optional<double> max_body_speed{};                 ///< m/s

  /// The frame after the last one.
  void add(const FrameRecord& frame);
};

Json to_json(const Extremes& extremes);
/// @throws nlohmann::json::exception
Extremes extremes_of(const Json& json);

/// Of a run from its start to a frame, or to its last one if it has fewer. Nothing where its frames
/// begin later and it does not know what was before.
std::optional<Extremes> extremes_until(const Json& run, int last);
/// The same to the last one, of a run whose frames and start are read already.
std::optional<Extremes> extremes_of_run(const Json& run, const std::vector<FrameRecord>& frames,
                                        const std::optional<RunStart>& start,
                                        int last = std::numeric_limits<int>::max());

}  // namespace neve::app::record
