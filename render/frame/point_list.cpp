#include "render/frame/point_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "render/frame/colormap.h"
#include "render/frame/occlusion.h"

namespace neve::render {
namespace {

enum class Drawn : std::uint8_t { no, as_point, as_quad };

/// A sphere on the picture.
struct Disc {
  float x = 0, y = 0;    ///< centre, samples, y up
  float z = 0;           ///< distance of the centre along the view, m
  float radius = 0;      ///< m, as drawn
  float on_picture = 0;  ///< radius across the direction to the middle of the picture, samples
  float slope = 0;       ///< tangent of the angle off the axis
  float reach = 0;       ///< no sample further than this from the centre is touched
  Drawn drawn = Drawn::no;
};

/// @param p centre relative to the eye
Disc disc_of(const View& view, Vec3f p, float radius, float max_point_size) {
  Disc d;
  d.z = dot(p, view.forward);
  if (!(d.z > view.near_distance) || !std::isfinite(d.z)) return d;
  if (dot(p, p) < 1.1f * radius * radius) return d;  // the eye is inside
  const float scale = view.pixels_per_slope / d.z;
  const float x = dot(p, view.right) * scale, y = dot(p, view.up) * scale;
  const float half_width = 0.5f * static_cast<float>(view.width);
  const float half_height = 0.5f * static_cast<float>(view.height);
  d.x = half_width + x;
  d.y = half_height + y;
  d.radius = std::max(radius, min_radius_pixels / scale);
  d.on_picture = d.radius * scale;
  d.slope = std::sqrt(x * x + y * y) / view.pixels_per_slope;
  // Generous: spheres look longer away from the axis.
  d.reach = d.on_picture * (1 + d.slope + 4 * d.radius / d.z) + 1;
  const bool is_close = d.radius > 0.2f * d.z;
  if (!is_close && (std::abs(x) - d.reach > half_width || std::abs(y) - d.reach > half_height))
    return d;
  // OpenGL drops a point whose centre is outside, however large it is.
  const bool is_outside = std::abs(x) > half_width || std::abs(y) > half_height;
  d.drawn =
      is_close || is_outside || 2 * d.reach > max_point_size ? Drawn::as_quad : Drawn::as_point;
  return d;
}

/// True if nearer spheres cover this one; if not, it covers others from now on.
bool is_hidden(const Disc& d, float pixels_per_slope, OcclusionGrid& grid) {
  const float ratio = d.radius / d.z;
  if (ratio > 0.1f) return false;  // so close that the bounds below are too rough
  if (grid.hides(d.x, d.y, d.reach, d.z - d.radius)) return true;
  // Perspective moves the outline of a sphere away from the image of its centre.
  const float moved = 1.5f * d.slope * (1 + d.slope * d.slope) * ratio * ratio * pixels_per_slope;
  grid.cover(d.x, d.y, d.on_picture - moved - 0.5f, d.z + d.radius * d.slope);
  return false;
}

std::uint32_t scramble(std::uint32_t x) {
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return x ^ x >> 16;
}

/// Snow in 64 slightly different shades, so that grains can be told apart.
std::array<Rgb8, 64> snow_shades() {
  std::array<Rgb8, 64> shades;
  for (std::size_t i = 0; i < shades.size(); ++i) {
    const float brightness = 0.95f + 0.07f * static_cast<float>(i) / 63;
    const auto channel = [&](float linear) {
      const float srgb = std::pow(linear * brightness, 1 / 2.2f);
      return static_cast<std::uint8_t>(std::lround(255 * std::min(1.0f, srgb)));
    };
    shades[i] = {channel(0.90f), channel(0.925f), channel(0.95f)};
  }
  return shades;
}

/// The square root of linear light for each sRGB byte, as shaders/particles.vert makes it.
std::array<std::uint8_t, 256> root_table() {
  std::array<std::uint8_t, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] =
        static_cast<std::uint8_t>(std::lround(255 * std::pow(static_cast<float>(i) / 255, 1.1f)));
  return table;
}

/// Sorts roughly front to back without breaking the order of ids among equals: one counting sort
/// over slabs of distance.
std::vector<std::uint32_t> order_by_distance(const std::vector<std::uint32_t>& drawn,
                                             const std::vector<Disc>& discs) {
  constexpr std::size_t slabs = 2048;
  float nearest = INFINITY, farthest = 0;
  for (const std::uint32_t p : drawn) {
    nearest = std::min(nearest, discs[p].z);
    farthest = std::max(farthest, discs[p].z);
  }
  // Slabs of equal ratio rather than width: one far stray must not squeeze the rest into one slab.
  const float scale =
      static_cast<float>(slabs - 1) / std::log(std::max(farthest / nearest, 1.0001f));
  std::vector<std::uint16_t> slab_of(drawn.size());
  std::vector<std::uint32_t> start(slabs + 1);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const float slab = scale * std::log(discs[drawn[i]].z / nearest);
    slab_of[i] = static_cast<std::uint16_t>(std::min(slab, static_cast<float>(slabs - 1)));
    ++start[slab_of[i] + 1u];
  }
  for (std::size_t s = 0; s < slabs; ++s) start[s + 1] += start[s];
  std::vector<std::uint32_t> sorted(drawn.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) sorted[start[slab_of[i]]++] = drawn[i];
  return sorted;
}

}  // namespace

