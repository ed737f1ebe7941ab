#include <algorithm>
#include <cmath>

#include "app/picture/slice_parts.h"
#include "app/picture/streamlines.h"
#include "app/picture/to_float.h"

namespace neve::app::picture {

namespace {

using Eigen::Vector2d;
using sim::Vec3d;

/// Pixels from arrow to arrow and from line to line in a picture 720 high, and the least anywhere:
/// closer they are a carpet.
constexpr double arrow_distance = 40, line_distance = 18;
constexpr double min_arrow_distance = 18, min_line_distance = 8;
/// The longest arrow over the distance of its neighbours. Arrows have their nodes in the middle, so
/// below 1 each keeps to a disc of its own and none can hide another.
constexpr double arrow_reach = 0.95;
/// Arrows below this share of the longest are dots that say nothing; lines there are noise.
constexpr float min_shown = 0.02f;
/// Cells around a point in which each node has an arrow.
constexpr double dense_cells = 4;
/// The grid has a velocity at a place if at least this share of the nodes around it has mass.
constexpr float min_cover = 0.5f;

double distance_of(const SliceMoment& slice, double usual, double least) {
  return std::max(least, usual * slice.picture_height / 720) /
         std::max(slice.pixels_per_metre, 1e-3);
}

int nodes_between_arrows(const SliceMoment& slice) {
  if (slice.view.slice.every > 0) return slice.view.slice.every;
  const double distance = distance_of(slice, arrow_distance, min_arrow_distance);
  return static_cast<int>(std::clamp(std::ceil(distance / slice.cell()), 1.0, 1000.0));
}

render::Lines coloured(const SliceMoment& slice) {
  const scene::SliceStyle& style = slice.view.slice;
  const scene::Range range = style.range.value_or(scene::Range{});
  render::Lines lines;
  lines.color = {0.96f, 0.97f, 1.0f};
  lines.colormap = style.colormap;
  lines.range_min = static_cast<float>(range.min);
  lines.range_max = static_cast<float>(range.max);
  lines.width = 1.7f;
  return lines;
}

/// Lines as they are drawn, dark ones below that set them off from whatever they lie on.
class FlowLines {
 public:
  FlowLines(const SliceMoment& slice, const std::vector<Vec3f>& vectors)
      : slice_(slice), sampler_(slice.fields), vectors_(vectors), lines_(coloured(slice)) {}

  std::optional<Vector2d> in_plane(const Vector2d& x) const {
    const auto vector = at(x);
    if (!vector) return std::nullopt;
    const Vec3d v(vector->x, vector->y, vector->z);
    const Vector2d part(v.dot(slice_.plane.across), v.dot(slice_.plane.up));
    const double least = static_cast<double>(min_shown * lines_.range_max);
    return part.norm() > least ? std::optional(part) : std::nullopt;
  }

  void add(const Streamline& line, double head) {
    for (std::size_t k = 1; k < line.size(); ++k) piece(line[k - 1], line[k]);
    // A head at its middle says which way it goes.
    const std::size_t middle = line.size() / 2;
    const Vector2d& tip = line[middle];
    const Vector2d along = (tip - line[middle - 1]).normalized();
    const Vector2d aside(-along.y(), along.x());
    for (const double sign : {-1.0, 1.0}) piece(tip - head * (along + 0.55 * sign * aside), tip);
  }

  void move_to(render::Frame& frame) {
    if (lines_.ends.empty()) return;
    render::Lines rim;
    rim.ends = lines_.ends;
    rim.color = {0.03f, 0.04f, 0.06f};
    rim.opacity = 0.55f;
    rim.width = 2.1f * lines_.width;
    frame.lines.push_back(std::move(rim));
    frame.lines.push_back(std::move(lines_));
  }

 private:
  std::optional<Vec3f> at(const Vector2d& x) const {
    const auto stencil = sampler_.at(point_on(slice_.plane, x.x(), x.y()));
    return stencil && stencil->cover >= min_cover
               ? std::optional(FieldSampler::mean(*stencil, vectors_))
               : std::nullopt;
  }
  void piece(const Vector2d& from, const Vector2d& to) {
    for (const Vector2d& end : {from, to})
      lines_.ends.push_back(to_float(point_on(slice_.plane, end.x(), end.y())));
    if (scene::has_layer(slice_.view, scene::Layer::heatmap)) return;
    const auto value = at(to);
    lines_.value.push_back(value ? length(*value) : 0);
  }

