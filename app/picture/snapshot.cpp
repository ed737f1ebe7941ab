#include "app/picture/snapshot.h"

#include <algorithm>

#include "app/picture/attributes.h"
#include "app/setup/auto_ranges.h"

namespace neve::app::picture {

std::string ignored_rule_text(const sim::Warnings& warnings) {
  return "step " + std::to_string(warnings.first_ignored) + " broke the rule " +
         std::string(sim::stop_rules.at(warnings.first_ignored_rule)) + ", which was ignored";
}

bool needs_stress(std::span<const scene::View> views) {
  const auto is_stress = [](scene::ColorBy color_by) {
    return color_by == scene::ColorBy::pressure || color_by == scene::ColorBy::von_mises;
  };
  const FieldNeeds needs = field_needs(views);
  return std::any_of(views.begin(), views.end(),
                     [&](const scene::View& view) { return is_stress(view.particles.color_by); }) ||
         std::any_of(needs.scalars.begin(), needs.scalars.end(), [&](scene::ScalarField field) {
           return is_stress(setup::attribute_of(field));
         });
}

bool needs_dust(std::span<const scene::View> views) {
  return std::any_of(views.begin(), views.end(), [](const scene::View& view) {
    return scene::has_layer(view, scene::Layer::dust);
  });
}

bool has_all(const Snapshot& snapshot, const scene::View& view) {
  const std::span only(&view, 1);
  const FieldNeeds needs = field_needs(only);
  const FieldSamples& fields = snapshot.fields;
  return (!needs.is_needed || fields.lattice) &&
         (!needs_stress(only) || snapshot.kirchhoff.size() >= snapshot.particles.x.size()) &&
         (!needs_dust(only) || snapshot.dust) &&
         std::all_of(needs.scalars.begin(), needs.scalars.end(),
                     [&](scene::ScalarField field) { return fields.scalars.contains(field); }) &&
         std::all_of(needs.vectors.begin(), needs.vectors.end(),
                     [&](scene::VectorField field) { return fields.vectors.contains(field); });
}

Snapshot take_snapshot(const scene::Scene& scene, std::span<const scene::View> views,
                       const sim::Simulation& simulation, int frame) {
  Snapshot snapshot;
  snapshot.frame = frame;
  snapshot.time = simulation.time();
  snapshot.particles = simulation.particles();
  snapshot.warnings = simulation.warnings();
  if (needs_stress(views)) snapshot.kirchhoff = simulation.kirchhoff();
  if (needs_dust(views)) snapshot.dust = simulation.dust();
  snapshot.fields = sample_fields(scene, simulation, snapshot, field_needs(views));
  return snapshot;
}

}  // namespace neve::app::picture