std::vector<std::uint32_t> order_by_id(const Points& points) {
  const std::vector<std::uint32_t>& id = points.id;
  if (std::is_sorted(id.begin(), id.end())) return {};
  std::vector<std::uint32_t> order(points.position.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return id[a] < id[b]; });
  return order;
}

Rgb8 PointColors::of(std::uint32_t point) const {
  static const std::array<Rgb8, 64> shades = snow_shades();
  if (!points_.value.empty())
    return map_value(points_.colormap, points_.value[point], points_.range_min, points_.range_max);
  return shades[scramble(points_.id.empty() ? point : points_.id[point]) & 63u];
}

std::uint32_t PointColors::root_albedo(std::uint32_t point) const {
  static const std::array<std::uint8_t, 256> root = root_table();
  const auto packed = [](Rgb8 c) {
    return root[c.r] | static_cast<std::uint32_t>(root[c.g]) << 8 |
           static_cast<std::uint32_t>(root[c.b]) << 16 | 0xff000000u;
  };
  if (!points_.value.empty()) return packed(of(point));
  static const std::array<std::uint32_t, 64> shades = [&] {
    std::array<std::uint32_t, 64> all{};
    std::ranges::transform(snow_shades(), all.begin(), packed);
    return all;
  }();
  return shades[scramble(points_.id.empty() ? point : points_.id[point]) & 63u];
}

PointList list_points(const Points& points, const View& view, float max_point_size,
                      bool leave_out_hidden) {
  std::vector<Disc> discs(points.position.size());
  std::vector<std::uint32_t> drawn;
  drawn.reserve(discs.size());
  double sum_of_radii = 0;
  const std::vector<std::uint32_t> order = order_by_id(points);
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const std::uint32_t p = order.empty() ? static_cast<std::uint32_t>(i) : order[i];
    discs[p] = disc_of(view, points.position[p] - view.eye, points.radius, max_point_size);
    if (discs[p].drawn == Drawn::no) continue;
    drawn.push_back(p);
    sum_of_radii += static_cast<double>(discs[p].on_picture);
  }
  PointList list;
  if (drawn.empty()) return list;

  OcclusionGrid grid(view, static_cast<float>(sum_of_radii / static_cast<double>(drawn.size())));
  const PointColors color(points);
  for (const std::uint32_t p : order_by_distance(drawn, discs)) {
    if (leave_out_hidden && is_hidden(discs[p], view.pixels_per_slope, grid)) continue;
    const Rgb8 c = color.of(p);
    const PointVertex vertex = {points.position[p] - view.eye, {c.r, c.g, c.b, 255}};
    (discs[p].drawn == Drawn::as_point ? list.small : list.large).push_back(vertex);
  }
  return list;
}

}  // namespace neve::render
