#include "app/picture/legends.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/picture/attributes.h"
#include "app/picture/smoke_layer.h"
#include "render/frame/range.h"
#include "render/smoke_legend.h"

namespace neve::app::picture {

namespace {

render::Legend legend(const AttributeName& name, render::ColorMap colormap,
                      const std::optional<scene::Range>& range) {
  const scene::Range ends = range.value_or(scene::Range{});
  return {name.title, name.unit, colormap, static_cast<float>(ends.min),
          static_cast<float>(ends.max)};
}

/// The least and the largest of values; those that are not-a-number are not shown.
struct Extremes {
  float min = std::numeric_limits<float>::infinity(), max = -min;

  void add(float value) {
    if (value < min) min = value;
    if (value > max) max = value;
  }
  void add(const Extremes& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
  }
};

Extremes of_particles(const render::Frame& frame) {
  Extremes extremes;
  for (const float value : frame.points.value) extremes.add(value);
  return extremes;
}

Extremes of_smoke(const render::Frame& frame) {
  Extremes extremes;
  for (std::size_t k = 0; k < frame.smoke.value.size(); ++k)
    if (frame.smoke.density[k] > 0) extremes.add(frame.smoke.value[k]);
  return extremes;
}

Extremes of_heat_maps(const render::Frame& frame) {
  Extremes extremes;
  for (const render::HeatMap& map : frame.heat_maps)
    for (std::size_t k = 0; k < map.value.size(); ++k)
      if (map.cover.empty() || map.cover[k] >= 0.5f) extremes.add(map.value[k]);
  return extremes;
}

/// Returns the extremes of arrows and streamlines; other lines have no values.
Extremes of_vectors(const render::Frame& frame) {
  Extremes extremes;
  for (const render::Arrows& arrows : frame.arrows)
    for (const Vec3f& vector : arrows.vector) extremes.add(length(vector));
  for (const render::Lines& lines : frame.lines)
    for (const float value : lines.value) extremes.add(value);
  return extremes;
}

/// Marks the ends of a legend beyond which values lie, by more than is seen or rounding makes.
void tell_values_beyond(const Extremes& drawn, render::Legend& legend) {
  const float largest = std::max(std::abs(legend.min), std::abs(legend.max));
  const float least = std::max(2e-3f * (legend.max - legend.min),
                               static_cast<float>(render::min_difference) * largest);
  legend.has_lower_values = drawn.min < legend.min - least;
  legend.has_higher_values = drawn.max > legend.max + least;
}

}  // namespace

std::vector<render::Legend> legends_of(const scene::Scene& scene, const scene::View& view,
                                       const render::Frame& drawn) {
  std::vector<render::Legend> legends;
  std::vector<Extremes> extremes;
  const scene::ParticleStyle& particles = view.particles;
  const scene::SmokeStyle& smoke = view.smoke;
  const scene::SliceStyle& slice = view.slice;
  const auto add = [&](const render::Legend& another, const Extremes& values) {
    // Two layers of one quantity in the same colours need one.
    const auto same = std::find(legends.begin(), legends.end(), another);
    const auto index = static_cast<std::size_t>(same - legends.begin());
    if (same == legends.end()) {
      legends.push_back(another);
      extremes.emplace_back();
    }
    extremes[index].add(values);
  };
  if (scene::shows_particles(view) && particles.color_by != scene::ColorBy::snow)
    add(legend(attribute_name(particles.color_by), particles.colormap, particles.range),
        of_particles(drawn));
  // Ends that change with the frame are told apart from those that do not.
  const auto add_of_slice = [&](const AttributeName& name, render::ColorMap colormap,
                                const std::optional<scene::Range>& range, const Extremes& values) {
    render::Legend bar = legend(name, colormap, range);
    if (slice.range_from == scene::RangeFrom::frame) bar.title += ", this frame";
    add(bar, values);
  };
  if (scene::has_layer(view, scene::Layer::smoke)) {
    if (smoke.field != scene::ScalarField::mass)
      add(legend(attribute_name(smoke.field), smoke.colormap, smoke.range), of_smoke(drawn));
    else if (smoke.density_scale > 0)
      add(render::smoke_legend(static_cast<float>(packed_density(scene)),
                               static_cast<float>(smoke.density_scale)),
          {});
  }
  if (scene::has_layer(view, scene::Layer::heatmap))
    add_of_slice(attribute_name(slice.scalar), slice.scalar_colormap, slice.scalar_range,
                 of_heat_maps(drawn));
  // Lines on a heat map are white.
  if (scene::has_layer(view, scene::Layer::arrows) ||
      (scene::has_layer(view, scene::Layer::streamlines) &&
       !scene::has_layer(view, scene::Layer::heatmap)))
    add_of_slice(attribute_name(slice.field), slice.colormap, slice.range, of_vectors(drawn));
  for (std::size_t k = 0; k < legends.size(); ++k) tell_values_beyond(extremes[k], legends[k]);
  return legends;
}

}  // namespace neve::app::picture
