#pragma once
/// Sources of the snow of a scene: bodies at the start, emitters during the run.

#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace neve::app::setup {

struct SnowPiece {
  std::string address;  ///< "body.ball"
  const sim::shapes::Shape* shape;
  const sim::Material* material;
  sim::Vec3d velocity, angular_velocity;
  double J_P = 1;        ///< at the start
  double volume = 0;     ///< m3; of an emitter all that it emits
  double particles = 0;  ///< roughly
  double mass = 0;       ///< kg, of all
};

/// Bodies, then emitters; until the scene ends. Points into the scene.
/// @throws sim::ShapeError for files that cannot be read
std::vector<SnowPiece> snow_pieces(const scene::Scene& scene);

/// The same without the values that need a file to be read: volume, particles and mass stay 0.
std::vector<SnowPiece> snow_places(const scene::Scene& scene);

/// m/s, of sound in the snow of a piece as it is packed at the start.
double sound_speed(const SnowPiece& piece);

/// m/s, of the point that the spin of a piece moves fastest, about the middle of its box.
double speed_of_spin(const SnowPiece& piece);

/// The longest edge of the boxes around bodies and emitters, m.
double largest_extent(const scene::Scene& scene);
/// True of snow whose size suggests that its lengths are no metres; on terrain they are.
bool is_too_large(const scene::Scene& scene);

/// Particles of all emitters until a time, s.
double planned_emission(const scene::Scene& scene, double time);

/// Emitters and sinks, for the simulation.
sim::seeding::Flow flow_of(const scene::Scene& scene);

}  // namespace neve::app::setup
