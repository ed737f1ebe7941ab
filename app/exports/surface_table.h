#pragma once
/// A surface of the snow for one file: its vertices with the attributes of the particles around.

#include <span>

#include "app/exports/columns.h"
#include "render/surface/surface.h"

namespace neve::app::exports {

/// Particles as a surface sees them.
struct SnowGrains {
  std::vector<Vec3f> position;
  std::vector<float> volume;

  render::surface::Grains view() const { return {position, volume}; }
};

/// Each fills its mass over the density of its material times J, but at most twice its volume at
/// rest: looser snow thins out and becomes spray instead of growing into a ball of its own. (V0 is
/// larger at the rim of a body, where the solver's grid sees less snow.)
/// @param rows  indices of the particles
SnowGrains grains_of(const scene::Scene& scene, const sim::ParticleArrays& particles,
                     std::span<const std::size_t> rows);

/// Mean distance of the particles at rest, m; of the coarsest bodies and emitters.
double particle_spacing(const scene::Scene& scene);

/// Cell and kernel in metres, and the memory that a run may have.
render::surface::Settings surface_settings(const scene::Scene& scene, const scene::Export& e);

/// @param particles  a row per particle of `rows`
/// @return the vertices, then the spray; whole numbers are those of the nearest particle
/// @throws LimitError
Table surface_table(const scene::Scene& scene, const scene::Export& e, const State& state,
                    std::span<const std::size_t> rows, const Table& particles);

}  // namespace neve::app::exports