  const SliceMoment& slice_;
  const FieldSampler sampler_;
  const std::vector<Vec3f>& vectors_;
  render::Lines lines_;
};

/// Arrows at those nodes, so many apart, whose places are wanted and whose values are greater.
template <class IsWanted>
render::Arrows arrows_at(const SliceMoment& slice, int every, float least,
                         const IsWanted& is_wanted) {
  const scene::SliceStyle& style = slice.view.slice;
  const double step = every * slice.cell();
  const scene::Range range = style.range.value_or(scene::Range{});
  const auto largest = static_cast<float>(range.max);
  const std::vector<Vec3f>& values = slice.fields.vectors.at(style.field);
  render::Arrows arrows;
  arrows.is_centred = true;
  arrows.colormap = style.colormap;
  arrows.range_min = static_cast<float>(range.min);
  arrows.range_max = largest;
  arrows.max_length = static_cast<float>(style.arrow_scale * arrow_reach * step);
  arrows.length_per_value = largest > 0 ? arrows.max_length / largest : 0;
  const FieldSampler sampler(slice.fields);
  const Rectangle& r = slice.shape.rectangle();
  for (double j = std::ceil(r.bottom / step); j * step <= r.top; ++j)
    for (double i = std::ceil(r.left / step); i * step <= r.right; ++i) {
      const Vec3d x = point_on(slice.plane, i * step, j * step);
      if (!is_wanted(x)) continue;
      const auto stencil = sampler.at(x);
      if (!stencil || stencil->cover < min_cover) continue;
      const Vec3f value = FieldSampler::mean(*stencil, values);
      if (!(length(value) > least)) continue;
      arrows.position.edit().push_back(to_float(x));
      arrows.vector.edit().push_back(value);
    }
  return arrows;
}

}  // namespace

ArrowScale add_arrows(const SliceMoment& slice, render::Frame& frame) {
  const scene::SliceStyle& style = slice.view.slice;
  const int every = nodes_between_arrows(slice);
  // Distances are seen from the front of the plane, which may be behind the point.
  const auto is_dense = [&](const Vec3d& x) {
    if (every == 1 || !style.dense_near) return false;
    const Vec3d from = x - *style.dense_near;
    return (from - from.dot(slice.plane.normal) * slice.plane.normal).norm() <
           dense_cells * slice.cell();
  };
  const auto largest = static_cast<float>(style.range.value_or(scene::Range{}).max);
  frame.arrows.push_back(
      arrows_at(slice, every, min_shown * largest, [&](const Vec3d& x) { return !is_dense(x); }));
  ArrowScale scale{every};
  render::Arrows dense = arrows_at(slice, 1, 0, is_dense);
  for (std::size_t k = 0; k < dense.vector.size(); ++k)
    scale.longest_near = std::max(scale.longest_near, static_cast<double>(length(dense.vector[k])));
  if (!(scale.longest_near > 0)) return scale;
  dense.length_per_value = dense.max_length / static_cast<float>(scale.longest_near);
  frame.arrows.push_back(std::move(dense));
  return scale;
}

void add_streamlines(const SliceMoment& slice, render::Frame& frame) {
  const Rectangle& r = slice.shape.rectangle();
  StreamlineStyle style;
  style.distance = distance_of(slice, line_distance, min_line_distance);
  style.step = std::min(0.2 * style.distance, 0.5 * slice.cell());
  style.shortest = 1.5 * style.distance;
  style.low = {r.left, r.bottom};
  style.high = {r.right, r.top};
  FlowLines lines(slice, slice.fields.vectors.at(slice.view.slice.field));
  const PlaneField field = [&](const Vector2d& x) { return lines.in_plane(x); };
  for (const Streamline& line : streamlines(field, style)) lines.add(line, 0.45 * style.distance);
  lines.move_to(frame);
}

}  // namespace neve::app::picture
