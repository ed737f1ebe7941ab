#include "app/picture/smoke_layer.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "app/setup/snow_pieces.h"
#include "sim/dust_grid.h"

namespace neve::app::picture {

namespace {

/// m2/kg, what dust takes out of a beam: of ice, drops of 0.15 mm have 3 / (2 rho r) = 11.
constexpr double dust_cross_section = 11;

}  // namespace

double packed_density(const scene::Scene& scene) {
  double density = 0;
  for (const setup::SnowPiece& piece : setup::snow_places(scene))
    density = std::max(density, piece.material->density);
  return density;
}

void add_smoke(const scene::Scene& scene, const scene::View& view, const FieldSamples& fields,
               render::Frame& frame) {
  const scene::SmokeStyle& style = view.smoke;
  render::Smoke& smoke = frame.smoke;
  smoke.nodes = fields.lattice;
  smoke.density = fields.density;
  smoke.full_density = static_cast<float>(packed_density(scene));
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

void add_dust(const scene::View& view, const sim::DustArrays& dust, render::Frame& frame) {
  const sim::RasterizedNodes nodes = sim::dust_nodes(dust);
  if (nodes.block.empty()) return;
  render::Smoke& smoke = frame.smoke;
  smoke.nodes = lattice_of(nodes);
  const double cell = nodes.spacing * nodes.spacing * nodes.spacing;
  std::vector<float> density;
  density.reserve(nodes.mass.size());
  for (const double mass : nodes.mass) density.push_back(static_cast<float>(mass / cell));
  smoke.density = std::move(density);
  // At this density of dust, three nodes pass 40 % of the light, as three of packed snow do.
  smoke.full_density = static_cast<float>(0.3054 / (dust_cross_section * nodes.spacing));
  smoke.density_scale = static_cast<float>(view.smoke.density_scale);
  if (frame.supersampling > 1) smoke.samples_per_ray = frame.supersampling;
}

}  // namespace neve::app::picture
