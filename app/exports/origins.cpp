#include "app/exports/origins.h"

#include <algorithm>

#include "app/setup/seed_scene.h"

namespace neve::app::exports {

Origins::Origins(const scene::Scene& scene, const std::vector<std::size_t>& body_end)
    : body_end_(body_end) {
  if (scene.emitters.size() != 1) return;
  const sim::seeding::Emitter& emitter = scene.emitters.front();
  start_ = emitter.start;
  if (!(emitter.rate > 0)) return;
  const double h = scene.solver.cell_size;
  const double V0 = h * h * h / emitter.particles_per_cell;
  const sim::Material& material = scene.materials[setup::material_index(scene, emitter.material)];
  period_ = material.density * V0 / emitter.rate;
}

int Origins::body_of(std::uint32_t id) const {
  return static_cast<int>(std::upper_bound(body_end_.begin(), body_end_.end(), id) -
                          body_end_.begin());
}

/// The k-th birth, from 0, is in the middle of the k-th period; see sim/seeding/flow.h.
double Origins::birth_of(std::uint32_t id) const {
  const std::size_t first = body_end_.empty() ? 0 : body_end_.back();
  if (id < first) return 0;
  return period_ > 0 ? start_ + (static_cast<double>(id - first) + 0.5) * period_ : start_;
}

std::vector<std::string> origin_names(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const sim::seeding::Body& body : scene.bodies) names.push_back(body.name);
  for (const sim::seeding::Emitter& emitter : scene.emitters) names.push_back(emitter.name);
  return names;
}

bool knows_emitters(const scene::Scene& scene) {
  return scene.emitters.size() <= 1;
}

}  // namespace neve::app::exports
