#pragma once
/// Fill shapes with particles. Placement is keyed by seed, body and index, never by cell, so moving
/// a body by any amount moves its particles with it.

#include <cstddef>
#include <cstdint>
#include <string>

#include "sim/shapes/placed_points.h"
#include "sim/shapes/shape.h"

namespace neve::sim::seeding {

/// Ids of particles have 32 bits.
inline constexpr double max_particles = 4294967296.0;

enum class Sampling { jittered, poisson, lattice };
enum class Volumes { estimated, given };

struct Body {
  std::string name;      ///< unnamed bodies are called by their number from 1
  std::string material;  ///< name of a material
  shapes::Shape shape;
  Vec3d velocity{0, 0, 0};          ///< m/s
  Vec3d angular_velocity{0, 0, 0};  ///< rad/s about the shape's centre
  double particles_per_cell = 8.0;
  Sampling sampling = Sampling::jittered;
  Volumes volumes = Volumes::estimated;
  double J_P = 1;  ///< det F_P at the start; more than 1: loose, less dense by that factor
};

/// Properties of a body's particles before they are placed.
struct SeedingPlan {
  double volume = 0;               ///< m3, exact for analytic shapes, of the polyhedron for meshes,
                                   ///< the sum of the points' own
  std::size_t particle_count = 0;  ///< estimate from volume, particles per cell and cell size;
                                   ///< the largest size_t where it would overflow
  shapes::Bounds bounds{Vec3d::Zero(), Vec3d::Zero()};
  double max_speed = 0;  ///< m/s, of the points' own velocities
  double V0 = 0;         ///< m3, before deformation, by the points' own columns; 0: they have none
  double mass = 0;       ///< kg, of the points' own masses; 0: density times volume
};
/// Reads the mesh of a mesh shape, allocates nothing for particles.
/// @throws ShapeError as seed_body
SeedingPlan plan_seeding(const Body& body, double cell_size);

/// Expected number of particles, from the volume of a body or its points; less than one for bodies
/// that are too small. Reads the file of a mesh or of points. @throws ShapeError as seed_body
double expected_particles(const Body& body, double cell_size);

/// The particles of one body in metres, in a frame that depends on nothing but the body. All but x
/// are of points only: without masses they have density times volume, without volumes all the same.
/// The body's velocity comes on top of theirs.
struct SeededBody : files::PointCloud {
  Vec3d center{0, 0, 0};  ///< of angular_velocity
  double volume = 0;      ///< m3, of the whole body
};

/// Points keep the places in their file and ignore sampling and particles_per_cell. Other shapes
/// are filled. Jittered: one random point in every sub-cell of edge cell_size /
/// cbrt(particles_per_cell). Poisson: random points no closer than poisson_distance_in_spacings
/// (sampling.h) of that edge. Lattice: a regular grid with the shape's bounds in its middle.
/// Neighbours in the list are near each other in space.
/// @param body_index key of the random numbers, with seed
/// @throws ShapeError when a mesh cannot be read or is open, the shape has no volume, or it would
/// hold
///         more than 2^32 particles
SeededBody seed_body(const Body& body, std::uint64_t body_index, std::uint64_t seed,
                     double cell_size);

}  // namespace neve::sim::seeding
