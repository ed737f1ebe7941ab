#include "app/legends.h"

#include "app/attributes.h"

namespace neve::app {

namespace {

render::Legend legend(const AttributeName& name, render::ColorMap colormap,
                      const std::optional<Range>& range) {
  const Range ends = range.value_or(Range{});
  return {name.title, name.unit, colormap, static_cast<float>(ends.min),
          static_cast<float>(ends.max)};
}

}  // namespace

std::vector<render::Legend> legends_of(const View& view) {
  std::vector<render::Legend> legends;
  const ParticleStyle& particles = view.particles;
  const SmokeStyle& smoke = view.smoke;
  const SliceStyle& slice = view.slice;
  if (has_layer(view, Layer::particles) && particles.color_by != ColorBy::snow)
    legends.push_back(
        legend(attribute_name(particles.color_by), particles.colormap, particles.range));
  if (has_layer(view, Layer::smoke) && smoke.field != ScalarField::mass)
    legends.push_back(legend(attribute_name(smoke.field), smoke.colormap, smoke.range));
  if (has_layer(view, Layer::heatmap))
    legends.push_back(
        legend(attribute_name(slice.scalar), slice.scalar_colormap, slice.scalar_range));
  if (has_layer(view, Layer::arrows))
    legends.push_back(legend(attribute_name(slice.field), slice.colormap, slice.range));
  return legends;
}

}  // namespace neve::app
