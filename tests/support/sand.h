#pragma once
/// Dry sand.

#include "sim/laws/list.h"
#include "sim/types/material.h"

namespace neve::test {

/// Poisson ratio 0.3: pressed with its sides held, it stays below its cone.
/// @param friction_angle  degrees
inline sim::Material dry_sand(double friction_angle) {
  sim::Material material;
  material.model = sim::laws::model::sand;
  material.density = 1500;
  material.youngs_modulus = 1e6;
  material.poisson_ratio = 0.3;
  material.friction_angle = friction_angle;
  return material;
}

}  // namespace neve::test
