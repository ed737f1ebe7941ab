#include "app/picture/slice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "app/picture/attributes.h"
#include "app/picture/slice_parts.h"
#include "app/picture/to_float.h"
#include "app/scene/toml/value.h"
#include "app/support/text.h"

namespace neve::app::picture {

namespace {

using sim::Vec3d;

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

/// Digits after the point that tell places apart which are so many metres from each other.
int digits_of(double apart, int least) {
  constexpr double rounding = 1e-9;
  return std::max(least, static_cast<int>(std::ceil(-std::log10(apart) - rounding)));
}

/// Writes a number with at most so many digits after the point, and no minus before a zero.
std::string short_number(double x, int digits) {
  std::string text = fixed_text(x, digits);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

/// Ends of the scene are round; those of a frame are rounded for its words.
std::string longest_text(const scene::View& view, double value) {
  return view.slice.range_from == scene::RangeFrom::frame ? rough_text(value)
                                                          : scene::toml::number_text(value);
}

/// @param h  m, side of a cell
std::string describe_place(const SlicePlane& plane, double h) {
  const int axis = axis_along(plane.normal);
  if (axis >= 0)
    return std::string(1, "xyz"[axis]) + " = " +
           short_number(plane.point[axis], digits_of(0.1 * h, 3)) + " m";
  const auto triple = [](const Vec3d& v, int digits) {
    return "(" + short_number(v.x(), digits) + ", " + short_number(v.y(), digits) + ", " +
           short_number(v.z(), digits) + ")";
  };
  return "plane through " + triple(plane.point, digits_of(h, 2)) + " m, normal " +
         triple(plane.normal, 2);
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

SlicePlane slice_plane(const scene::SliceStyle& slice, double time, const Vec3d& followed) {
  SlicePlane plane;
  plane.normal = slice.normal.normalized();
  plane.point = followed + slice.point.value_or(Vec3d::Zero()) + time * slice.motion;
  // Up in the plane is up in the world, where the plane is not level.
  const bool is_level = std::abs(plane.normal.y()) > 1 - 1e-9;
  const Vec3d up = is_level ? Vec3d(0, 0, -1) : Vec3d(0, 1, 0);
  plane.across = up.cross(plane.normal).normalized();
  plane.up = plane.normal.cross(plane.across);
  return plane;
}

void add_slice(const scene::Scene& scene, const scene::View& view, const Snapshot& snapshot,
               const SlicePlane& wanted, const SliceSight& sight, render::Frame& frame) {
  if (!scene::shows_slice(view) || !snapshot.fields.lattice) return;
  const SlicePlane plane = snapped_to_nodes(wanted, scene.solver.cell_size);
  const SliceShape shape(scene, snapshot.particles, sight.spacing, plane);
  frame.footnote = describe_place(plane, scene.solver.cell_size);
  if (shape.is_empty()) {
    frame.footnote += ": no snow here";
    return;
  }
  const SliceMoment slice{view,  snapshot.fields,        plane,
                          shape, sight.pixels_per_metre, frame.height};
  if (scene::has_layer(view, scene::Layer::heatmap)) add_heat_map(slice, frame);
  if (scene::has_layer(view, scene::Layer::streamlines)) add_streamlines(slice, frame);
  if (scene::has_layer(view, scene::Layer::arrows)) {
    const ArrowScale scale = add_arrows(slice, frame);
    const std::string unit = attribute_name(view.slice.field).unit;
    if (scale.every > 1)
      frame.footnote += ", one arrow per " + std::to_string(scale.every) + " nodes";
    if (scale.longest_near > 0)
      frame.footnote += ", each node near the chosen point, longest there " +
                        rough_text(scale.longest_near) + " " + unit;
    const scene::Range range = view.slice.range.value_or(scene::Range{});
    frame.footnote +=
        ", longest arrow " + longest_text(view, range.max) + " " + unit +
        (view.slice.range_from == scene::RangeFrom::frame ? ", the largest of this frame" : "");
  }
  add_frame(plane, shape.rectangle(), frame);
}

}  // namespace neve::app::picture
