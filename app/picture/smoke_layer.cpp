#include "app/picture/smoke_layer.h"

#include <algorithm>

#include "app/setup/snow_pieces.h"

namespace neve::app::picture {

namespace {

/// Density of packed snow: that of the densest material in use.
double full_density(const scene::Scene& scene) {
  double density = 0;
  for (const setup::SnowPiece& piece : setup::snow_places(scene))
    density = std::max(density, piece.material->density);
  return density;
}

}  // namespace

void add_smoke(const scene::Scene& scene, const scene::View& view, const FieldSamples& fields,
               render::Frame& frame) {
  const scene::SmokeStyle& style = view.smoke;
  render::Smoke& smoke = frame.smoke;
  smoke.nodes = fields.lattice;
  smoke.density = fields.density;
  smoke.full_density = static_cast<float>(full_density(scene));
  smoke.density_scale = static_cast<float>(style.density_scale);
  if (frame.supersampling > 1) smoke.samples_per_ray = frame.supersampling;  // one for each pixel
  if (style.field == scene::ScalarField::mass) return;
  const auto values = fields.scalars.find(style.field);
  if (values != fields.scalars.end()) smoke.value = values->second;
  const scene::Range range = style.range.value_or(scene::Range{});
  smoke.colormap = style.colormap;
  smoke.range_min = static_cast<float>(range.min);
  smoke.range_max = static_cast<float>(range.max);
}

}  // namespace neve::app::picture
