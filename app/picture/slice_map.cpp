#include <limits>

#include "app/picture/slice_parts.h"
#include "app/picture/to_float.h"

namespace neve::app::picture {

void add_heat_map(const SliceMoment& slice, render::Frame& frame) {
  const scene::SliceStyle& style = slice.view.slice;
  const SliceShape& shape = slice.shape;
  const Rectangle& r = shape.rectangle();
  const scene::Range range = style.scalar_range.value_or(scene::Range{});
  const std::vector<float>& values = slice.fields.scalars.at(style.scalar);
  render::HeatMap map;
  map.corner = to_float(point_on(slice.plane, r.left, r.bottom));
  map.across = to_float(r.width() * slice.plane.across);
  map.up = to_float(r.height() * slice.plane.up);
  map.columns = shape.columns();
  map.rows = shape.rows();
  map.colormap = style.scalar_colormap;
  map.range_min = static_cast<float>(range.min);
  map.range_max = static_cast<float>(range.max);
  if (style.isolines > 0)
    map.isoline_step = (map.range_max - map.range_min) / static_cast<float>(style.isolines);
  std::vector<float>&cover = map.cover.edit(), &value = map.value.edit();
  const FieldSampler sampler(slice.fields);
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const auto stencil = shape.cover(column, row) > 0
                               ? sampler.at(point_on(slice.plane, shape.u(column), shape.v(row)))
                               : std::nullopt;
      cover.push_back(shape.cover(column, row));
      value.push_back(stencil ? FieldSampler::mean(*stencil, values)
                              : std::numeric_limits<float>::quiet_NaN());
    }
  frame.heat_maps.push_back(std::move(map));
}

}  // namespace neve::app::picture
