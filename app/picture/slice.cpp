#include "app/picture/slice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "app/picture/attributes.h"
#include "app/picture/field_sampler.h"
#include "app/picture/to_float.h"
#include "app/scene/toml/value.h"

namespace neve::app::picture {

namespace {

using sim::Vec3d;

/// Closer than this arrows are a carpet: pixels of a picture 720 high.
constexpr double min_arrow_distance = 24;
/// The longest arrow over the distance of its neighbours.
constexpr double arrow_reach = 1.6;
/// Arrows below this share of the longest are dots that say nothing.
constexpr float least_shown = 0.02f;
/// Samples of the heat map from node to node: smooth isolines, and no more than the field has.
constexpr double samples_per_node = 3;
constexpr int max_samples = 768;

/// The world axis along the normal, or -1.
int axis_along(const Vec3d& normal) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(normal[axis]) > 1 - 1e-9) return axis;
  return -1;
}

/// A plane along two axes goes through nodes, so that its arrows are those of the nodes.
SlicePlane snapped_to_nodes(SlicePlane plane, double h) {
  const int axis = axis_along(plane.normal);
  if (axis >= 0) plane.point[axis] = h * std::round(plane.point[axis] / h);
  return plane;
}

struct Rectangle {
  double left = std::numeric_limits<double>::infinity(), right = -left, bottom = left, top = -left;
  bool is_empty() const { return !(left <= right); }
};

Vec3d position_of(const render::NodeLattice& lattice, std::size_t value_index) {
  const Vec3i block = lattice.block[value_index / 64];
  const int n = static_cast<int>(value_index % 64);
  return static_cast<double>(lattice.spacing) *
         Vec3d(4 * block.x + n / 16, 4 * block.y + n / 4 % 4, 4 * block.z + n % 4);
}

/// Around the nodes with mass next to the plane, in its own coordinates.
Rectangle rectangle_of(const FieldSamples& fields, const SlicePlane& plane) {
  const double h = static_cast<double>(fields.lattice->spacing);
  Rectangle r;
  for (std::size_t n = 0; n < fields.density.size(); ++n) {
    if (!(fields.density[n] > 0)) continue;
    const Vec3d x = position_of(*fields.lattice, n);
    if (std::abs((x - plane.point).dot(plane.normal)) >= h) continue;
    const double u = x.dot(plane.across), v = x.dot(plane.up);
    r.left = std::min(r.left, u - h);
    r.right = std::max(r.right, u + h);
    r.bottom = std::min(r.bottom, v - h);
    r.top = std::max(r.top, v + h);
  }
  return r;
}

/// The point of the plane with the coordinates u and v.
Vec3d point_on(const SlicePlane& plane, double u, double v) {
  return u * plane.across + v * plane.up + plane.point.dot(plane.normal) * plane.normal;
}

int nodes_between_arrows(const scene::SliceStyle& slice, double h, double pixels_per_metre) {
  if (slice.every > 0) return slice.every;
  const double pixels = std::max(h * pixels_per_metre, 1e-3);
  return static_cast<int>(std::clamp(std::ceil(min_arrow_distance / pixels), 1.0, 1000.0));
}

void add_arrows(const scene::SliceStyle& slice, const FieldSamples& fields, const SlicePlane& plane,
                const Rectangle& r, int every, render::Frame& frame) {
  const double step = every * static_cast<double>(fields.lattice->spacing);
  const scene::Range range = slice.range.value_or(scene::Range{});
  const auto largest = static_cast<float>(range.max);
  const std::vector<Vec3f>& values = fields.vectors.at(slice.field);
  render::Arrows arrows;
  arrows.colormap = slice.colormap;
  arrows.range_min = static_cast<float>(range.min);
  arrows.range_max = largest;
  arrows.max_length = static_cast<float>(slice.arrow_scale * arrow_reach * step);
  arrows.length_per_value = largest > 0 ? arrows.max_length / largest : 0;
  const FieldSampler sampler(fields);
  for (double j = std::ceil(r.bottom / step); j * step <= r.top; ++j)
    for (double i = std::ceil(r.left / step); i * step <= r.right; ++i) {
      const Vec3d x = point_on(plane, i * step, j * step);
      const auto stencil = sampler.at(x);
      if (!stencil || stencil->cover < 0.5f) continue;
      const Vec3f value = FieldSampler::mean(*stencil, values);
      if (!(length(value) > least_shown * largest)) continue;
      arrows.position.push_back(to_float(x));
      arrows.vector.push_back(value);
    }
  frame.arrows.push_back(std::move(arrows));
}

