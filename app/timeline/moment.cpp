#include "app/timeline/moment.h"

#include <cmath>
#include <limits>
#include <new>
#include <span>
#include <stdexcept>
#include <utility>

#include "app/output/report_json.h"
#include "app/support/errors.h"
#include "app/support/version.h"

namespace neve::app::timeline {

namespace {

[[noreturn]] void refuse_value(const std::string& name, const Json& value,
                               const std::string& expected) {
  throw std::runtime_error(name + " = " + to_text(value, -1).substr(0, 40) + "; expected " +
                           expected);
}

std::size_t count_of(const Json& json, const std::string& name, std::size_t max) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > max)
    refuse_value(name, json, "a whole number from 0 to " + std::to_string(max));
  return json.get<std::size_t>();
}

double number_of(const Json& json, const std::string& name) {
  if (!json.is_number() || !std::isfinite(json.get<double>()))
    refuse_value(name, json, "a finite number");
  return json.get<double>();
}

Json bodies_json(const std::vector<picture::BodySample>& bodies) {
  Json list = Json::array();
  for (const picture::BodySample& body : bodies)
    list.push_back({body.name, number_or_null(body.height), number_or_null(body.speed),
                    output::vector_json(body.rotation)});
  return list;
}

std::vector<picture::BodySample> bodies_of(const Json& list) {
  std::vector<picture::BodySample> bodies;
  for (const Json& body : list) {
    bodies.push_back({body.at(0).get<std::string>(), number_of(body.at(1), "history height"),
                      number_of(body.at(2), "history speed")});
    // Checkpoints of earlier versions have no rotations.
    for (int a = 0; a < 3 && body.size() > 3; ++a)
      bodies.back().rotation[a] =
          number_of(body.at(3).at(static_cast<std::size_t>(a)), "history rotation");
  }
  return bodies;
}

Json history_json(std::span<const picture::PlotSample> history) {
  Json rows = Json::array();
  for (const picture::PlotSample& s : history)
    rows.push_back({number_or_null(s.time), number_or_null(s.kinetic_energy),
                    number_or_null(s.elastic_energy), number_or_null(s.max_speed), s.steps,
                    static_cast<int>(s.limit), number_or_null(s.max_force), bodies_json(s.bodies)});
  return rows;
}

/// One row a frame, from 0 to that of the checkpoint.
std::vector<picture::PlotSample> history_of(const Json& rows, int frame, std::size_t steps) {
  if (!rows.is_array() || rows.size() != static_cast<std::size_t>(frame) + 1)
    throw std::runtime_error("history has " + std::to_string(rows.size()) + " rows; expected " +
                             std::to_string(frame + 1) + ", one a frame");
  std::vector<picture::PlotSample> history;
  for (const Json& row : rows) {
    picture::PlotSample s;
    s.time = number_of(row.at(0), "history time");
    s.kinetic_energy = number_of(row.at(1), "history kinetic_energy");
    s.elastic_energy = number_of(row.at(2), "history elastic_energy");
    s.max_speed = number_of(row.at(3), "history max_speed");
    s.steps = count_of(row.at(4), "history steps", steps);
    s.limit =
        static_cast<sim::DtLimit>(count_of(row.at(5), "history limit", sim::dt_limit_count - 1));
    // Checkpoints of earlier versions have no forces: their curve has a gap.
    s.max_force = row.size() > 6 && !row.at(6).is_null() ? number_of(row.at(6), "history max_force")
                                                         : std::numeric_limits<double>::quiet_NaN();
    if (row.size() > 7) s.bodies = bodies_of(row.at(7));
    history.push_back(s);
  }
  return history;
}

sim::AdvanceReport advance_of(const Json& json, std::size_t steps) {
  count_of(json.at("steps"), "advance steps", steps);
  for (const Json& ruled : json.at("ruled")) count_of(ruled, "advance ruled", steps);
  for (const char* name : {"dt_min", "dt_max", "seconds"})
    if (json.contains(name)) number_of(json.at(name), std::string("advance ") + name);
  return output::advance_report(json);
}

