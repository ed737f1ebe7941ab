#pragma once
/// Volumes of particles as surfaces see them.

#include "app/scene/scene.h"
#include "sim/types/particle_arrays.h"

namespace neve::app::picture {

/// m3: that at rest times J_E J_P, where snow looser than any solid counts as if it were one; not
/// above 0 or not a number in a state that has diverged.
double snow_volume(const scene::Scene& scene, const sim::ParticleArrays& particles, std::size_t p);

}  // namespace neve::app::picture
