#include "app/picture/legends.h"

#include <algorithm>

#include "app/picture/attributes.h"

namespace neve::app::picture {

namespace {

render::Legend legend(const AttributeName& name, render::ColorMap colormap,
                      const std::optional<scene::Range>& range) {
  const scene::Range ends = range.value_or(scene::Range{});
  return {name.title, name.unit, colormap, static_cast<float>(ends.min),
          static_cast<float>(ends.max)};
}

}  // namespace

std::vector<render::Legend> legends_of(const scene::View& view) {
  std::vector<render::Legend> legends;
  const scene::ParticleStyle& particles = view.particles;
  const scene::SmokeStyle& smoke = view.smoke;
  const scene::SliceStyle& slice = view.slice;
  const auto add = [&](const render::Legend& another) {
    // Two layers of one quantity in the same colours need one.
    if (std::find(legends.begin(), legends.end(), another) == legends.end())
      legends.push_back(another);
  };
  if (scene::shows_particles(view) && particles.color_by != scene::ColorBy::snow)
    add(legend(attribute_name(particles.color_by), particles.colormap, particles.range));
  if (scene::has_layer(view, scene::Layer::smoke) && smoke.field != scene::ScalarField::mass)
    add(legend(attribute_name(smoke.field), smoke.colormap, smoke.range));
  if (scene::has_layer(view, scene::Layer::heatmap))
    add(legend(attribute_name(slice.scalar), slice.scalar_colormap, slice.scalar_range));
  // Lines on a heat map are white.
  if (scene::has_layer(view, scene::Layer::arrows) ||
      (scene::has_layer(view, scene::Layer::streamlines) &&
       !scene::has_layer(view, scene::Layer::heatmap)))
    add(legend(attribute_name(slice.field), slice.colormap, slice.range));
  return legends;
}

}  // namespace neve::app::picture
