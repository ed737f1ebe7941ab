#pragma once
/// Friction inside of a material, as laws of soil measure it.

#include <cmath>

#include "sim/laws/law.h"

namespace neve::sim::laws {

inline constexpr double degree = 3.14159265358979323846 / 180;

/// M of a friction angle in degrees: 6 sin phi / (3 - sin phi), the slope q/p of the critical
/// state.
inline double critical_slope(double friction_angle) {
  const double sine = std::sin(friction_angle * degree);
  return 6 * sine / (3 - sine);
}
/// The inverse, degrees.
inline double friction_angle(double critical_slope) {
  return std::asin(3 * critical_slope / (6 + critical_slope)) / degree;
}

namespace parameter {
inline constexpr Parameter friction_angle{
    .key = "friction_angle",
    .member = &Material::friction_angle,
    .unit = Unit::degrees,
    .bounds = {.min = 0, .max = 90, .is_min_open = true, .is_max_open = true},
    .help = "Angle of friction of snow or grains that flow at constant volume."};
}

}  // namespace neve::sim::laws
