#include "app/exports/origins.h"

#include <algorithm>

#include "app/setup/seed_scene.h"

namespace neve::app::exports {

Origins::Origins(const scene::Scene& scene, const std::vector<std::size_t>& body_end)
    : names_(scene::snow_sources(scene)), body_end_(body_end) {
  if (scene.emitters.size() != 1) return;
  const sim::seeding::Emitter& emitter = scene.emitters.front();
  start_ = emitter.start;
  if (!(emitter.rate > 0)) return;
  const sim::Material& material = scene.materials[setup::material_index(scene, emitter.material)];
  period_ = sim::seeding::birth_period(emitter, material, scene.solver.cell_size);
}

int Origins::body_of(std::uint32_t id) const {
  return static_cast<int>(std::upper_bound(body_end_.begin(), body_end_.end(), id) -
                          body_end_.begin());
}

std::vector<std::size_t> Origins::rows_of(const std::vector<std::string>& bodies,
                                          const sim::ParticleArrays& particles) const {
  std::vector<bool> is_wanted;
  for (const std::string& name : names_)
    is_wanted.push_back(std::find(bodies.begin(), bodies.end(), name) != bodies.end());
  std::vector<std::size_t> rows;
  rows.reserve(particles.x.size());
  for (std::size_t p = 0; p < particles.x.size(); ++p)
    if (bodies.empty() || is_wanted[static_cast<std::size_t>(body_of(particles.id_of(p)))])
      rows.push_back(p);
  return rows;
}

double Origins::birth_of(std::uint32_t id) const {
  const std::size_t first = first_born();
  if (id < first) return 0;
  return period_ > 0 ? start_ + (static_cast<double>(id - first) + 0.5) * period_ : start_;
}

}  // namespace neve::app::exports
