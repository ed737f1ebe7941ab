#include "app/output/run_json.h"

#include <cstdio>

#include "app/output/atomic_file.h"
#include "app/output/sequence.h"
#include "app/version.h"

namespace neve::app {

namespace {

Json vector_json(const sim::Vec3d& v) {
  return Json::array({number_or_null(v.x()), number_or_null(v.y()), number_or_null(v.z())});
}

/// Rows of a 3x3 matrix.
Json matrix_json(const sim::Mat3d& matrix) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) rows.push_back(vector_json(matrix.row(row).transpose()));
  return rows;
}

}  // namespace

const char* name(RunStatus status) {
  switch (status) {
    case RunStatus::running:
      return "running";
    case RunStatus::ok:
      return "ok";
    case RunStatus::diverged:
      return "diverged";
    case RunStatus::interrupted:
      return "interrupted";
    case RunStatus::failed:
      return "failed";
  }
  return "failed";
}

std::string hash_text(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

Json to_json(const FrameRecord& frame) {
  const bool has_steps = frame.advance.steps > 0;
  const sim::Summary& s = frame.summary;
  Json json;
  json["frame"] = frame.frame;
  json["time"] = number_or_null(frame.time);
  json["steps"] = frame.advance.steps;
  json["dt_min"] = has_steps ? number_or_null(frame.advance.dt_min) : Json();
  json["dt_max"] = has_steps ? number_or_null(frame.advance.dt_max) : Json();
  json["dt_limit"] = has_steps ? Json(sim::name(frame.advance.limit())) : Json();
  json["seconds_sim"] = number_or_null(frame.seconds_sim);
  json["seconds_render"] = number_or_null(frame.seconds_render);
  json["particles"] = s.particles;
  json["kinetic_energy"] = number_or_null(s.kinetic_energy);
  json["elastic_energy"] = number_or_null(s.elastic_energy);
  json["momentum"] = vector_json(s.momentum);
  json["centre_of_mass"] = vector_json(s.centre_of_mass);
  json["max_speed"] = number_or_null(s.max_speed);
  json["min_J_P"] = number_or_null(s.min_J_P);
  json["max_J_P"] = number_or_null(s.max_J_P);
  json["state_hash"] = hash_text(frame.state_hash);
  return json;
}

Json to_json(const sim::Divergence& d) {
  Json json;
  json["step"] = d.step;
  json["time"] = number_or_null(d.time);
  json["stage"] = d.stage;
  json["rule"] = d.rule;
  json["particle"] = d.particle >= 0 ? Json(d.particle) : Json();
  json["x"] = vector_json(d.x);
  json["v"] = vector_json(d.v);
  json["F_E"] = matrix_json(d.F_E);
  json["J_E"] = number_or_null(d.J_E);
  json["J_P"] = number_or_null(d.J_P);
  json["value"] = number_or_null(d.value);
  json["limit"] = number_or_null(d.limit);
  json["dt"] = number_or_null(d.dt);
  json["dt_that_holds"] = number_or_null(d.dt_that_holds);
  json["culprits"] = d.culprits;
  json["sentence"] = d.sentence;
  return json;
}

Json to_json(const RunRecord& run) {
  Json json;
  json["version"] = version;
  json["scene"] = run.scene;
  json["scene_file"] = run.scene_file;
  json["overrides"] = run.overrides;
  json["coarsen"] = run.coarsening;
  json["views"] = run.views;
  json["backend"] = run.backend;
  json["gl_renderer"] = run.gl_renderer;
  json["threads"] = run.threads;
  json["simd"] = run.simd;
  json["status"] = name(run.status);
  if (!run.error.empty()) json["error"] = run.error;
  json["frames"] = Json::array();
  for (const FrameRecord& frame : run.frames) json["frames"].push_back(to_json(frame));
  if (run.divergence) json["divergence"] = to_json(*run.divergence);
  return json;
}

void write_run_json(const std::filesystem::path& folder, const RunRecord& run) {
  write_file(run_json_path(folder), to_text(to_json(run)) + "\n");
}

}  // namespace neve::app