void add_heat_map(const scene::SliceStyle& slice, const FieldSamples& fields,
                  const SlicePlane& plane, const Rectangle& r, render::Frame& frame) {
  const double h = static_cast<double>(fields.lattice->spacing);
  const auto samples = [&](double extent) {
    return std::clamp(static_cast<int>(std::ceil(samples_per_node * extent / h)), 1, max_samples);
  };
  const scene::Range range = slice.scalar_range.value_or(scene::Range{});
  const std::vector<float>& values = fields.scalars.at(slice.scalar);
  render::HeatMap map;
  const double width = r.right - r.left, height = r.top - r.bottom;
  map.corner = to_float(point_on(plane, r.left, r.bottom));
  map.across = to_float(width * plane.across);
  map.up = to_float(height * plane.up);
  map.columns = samples(width);
  map.rows = samples(height);
  map.colormap = slice.scalar_colormap;
  map.range_min = static_cast<float>(range.min);
  map.range_max = static_cast<float>(range.max);
  if (slice.isolines > 0)
    map.isoline_step = (map.range_max - map.range_min) / static_cast<float>(slice.isolines);
  const FieldSampler sampler(fields);
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const auto stencil = sampler.at(point_on(plane, r.left + (column + 0.5) / map.columns * width,
                                               r.bottom + (row + 0.5) / map.rows * height));
      map.value.push_back(stencil && stencil->cover > 0.5f
                              ? FieldSampler::mean(*stencil, values)
                              : std::numeric_limits<float>::quiet_NaN());
    }
  frame.heat_maps.push_back(std::move(map));
}

/// So many digits after the point, and no minus before a zero.
std::string short_number(double x, double parts = 1000) {
  const double rounded = std::round(x * parts) / parts;
  return scene::toml::number_text(rounded == 0 ? 0 : rounded);
}

std::string describe_place(const SlicePlane& plane) {
  const int axis = axis_along(plane.normal);
  if (axis >= 0)
    return std::string(1, "xyz"[axis]) + " = " + short_number(plane.point[axis]) + " m";
  const auto triple = [](const Vec3d& v) {
    return "(" + short_number(v.x(), 100) + ", " + short_number(v.y(), 100) + ", " +
           short_number(v.z(), 100) + ")";
  };
  return "plane through " + triple(plane.point) + " m, normal " + triple(plane.normal);
}

void add_frame(const SlicePlane& plane, const Rectangle& r, render::Frame& frame) {
  const Vec3f corner[4] = {
      to_float(point_on(plane, r.left, r.bottom)), to_float(point_on(plane, r.right, r.bottom)),
      to_float(point_on(plane, r.right, r.top)), to_float(point_on(plane, r.left, r.top))};
  render::Lines lines;
  lines.opacity = 0.7f;
  for (int k = 0; k < 4; ++k) {
    lines.ends.push_back(corner[k]);
    lines.ends.push_back(corner[(k + 1) % 4]);
  }
  frame.lines.push_back(std::move(lines));
}

}  // namespace

SlicePlane slice_plane(const scene::SliceStyle& slice, double time,
                       const std::optional<Vec3d>& followed) {
  SlicePlane plane;
  plane.normal = slice.normal.normalized();
  plane.point =
      followed.value_or(Vec3d::Zero()) + slice.point.value_or(Vec3d::Zero()) + time * slice.motion;
  // Up in the plane is up in the world, where the plane is not level.
  const bool is_level = std::abs(plane.normal.y()) > 1 - 1e-9;
  const Vec3d up = is_level ? Vec3d(0, 0, -1) : Vec3d(0, 1, 0);
  plane.across = up.cross(plane.normal).normalized();
  plane.up = plane.normal.cross(plane.across);
  return plane;
}

void add_slice(const scene::View& view, const FieldSamples& fields, const SlicePlane& wanted,
               double pixels_per_metre, render::Frame& frame) {
  const bool has_arrows = scene::has_layer(view, scene::Layer::arrows);
  const bool has_map = scene::has_layer(view, scene::Layer::heatmap);
  if (!has_arrows && !has_map) return;
  const scene::SliceStyle& slice = view.slice;
  if (!fields.lattice) return;
  const double h = static_cast<double>(fields.lattice->spacing);
  const SlicePlane plane = snapped_to_nodes(wanted, h);
  const Rectangle r = rectangle_of(fields, plane);
  std::string words = describe_place(plane);
  if (r.is_empty()) {
    frame.footnote = words + ": no snow here";
    return;
  }
  if (has_map) add_heat_map(slice, fields, plane, r, frame);
  if (has_arrows) {
    const int every = nodes_between_arrows(slice, h, pixels_per_metre);
    add_arrows(slice, fields, plane, r, every, frame);
    if (every > 1) words += ", one arrow per " + std::to_string(every) + " nodes";
    const scene::Range range = slice.range.value_or(scene::Range{});
    words += ", longest arrow " + scene::toml::number_text(range.max) + " " +
             attribute_name(slice.field).unit;
  }
  add_frame(plane, r, frame);
  frame.footnote = words;
}

}  // namespace neve::app::picture
