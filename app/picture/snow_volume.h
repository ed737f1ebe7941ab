#pragma once
/// Volumes of particles and the solids that they rest on, for the surface of snow.

#include "app/scene/scene.h"
#include "render/frame/frame.h"
#include "sim/types/particle_arrays.h"

namespace neve::app::picture {

/// m3: that at rest times J_E J_P, where snow looser than any solid counts as if it were one; not
/// above 0 or not a number in a state that has diverged.
double snow_volume(const scene::Scene& scene, const sim::ParticleArrays& particles, std::size_t p);

/// Sets to_solid of the points, and of those that are cut away, where one is near a terrain or
/// another solid that the view draws. Thin solids count where the mirror image is inside them.
/// Planes are left out: they are grounds of the frame.
void find_solids_below(const scene::Scene& scene, const scene::View& view, double time,
                       render::Points& points);

}  // namespace neve::app::picture
