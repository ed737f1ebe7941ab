#include "app/picture/legends.h"

#include <algorithm>

#include "app/picture/attributes.h"
#include "app/picture/smoke_layer.h"
#include "render/smoke_legend.h"

namespace neve::app::picture {

namespace {

render::Legend legend(const AttributeName& name, render::ColorMap colormap,
                      const std::optional<scene::Range>& range) {
  const scene::Range ends = range.value_or(scene::Range{});
  return {name.title, name.unit, colormap, static_cast<float>(ends.min),
          static_cast<float>(ends.max)};
}

}  // namespace

std::vector<render::Legend> legends_of(const scene::Scene& scene, const scene::View& view) {
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
  // Ends that change with the frame are told apart from those that do not.
  const auto add_of_slice = [&](const AttributeName& name, render::ColorMap colormap,
                                const std::optional<scene::Range>& range) {
    render::Legend bar = legend(name, colormap, range);
    if (slice.range_from == scene::RangeFrom::frame) bar.title += ", this frame";
    add(bar);
  };
  if (scene::has_layer(view, scene::Layer::smoke)) {
    if (smoke.field != scene::ScalarField::mass)
      add(legend(attribute_name(smoke.field), smoke.colormap, smoke.range));
    else if (smoke.density_scale > 0)
      add(render::smoke_legend(static_cast<float>(packed_density(scene)),
                               static_cast<float>(smoke.density_scale)));
  }
  if (scene::has_layer(view, scene::Layer::heatmap))
    add_of_slice(attribute_name(slice.scalar), slice.scalar_colormap, slice.scalar_range);
  // Lines on a heat map are white.
  if (scene::has_layer(view, scene::Layer::arrows) ||
      (scene::has_layer(view, scene::Layer::streamlines) &&
       !scene::has_layer(view, scene::Layer::heatmap)))
    add_of_slice(attribute_name(slice.field), slice.colormap, slice.range);
  return legends;
}

}  // namespace neve::app::picture
