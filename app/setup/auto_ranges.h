#pragma once
/// Colour ranges from constants of the scene, so that they mean the same in every frame.

#include <cstddef>
#include <string>

#include "app/scene/scene.h"

namespace neve::app::setup {

/// Round numbers around the usual values of the attribute in this scene, not those of a frame.
/// @param particle_count of the whole scene
scene::Range automatic_range(const scene::Scene& scene, scene::ColorBy color_by,
                             std::size_t particle_count);

/// m/s, the largest of points that have velocities in their file.
double own_speed(const sim::shapes::Shape& shape);

/// m/s: speed of the quickest body when it meets the surface below it, or at the end of the scene.
double impact_speed(const scene::Scene& scene);

/// An impact that is hard for its snow: fast for the speed of sound there.
struct Impact {
  std::string address;        ///< "body.ball"; "" without snow
  double speed = 0;           ///< m/s
  double share_of_sound = 1;  ///< of the sound in the stiffest snow of the scene at its start
};
/// The hardest of all bodies and emitters.
Impact hardest_impact(const scene::Scene& scene);

/// s, of the longest step that the limits allow snow at rest.
double step_at_rest(const scene::Scene& scene);

/// m/s2, while the scene lasts.
double largest_gravity(const scene::Scene& scene);

/// m/s, of the fastest point of a collider. One that moves by itself falls until something is
/// below; snow that hits it makes it at most about as fast as itself.
/// @param name  of a collider of the scene
double collider_speed(const scene::Scene& scene, const std::string& name);

/// m/s, that snow may have: its own at impact, or that of a body that hits it.
double largest_speed(const scene::Scene& scene);

/// Automatic range of a field on nodes.
scene::Range automatic_range(const scene::Scene& scene, scene::ScalarField field);
scene::Range automatic_range(const scene::Scene& scene,
                             scene::VectorField field);  ///< of its magnitude

/// Kinetic energy of all bodies when they meet the surface below them, J.
double energy_of_impact(const scene::Scene& scene);

/// Force on the surface below that stops all bodies within a frame and carries them, N.
double force_of_impact(const scene::Scene& scene);

/// Particle attribute that makes a field of nodes.
scene::ColorBy attribute_of(scene::ScalarField field);

/// Fills in the ranges of plots that are absent, from constants of the scene, as round numbers.
void resolve_plot_ranges(const scene::Scene& scene, scene::PlotRanges& ranges);

}  // namespace neve::app::setup
