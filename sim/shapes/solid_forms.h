#pragma once
/// The analytic solids, about the origin, axis y.

#include <memory>

#include "sim/shapes/solid.h"

namespace neve::sim::shapes {

std::unique_ptr<const Form> make_ball(double radius);
std::unique_ptr<const Form> make_cuboid(const Vec3d& size);
std::unique_ptr<const Form> make_rod(double length,
                                     double radius);  ///< capsule; length of its axis
std::unique_ptr<const Form> make_drum(double radius, double height);              ///< cylinder
std::unique_ptr<const Form> make_peak(double radius, double height);              ///< cone, apex up
std::unique_ptr<const Form> make_ring(double major_radius, double minor_radius);  ///< torus

}  // namespace neve::sim::shapes
