#pragma once
/// Materials for cards.

#include <cmath>

#include "app/card/experiment.h"
#include "app/scene/presets.h"
#include "sim/laws/list.h"
#include "tests/support/sand.h"

namespace neve::test {

inline app::card::Subject subject_of(const sim::Material& material) {
  app::card::Subject subject;
  subject.title = material.name;
  subject.material = material;
  return subject;
}

inline sim::Material preset_snow(app::scene::Preset preset,
                                 sim::Model model = sim::laws::model::snow) {
  sim::Material material = app::scene::snow_of(preset);
  material.model = model;
  return material;
}

/// Tangent of the slope on which such sand slides: on a plane it flows at constant volume, where
/// q = M p and the shear is q / sqrt(3).
inline double critical_slope(double friction_angle) {
  const double s = std::sin(friction_angle * 3.14159265358979323846 / 180);
  return 6 * s / (3 - s) / std::sqrt(3.0);
}

}  // namespace neve::test
