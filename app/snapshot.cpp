#include "app/snapshot.h"

#include <algorithm>

#include "app/attributes.h"

namespace neve::app {

bool needs_stress(const Scene& scene) {
  const auto is_stress = [](ColorBy color_by) {
    return color_by == ColorBy::pressure || color_by == ColorBy::von_mises;
  };
  const FieldNeeds needs = field_needs(scene);
  return std::any_of(scene.views.begin(), scene.views.end(),
                     [&](const View& view) { return is_stress(view.particles.color_by); }) ||
         std::any_of(needs.scalars.begin(), needs.scalars.end(),
                     [&](ScalarField field) { return is_stress(attribute_of(field)); });
}

Snapshot take_snapshot(const Scene& scene, const sim::Simulation& simulation, int frame) {
  Snapshot snapshot;
  snapshot.frame = frame;
  snapshot.time = simulation.time();
  snapshot.particles = simulation.particles();
  if (needs_stress(scene)) snapshot.kirchhoff = simulation.kirchhoff();
  snapshot.fields = sample_fields(scene, simulation, snapshot, field_needs(scene));
  return snapshot;
}

}  // namespace neve::app
