#pragma once
/// The analytic solids, about the origin, axis y.

#include <memory>

#include "sim/shapes/solid.h"

namespace neve::sim::shapes {

std::unique_ptr<const Form> make_sphere(double radius);
std::unique_ptr<const Form> make_box(const Vec3d& size);
/// @param length of its axis
std::unique_ptr<const Form> make_capsule(double length, double radius);
std::unique_ptr<const Form> make_cylinder(double radius, double height);
/// With the apex up.
std::unique_ptr<const Form> make_cone(double radius, double height);
std::unique_ptr<const Form> make_torus(double major_radius, double minor_radius);

}  // namespace neve::sim::shapes
