#include "app/record/run_json.h"

#include <algorithm>

#include "app/output/report_json.h"

namespace neve::app::record {

void Extremes::add(const FrameRecord& record) {
  frame = record.frame;
  steps += static_cast<double>(record.advance.steps);
  max_speed = std::max(max_speed, record.summary.max_speed);
  for (const ColliderForce& f : record.forces) {
    max_force = std::max(max_force, f.force.norm());
    max_pressure = std::max(max_pressure, f.max_pressure);
  }
  if (const std::optional<double> speed = largest_speed(record.bodies))
    max_body_speed = std::max(max_body_speed.value_or(0), *speed);
}

Json to_json(const Extremes& extremes) {
  return {{"frame", extremes.frame},
          {"steps", extremes.steps},
          {"max_speed", number_or_null(extremes.max_speed)},
          {"max_force", number_or_null(extremes.max_force)},
          {"max_pressure", number_or_null(extremes.max_pressure)},
          {"max_body_speed",
           extremes.max_body_speed ? number_or_null(*extremes.max_body_speed) : Json()}};
}

Extremes extremes_of(const Json& json) {
  Extremes extremes{whole_number<int>(json.at("frame")), output::number_or_nan(json.at("steps")),
                    output::number_or_nan(json.at("max_speed")),
                    output::number_or_nan(json.at("max_force")),
                    output::number_or_nan(json.at("max_pressure"))};
  if (!json.at("max_body_speed").is_null())
    extremes.max_body_speed = output::number_or_nan(json.at("max_body_speed"));
  return extremes;
}

std::optional<Extremes> extremes_until(const Json& run, int last) {
  return extremes_of_run(run, frame_records(run), start_of(run), last);
}

std::optional<Extremes> extremes_of_run(const Json& run, const std::vector<FrameRecord>& frames,
                                        const std::optional<RunStart>& start, int last) {
  std::optional<Extremes> extremes = start ? start->before : std::nullopt;
  if (!extremes && frames.empty()) return std::nullopt;
  if (!extremes) {
    const int first = frames.front().frame;
    // Runs of before they had a first number begin with their first frame.
    if (whole_number_or(run, "first_number", first) != first) return std::nullopt;
    extremes = Extremes{first - 1};
  }
  // Earlier frames may have been drawn after those that the start was noted for.
  for (const FrameRecord& frame : frames)
    if (frame.frame > extremes->frame && frame.frame <= last) extremes->add(frame);
  return extremes;
}

}  // namespace neve::app::record
