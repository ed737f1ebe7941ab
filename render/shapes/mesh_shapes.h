#pragma once
/// Simple shapes as triangle meshes and as lines, for drawing colliders.

#include <array>

#include "render/frame/frame.h"

namespace neve::render::shapes {

/// Row-major 3x3.
using Rotation = std::array<float, 9>;
inline constexpr Rotation no_rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/// A smooth sphere, outward normals, within 0.3 % of the radius.
TriangleMesh sphere_mesh(Vec3f center, float radius);

/// A line in the half plane beside an axis, to be turned around it.
struct Profile {
  struct Point {
    float out, along;  ///< m, from the axis and along it
    float normal_out, normal_along;
  };
  std::vector<Point> points;  ///< from the lower end of the axis to the upper; edges are two points
};

/// Profiles about the origin, axis y: a cylinder with round ends, a cylinder, a cone with the apex
/// up, a ring.
/// @param half half the length of the axis (of a capsule without its ends), m
Profile capsule_profile(float half, float radius);
Profile cylinder_profile(float half, float radius);
Profile cone_profile(float half, float radius);
Profile torus_profile(float ring, float radius);

/// The surface that a profile sweeps.
/// @param rotation turns y into the axis
TriangleMesh round_mesh(const Profile& profile, Vec3f center, const Rotation& rotation);

/// Circles around the axis and profiles along it; or, for a ghost, only the sharp edges.
Lines round_lines(const Profile& profile, Vec3f center, const Rotation& rotation,
                  bool only_edges = false);

/// A mesh with vertices of its own at edges sharper than 40 degrees, so that these stay sharp and
/// the rest is smooth.
TriangleMesh creased_mesh(const std::vector<Vec3f>& position,
                          const std::vector<std::uint32_t>& index);

/// Returns the edges of a mesh: all of a few hundred triangles, the sharp ones of more.
Lines mesh_lines(const std::vector<Vec3f>& position, const std::vector<std::uint32_t>& index);

TriangleMesh moved_mesh(TriangleMesh mesh, Vec3f center, const Rotation& rotation);
Lines moved_lines(Lines lines, Vec3f center, const Rotation& rotation);

/// A box with flat faces.
/// @param size full edge lengths along the axes of the box
/// @param rotation turns the axes of the box into those of the world
TriangleMesh box_mesh(Vec3f center, Vec3f size, const Rotation& rotation = no_rotation);

/// Circles of latitude and of longitude.
/// @param rotation so that turning can be seen
Lines sphere_lines(Vec3f center, float radius, const Rotation& rotation = no_rotation);

/// The twelve edges.
Lines box_lines(Vec3f center, Vec3f size, const Rotation& rotation = no_rotation);

}  // namespace neve::render::shapes
