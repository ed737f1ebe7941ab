#pragma once
/// Colour ranges from constants of the scene, so that they mean the same in every frame.

#include "app/scene/scene.h"

namespace neve::app {

/// Round numbers that hold what the attribute usually does in this scene; never what was drawn.
/// @param particle_count of the whole scene
Range automatic_range(const Scene& scene, ColorBy color_by, std::size_t particle_count);

/// m/s: speed of the quickest body when it meets what is below it, or at the end of the scene.
double impact_speed(const Scene& scene);

/// Of a field on nodes.
Range automatic_range(const Scene& scene, ScalarField field);
Range automatic_range(const Scene& scene, VectorField field);  ///< of its magnitude

/// Kinetic energy of all bodies when they meet what is below them, J.
double energy_of_impact(const Scene& scene);

}  // namespace neve::app
