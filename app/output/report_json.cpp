#include "app/output/report_json.h"

#include <limits>

namespace neve::app::output {

Json vector_json(const sim::Vec3d& v) {
  return Json::array({number_or_null(v.x()), number_or_null(v.y()), number_or_null(v.z())});
}

Json matrix_json(const sim::Mat3d& matrix) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) rows.push_back(vector_json(matrix.row(row).transpose()));
  return rows;
}

double number_or_nan(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

sim::Vec3d vector_of(const Json& json) {
  return {number_or_nan(json.at(0)), number_or_nan(json.at(1)), number_or_nan(json.at(2))};
}

Json to_json(const sim::AdvanceReport& advance) {
  Json json = {{"steps", advance.steps},
               {"dt_min", advance.dt_min},
               {"dt_max", advance.dt_max},
               {"ruled", advance.ruled},
               {"seconds", advance.seconds}};
  for (const sim::ColliderLoad& load : advance.loads)
    json["loads"].push_back({vector_json(load.impulse), vector_json(load.angular_impulse)});
  if (advance.solve)
    json["solve"] = {{"iterations", advance.solve->iterations},
                     {"residual", number_or_null(advance.solve->residual)},
                     {"solves", advance.solve->solves},
                     {"cut_short", advance.solve->cut_short},
                     {"given_up", advance.solve->given_up},
                     {"all_iterations", advance.solve->all_iterations}};
  return json;
}

sim::AdvanceReport advance_report(const Json& json) {
  sim::AdvanceReport advance;
  advance.steps = whole_number<std::size_t>(json.at("steps"));
  advance.dt_min = json.at("dt_min").get<double>();
  advance.dt_max = json.at("dt_max").get<double>();
  for (std::size_t k = 0; k < advance.ruled.size(); ++k)
    advance.ruled[k] = whole_number<std::size_t>(json.at("ruled").at(k));
  advance.seconds = json.value("seconds", 0.0);
  if (json.contains("loads"))
    for (const Json& load : json.at("loads"))
      advance.loads.push_back({vector_of(load.at(0)), vector_of(load.at(1))});
  if (json.contains("solve"))
    advance.solve = {whole_number<int>(json.at("solve").at("iterations")),
                     number_or_nan(json.at("solve").at("residual")),
                     whole_number_or(json.at("solve"), "solves", std::size_t(1)),
                     whole_number_or(json.at("solve"), "cut_short", std::size_t(0)),
                     whole_number_or(json.at("solve"), "given_up", std::size_t(0)),
                     whole_number_or(json.at("solve"), "all_iterations", std::uint64_t(0))};
  return advance;
}

Json to_json(const sim::Divergence& d) {
  Json json;
  json["step"] = d.step;
  json["time"] = number_or_null(d.time);
  json["stage"] = d.stage;
  json["rule"] = d.rule;
  json["particle"] = d.particle >= 0 ? Json(d.particle) : Json();
  json["material"] = d.material;
  json["x"] = vector_json(d.x);
  json["v"] = vector_json(d.v);
  json["F_E"] = matrix_json(d.F_E);
  json["singular_values"] = vector_json(d.stretches);
  json["J_E"] = number_or_null(d.J_E);
  json["J_P"] = number_or_null(d.J_P);
  json["kirchhoff_stress"] = matrix_json(d.kirchhoff);
  json["sound_speed"] = number_or_null(d.sound_speed);
  json["value"] = number_or_null(d.value);
  json["limit"] = number_or_null(d.limit);
  json["dt"] = number_or_null(d.dt);
  json["dt_that_holds"] = number_or_null(d.dt_that_holds);
  json["culprits"] = d.culprits;
  json["sentence"] = d.sentence;
  return json;
}

Json to_json(const std::vector<sim::checks::WatchRecord>& records) {
  Json list = Json::array();
  for (const sim::checks::WatchRecord& record : records) {
    const bool has_held = record.times == 0;
    list.push_back({{"check", sim::checks::name(record.check)},
                    {"worst", number_or_null(record.worst)},
                    {"threshold", number_or_null(record.threshold)},
                    {"first_step", has_held ? Json() : Json(record.first_step)},
                    {"times", record.times}});
  }
  return list;
}

Json to_json(const sim::Retry& retry) {
  return {{"step", retry.step},         {"time", retry.time}, {"back_to", retry.back_to},
          {"dt_scale", retry.dt_scale}, {"rule", retry.rule}, {"sentence", retry.sentence}};
}

sim::Retry retry_record(const Json& json) {
  return {whole_number<std::size_t>(json.at("step")), json.at("time").get<double>(),
          json.at("back_to").get<double>(),           json.at("dt_scale").get<double>(),
          json.at("rule").get<std::string>(),         json.at("sentence").get<std::string>()};
}

}  // namespace neve::app::output
