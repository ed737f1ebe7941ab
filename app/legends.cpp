#include "app/legends.h"

#include <algorithm>

#include "app/attributes.h"

namespace neve::app {

namespace {

render::Legend legend(const AttributeName& name, render::ColorMap colormap,
                      const std::optional<Range>& range) {
  const Range ends = range.value_or(Range{});
  return {name.title, name.unit, colormap, static_cast<float>(ends.min),
          static_cast<float>(ends.max)};
}

bool is_same(const render::Legend& a, const render::Legend& b) {
  return a.title == b.title && a.unit == b.unit && a.colormap == b.colormap && a.min == b.min &&
         a.max == b.max;
}

}  // namespace

std::vector<render::Legend> legends_of(const View& view) {
  std::vector<render::Legend> legends;
  const ParticleStyle& particles = view.particles;
  const SmokeStyle& smoke = view.smoke;
  const SliceStyle& slice = view.slice;
  const auto add = [&](const render::Legend& another) {
    // Two layers of one quantity in the same colours need one.
    if (std::none_of(legends.begin(), legends.end(),
                     [&](const render::Legend& other) { return is_same(other, another); }))
      legends.push_back(another);
  };
  if (has_layer(view, Layer::particles) && particles.color_by != ColorBy::snow)
    add(legend(attribute_name(particles.color_by), particles.colormap, particles.range));
  if (has_layer(view, Layer::smoke) && smoke.field != ScalarField::mass)
    add(legend(attribute_name(smoke.field), smoke.colormap, smoke.range));
  if (has_layer(view, Layer::heatmap))
    add(legend(attribute_name(slice.scalar), slice.scalar_colormap, slice.scalar_range));
  if (has_layer(view, Layer::arrows))
    add(legend(attribute_name(slice.field), slice.colormap, slice.range));
  return legends;
}

}  // namespace neve::app
