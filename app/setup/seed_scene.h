#pragma once
/// Bodies of a scene to the arrays that a simulation starts from.

#include <cstddef>
#include <optional>
#include <vector>

#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::setup {

/// The snow that a scene starts from.
struct SeededScene {
  sim::ParticleArrays particles;       ///< of all bodies in the order of the scene
  std::vector<std::size_t> body_end;   ///< for each body the id after its last particle
  std::vector<sim::Vec3d> body_start;  ///< m, for each body its centre of mass
  double spacing = 0.01;               ///< m, between packed particles; the same for any frame
  std::size_t planned = 0;             ///< particles until the scene ends, emitted ones included

  std::size_t body_begin(std::size_t body) const { return body == 0 ? 0 : body_end[body - 1]; }
};
/// @throws sim::ShapeError
SeededScene seed_scene(const scene::Scene& scene);

/// Places of the particles of a body, m, in the axes of its shape and from its centre: the same for
/// a body that was moved or turned. @param body  its index
std::vector<sim::Vec3d> own_places(const scene::Scene& scene, const SeededScene& seeded,
                                   std::size_t body);

/// Centre of mass of the snow of a body, m; nothing where a sink has taken it.
/// @param particles  in the order of their ids
std::optional<sim::Vec3d> snow_centre(const SeededScene& seeded, std::size_t body,
                                      const sim::ParticleArrays& particles);

/// Appends one body. @param index in the scene: the key of its random numbers
void append_body(const scene::Scene& scene, std::size_t index, sim::ParticleArrays& particles);

/// The simulation of a scene. @throws as sim::Simulation
sim::Simulation make_simulation(const scene::Scene& scene, const sim::ParticleArrays& particles,
                                int threads);

/// The index of a material by its name; scenes were checked when they were read.
std::size_t material_index(const scene::Scene& scene, const std::string& name);

}  // namespace neve::app::setup