/// @param first, last  numbers
std::vector<record::FrameRecord> frames_of(const Json& list, int first, int last,
                                           std::size_t steps) {
  std::vector<record::FrameRecord> frames;
  int before = first - 1;
  for (const Json& json : list) {
    const int number = whole_number<int>(json.at("frame"));
    if (number <= before || number > last)
      refuse_value("frames frame", json.at("frame"), "frames in order");
    count_of(json.at("steps"), "frames steps", steps);
    frames.push_back(record::frame_record(json));
    before = number;
  }
  return frames;
}

/// The report of a frame that ended: earlier versions kept the one of its record alone.
sim::AdvanceReport advance_of_frame(const Json& progress, const Moment& moment) {
  if (progress.contains("advance_of_frame"))
    return advance_of(progress.at("advance_of_frame"), moment.steps);
  const timeline::Made& made = moment.made;
  const bool is_last =
      !made.frames.empty() && made.frames.back().frame == made.first_number + moment.frame;
  return is_last ? made.frames.back().advance : sim::AdvanceReport{};
}

void read_progress(const Json& progress, Moment& moment) {
  moment.advance = advance_of(progress.at("advance"), moment.steps);
  moment.steps_of_frame = moment.steps - moment.advance.steps;
  moment.history = history_of(progress.at("history"), moment.frame, moment.steps);
  for (const Json& retry : progress.at("retries"))
    moment.retries.push_back(output::retry_record(retry));
  // Checkpoints of earlier versions have neither.
  if (progress.contains("frames")) {
    constexpr int furthest = 2'000'000;
    const int first = whole_number_or(progress, "first_number", 0);
    if (std::abs(first) > furthest) refuse_value("first_number", first, "the number of a frame");
    moment.made.first_number = first;
    moment.made.frames =
        frames_of(progress.at("frames"), first, first + moment.frame, moment.steps);
    moment.made.files = record::file_hashes(progress);
    moment.made.exports = progress.value("exports", Json());
  }
  if (moment.is_frame_end()) moment.advance = advance_of_frame(progress, moment);
}

}  // namespace

output::Checkpoint to_checkpoint(Moment moment, const std::string& identity,
                                 const std::string& simd) {
  const sim::AdvanceReport none;
  Json progress = {{"advance", output::to_json(moment.is_frame_end() ? none : moment.advance)},
                   {"history", history_json(moment.history)},
                   {"retries", Json::array()},
                   {"frames", Json::array()},
                   {"first_number", moment.made.first_number},
                   {"files", moment.made.files},
                   {"exports", moment.made.exports}};
  if (moment.is_frame_end()) progress["advance_of_frame"] = output::to_json(moment.advance);
  for (const sim::Retry& retry : moment.retries)
    progress["retries"].push_back(output::to_json(retry));
  for (const record::FrameRecord& made : moment.made.frames)
    if (made.frame <= moment.made.first_number + moment.frame)
      progress["frames"].push_back(to_json(made));
  return {identity,
          simd,
          build().sources,
          moment.frame,
          moment.steps,
          std::move(progress),
          std::move(moment.state)};
}

Moment to_moment(output::Checkpoint checkpoint) {
  Moment moment;
  moment.file = checkpoint.file;
  moment.frame = checkpoint.frame;
  moment.steps = checkpoint.steps;
  moment.state = std::move(checkpoint.state);
  try {
    read_progress(checkpoint.progress, moment);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse_moment(moment.file, error);
  }
  return moment;
}

void refuse_moment(const std::filesystem::path& file, const std::exception& why) {
  throw IoError(file.string() + ": cannot resume from it: " + why.what(), file.string(),
                "no run has written this; remove the file to resume from an older checkpoint, or "
                "remove --resume to start again");
}

}  // namespace neve::app::timeline
