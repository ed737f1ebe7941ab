#pragma once
/// Fill shapes with particles. Placement is keyed by seed, body and index, never by cell, so moving
/// a body by any amount moves its particles with it.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/shape.h"

namespace neve::sim {

enum class Sampling { jittered, poisson, lattice };
enum class Volumes { estimated, given };

struct Body {
  std::string name;      ///< unnamed bodies are called by their number from 1
  std::string material;  ///< name of a material
  Shape shape;
  Vec3d velocity{0, 0, 0};          ///< m/s
  Vec3d angular_velocity{0, 0, 0};  ///< rad/s about the shape's centre
  double particles_per_cell = 8.0;
  Sampling sampling = Sampling::jittered;
  Volumes volumes = Volumes::estimated;
};

/// Axis-aligned bounds in metres.
struct Bounds {
  Vec3d min, max;
};

/// Thrown when a shape cannot be filled; what() says which file and why.
struct ShapeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What is known of a body's particles before any is placed.
struct SeedingPlan {
  double volume = 0;               ///< m3, exact for analytic shapes, of the polyhedron for meshes
  std::size_t particle_count = 0;  ///< estimate from volume, particles per cell and cell size
  Bounds bounds{Vec3d::Zero(), Vec3d::Zero()};
};
SeedingPlan plan_seeding(const Body& body, double cell_size);

/// The particles of one body in metres, in a frame that depends on nothing but the body.
struct SeededBody {
  std::vector<Vec3d> x;
  Vec3d center;       ///< what angular_velocity turns about
  double volume = 0;  ///< m3, of the whole body
};

/// @param body_index key of the random numbers, with seed
/// @throws ShapeError when a mesh cannot be read, is open, or no particle fits into the shape
SeededBody seed_body(const Body& body, std::uint64_t body_index, std::uint64_t seed,
                     double cell_size);

/// Volume in m3, bounds, and whether x is inside; for solid shapes only (not planes).
double volume(const Shape& shape);
Bounds bounds(const Shape& shape);
Vec3d center(const Shape& shape);

}  // namespace neve::sim
