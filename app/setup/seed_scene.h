#pragma once
/// Bodies of a scene to the arrays that a simulation starts from.

#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::setup {

/// All bodies in the order of the scene; particles of a body follow each other.
/// @param body_end gets for each body the index after its last particle, may be null
/// @throws sim::ShapeError
sim::ParticleArrays seed_scene(const scene::Scene& scene,
                               std::vector<std::size_t>* body_end = nullptr);

/// Appends one body. @param index in the scene: the key of its random numbers
void append_body(const scene::Scene& scene, std::size_t index, sim::ParticleArrays& particles);

/// The simulation of a scene. @throws as sim::Simulation
/// @param colliders  the scene's, or where they have got to
sim::Simulation make_simulation(const scene::Scene& scene, const sim::ParticleArrays& particles,
                                int threads);
sim::Simulation make_simulation(const scene::Scene& scene, const sim::ParticleArrays& particles,
                                int threads, const std::vector<sim::shapes::Collider>& colliders);

/// The index of a material by its name; scenes were checked when they were read.
std::size_t material_index(const scene::Scene& scene, const std::string& name);

}  // namespace neve::app::setup
