#pragma once
/// Mass, centre and inertia of solid shapes of even density.

#include "sim/shapes/collider.h"

namespace neve::sim::rigid {

/// Mass properties in the axes of the form (shapes::form_axes), about the shape's centre.
struct MassProperties {
  double mass = 0;                    ///< kg
  Vec3d centre{0, 0, 0};              ///< m, centre of mass from the shape's centre
  Mat3d inertia = Mat3d::Identity();  ///< kg m2, about the centre of mass
};

/// The properties are exact for the analytic forms, and for meshes: by sums over tetrahedra to each
/// face, also where parts lie in one another. They are measured where parts of a mesh cross, and
/// for all of an open mesh (shapes::SolidMesh::moments).
/// @throws ShapeError when a mesh cannot be read or is open; std::invalid_argument for shapes that
///         have no finite volume or deform
MassProperties mass_properties(const shapes::Shape& shape, double density);

/// Returns those of a collider that has a body: its mass, density or inertia as given.
MassProperties mass_properties(const shapes::Collider& collider);

/// Inertia of a kilogram at a place, about the origin, m2.
inline Mat3d inertia_at(const Vec3d& place) {
  return place.squaredNorm() * Mat3d::Identity() - place * place.transpose();
}

/// Centre of mass of a collider at a time, m, also of one that deforms; the middle of the box
/// around what has none. A plane and a terrain have their point. @throws ShapeError
Vec3d centre_at(const shapes::Collider& collider, double time);

}  // namespace neve::sim::rigid
