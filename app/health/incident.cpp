#include "app/health/incident.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "app/output/report_json.h"
#include "app/output/sequence.h"
#include "app/scene/names.h"
#include "app/support/round_number.h"

namespace neve::app::health {

namespace {

using sim::Vec3d;

/// Cells that the picture of the slice is high.
constexpr double cells_shown = 26;

/// Speed of most particles near a place, m/s: the culprit's own speed may be any number.
double speed_around(const sim::ParticleArrays& particles, const Vec3d& place, double reach) {
  std::vector<double> speeds;
  for (std::size_t p = 0; p < particles.x.size(); ++p) {
    const double speed = particles.v[p].norm();
    if (std::isfinite(speed) && (particles.x[p] - place).norm() < reach) speeds.push_back(speed);
  }
  if (speeds.empty()) return 0;
  const auto most = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() * 9 / 10);
  std::nth_element(speeds.begin(), most, speeds.end());
  return *most;
}

/// The world axis that the first camera looks along, towards it.
Vec3d facing(const scene::Scene& scene) {
  Vec3d normal(0, 0, 1);
  if (!scene.camera || !scene.camera->eye || !scene.camera->target) return normal;
  const Vec3d look = *scene.camera->eye - *scene.camera->target;
  int axis = 0;
  look.cwiseAbs().maxCoeff(&axis);
  normal = Vec3d::Zero();
  normal[axis] = look[axis] < 0 ? -1 : 1;
  return normal;
}

Json step_json(const sim::StepRecord& s, double h) {
  return {{"step", s.step},
          {"time", number_or_null(s.time)},
          {"dt", number_or_null(s.dt)},
          {"dt_limit", sim::name(s.limit)},
          {"acoustic_cfl", number_or_null(s.max_sound_speed * s.dt / h)},
          {"speed_cfl", number_or_null(s.max_speed * s.dt / h)},
          {"strain", number_or_null(s.max_strain_rate * s.dt)},
          {"max_speed", number_or_null(s.max_speed)},
          {"max_sound_speed", number_or_null(s.max_sound_speed)},
          {"min_J_P", number_or_null(s.min_J_P)},
          {"max_J_P", number_or_null(s.max_J_P)},
          {"inverted", s.inverted}};
}

}  // namespace

std::optional<scene::View> culprit_slice(const scene::Scene& scene,
                                         const sim::Divergence& divergence,
                                         const sim::ParticleArrays& particles) {
  if (!divergence.x.allFinite()) return std::nullopt;
  const double h = scene.solver.cell_size;
  scene::View view;
  view.name = output::culprit_view;
  view.layers = {scene::Layer::colliders, scene::Layer::heatmap, scene::Layer::arrows,
                 scene::Layer::legend, scene::Layer::caption};
  view.slice.normal = facing(scene);
  view.slice.point = divergence.x;
  const double speed = speed_around(particles, divergence.x, cells_shown * h);
  view.slice.range = scene::Range{0, round_up(std::max(speed, 1e-6))};
  view.slice.scalar_range = view.slice.range;
  scene::CameraSettings camera;
  constexpr double half_angle = 0.5 * 3.14159265358979323846 / 180;
  const double distance = 0.5 * cells_shown * h / std::tan(camera.fov * half_angle);
  if (std::abs(view.slice.normal.y()) > 0.5) camera.up = Vec3d(0, 0, -1);
  // The culprit appears between the caption and the legends.
  const Vec3d right = camera.up.cross(view.slice.normal);
  camera.target = divergence.x - 0.12 * cells_shown * h * right;
  camera.eye = *camera.target + distance * view.slice.normal;
  view.camera = camera;
  return view;
}

Json incident_json(const sim::Divergence& divergence, const Diagnosis& diagnosis,
                   const std::string& scene, double cell_size) {
  Json json = output::to_json(divergence);
  json["sentence"] = sentence(divergence, diagnosis);
  json["cause"] = scene::name(diagnosis.cause);
  json["evidence"] = diagnosis.evidence;
  json["remedy"] = diagnosis.remedy;
  json["address"] = diagnosis.address;
  json["last_steps"] = Json::array();
  for (const sim::StepRecord& step : divergence.last_steps)
    json["last_steps"].push_back(step_json(step, cell_size));
  json["start"] = {{"max_speed", number_or_null(divergence.start.max_speed)},
                   {"max_sound_speed", number_or_null(divergence.start.max_sound_speed)}};
  json["scene"] = scene;
  return json;
}

}  // namespace neve::app::health
