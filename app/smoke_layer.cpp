#include "app/smoke_layer.h"

#include <algorithm>

#include "app/snow_pieces.h"

namespace neve::app {

namespace {

/// What counts as packed: the densest snow that there is.
double full_density(const Scene& scene) {
  double density = 0;
  for (const SnowPiece& piece : snow_places(scene))
    density = std::max(density, piece.material->density);
  return density;
}

}  // namespace

void add_smoke(const Scene& scene, const View& view, const NodeFields& fields,
               render::Frame& frame) {
  const SmokeStyle& style = view.smoke;
  render::Smoke& smoke = frame.smoke;
  smoke.nodes = fields.lattice;
  smoke.density = fields.density;
  smoke.full_density = static_cast<float>(full_density(scene));
  smoke.density_scale = static_cast<float>(style.density_scale);
  if (frame.supersampling > 1) smoke.samples_per_ray = frame.supersampling;  // one for each pixel
  if (style.field == ScalarField::mass) return;
  const auto values = fields.scalars.find(style.field);
  if (values != fields.scalars.end()) smoke.value = values->second;
  const Range range = style.range.value_or(Range{});
  smoke.colormap = style.colormap;
  smoke.range_min = static_cast<float>(range.min);
  smoke.range_max = static_cast<float>(range.max);
}

}  // namespace neve::app
