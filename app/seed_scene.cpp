#include "app/seed_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

namespace neve::app {

std::size_t material_index(const Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                  [&](const sim::Material& m) { return m.name == name; });
  if (found == scene.materials.end()) throw std::logic_error("no material is called " + name);
  return static_cast<std::size_t>(found - scene.materials.begin());
}

void append_body(const Scene& scene, std::size_t index, sim::ParticleArrays& particles) {
  const sim::Body& body = scene.bodies[index];
  const sim::SeededBody seeded = sim::seed_body(body, index, scene.seed, scene.solver.cell_size);
  const std::size_t material = material_index(scene, body.material);
  const double volume = seeded.volume / static_cast<double>(seeded.x.size());
  const double V0 = body.volumes == sim::Volumes::given ? volume : 0.0;
  for (const sim::Vec3d& x_p : seeded.x) {
    particles.x.push_back(x_p);
    particles.v.push_back(body.velocity + body.angular_velocity.cross(x_p - seeded.center));
    particles.m.push_back(scene.materials[material].density * volume);
    particles.V0.push_back(V0);
    particles.material.push_back(static_cast<int>(material));
  }
}

sim::ParticleArrays seed_scene(const Scene& scene, std::vector<std::size_t>* body_end) {
  sim::ParticleArrays particles;
  for (std::size_t index = 0; index < scene.bodies.size(); ++index) {
    append_body(scene, index, particles);
    if (body_end) body_end->push_back(particles.x.size());
  }
  return particles;
}

}  // namespace neve::app
