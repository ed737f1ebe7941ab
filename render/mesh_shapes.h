#pragma once
/// Simple shapes as triangle meshes and as lines, for drawing colliders.

#include <array>

#include "render/frame.h"

namespace neve::render {

/// Row-major 3x3.
using Rotation = std::array<float, 9>;
inline constexpr Rotation no_rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/// A smooth sphere, outward normals, within 0.3 % of the radius.
TriangleMesh sphere_mesh(Vec3f center, float radius);

/// A box with flat faces.
/// @param size full edge lengths along the axes of the box
/// @param rotation turns the axes of the box into those of the world
TriangleMesh box_mesh(Vec3f center, Vec3f size, const Rotation& rotation = no_rotation);

/// Circles of latitude and of longitude.
/// @param rotation so that turning can be seen
Lines sphere_lines(Vec3f center, float radius, const Rotation& rotation = no_rotation);

/// The twelve edges.
Lines box_lines(Vec3f center, Vec3f size, const Rotation& rotation = no_rotation);

}  // namespace neve::render
