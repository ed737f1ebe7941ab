#include "render/point_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "render/colormap.h"

namespace neve::render {
namespace {

enum class Drawn : std::uint8_t { no, as_point, as_quad };

/// How a sphere at p (relative to the eye, z along the view) has to be drawn.
Drawn classify(const View& view, Vec3f p, float z, float radius, float max_point_size) {
  if (!(z > view.near_distance) || !std::isfinite(z)) return Drawn::no;
  if (dot(p, p) < 1.1f * radius * radius) return Drawn::no;  // the eye is inside
  const float scale = view.pixels_per_slope / z;
  const float x = std::abs(dot(p, view.right)) * scale, y = std::abs(dot(p, view.up)) * scale;
  const float half_width = 0.5f * static_cast<float>(view.width);
  const float half_height = 0.5f * static_cast<float>(view.height);
  // Generous: spheres look longer away from the axis.
  const float slope = std::max(x, y) / view.pixels_per_slope;
  const float reach =
      std::max(radius * scale, min_radius_pixels) * (1 + slope + 4 * radius / z) + 1;
  const bool is_close = radius > 0.2f * z;
  if (!is_close && (x - reach > half_width || y - reach > half_height)) return Drawn::no;
  // OpenGL drops a point whose centre is outside, however large it is.
  if (is_close || 2 * reach > max_point_size || x > half_width || y > half_height)
    return Drawn::as_quad;
  return Drawn::as_point;
}

/// Indices in the order of ids, which is nearly always the order they come in.
std::vector<std::uint32_t> order_by_id(const Points& points) {
  std::vector<std::uint32_t> order(points.position.size());
  std::iota(order.begin(), order.end(), 0u);
  const std::vector<std::uint32_t>& id = points.id;
  if (!std::is_sorted(id.begin(), id.end())) {
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return id[a] < id[b]; });
  }
  return order;
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
      return static_cast<std::uint8_t>(255 * std::min(1.0f, srgb) + 0.5f);
    };
    shades[i] = {channel(0.90f), channel(0.925f), channel(0.95f)};
  }
  return shades;
}

Rgb8 color_of(const Points& points, std::uint32_t p) {
  static const std::array<Rgb8, 64> shades = snow_shades();
  if (!points.value.empty())
    return map_value(points.colormap, points.value[p], points.range_min, points.range_max);
  return shades[scramble(points.id.empty() ? p : points.id[p]) & 63u];
}

/// Sorts roughly front to back, which spares hidden fragments, without breaking the order of ids
/// among equals: one counting sort over slabs of distance.
std::vector<std::uint32_t> order_by_distance(const std::vector<std::uint32_t>& drawn,
                                             const std::vector<float>& distance) {
  constexpr std::size_t slabs = 2048;
  float nearest = INFINITY, farthest = 0;
  for (const std::uint32_t p : drawn) {
    nearest = std::min(nearest, distance[p]);
    farthest = std::max(farthest, distance[p]);
  }
  // Slabs of equal ratio rather than width: one far stray must not squeeze the rest into one slab.
  const float scale =
      static_cast<float>(slabs - 1) / std::log(std::max(farthest / nearest, 1.0001f));
  const auto slab = [&](std::uint32_t p) {
    return std::min(slabs - 1, static_cast<std::size_t>(scale * std::log(distance[p] / nearest)));
  };
  std::vector<std::uint16_t> slab_of(drawn.size());
  std::vector<std::uint32_t> start(slabs + 1);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    slab_of[i] = static_cast<std::uint16_t>(slab(drawn[i]));
    ++start[slab_of[i] + 1u];
  }
  for (std::size_t s = 0; s < slabs; ++s) start[s + 1] += start[s];
  std::vector<std::uint32_t> sorted(drawn.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) sorted[start[slab_of[i]]++] = drawn[i];
  return sorted;
}

}  // namespace

PointList list_points(const Points& points, const View& view, float max_point_size) {
  const std::size_t count = points.position.size();
  std::vector<Drawn> kind(count);
  std::vector<float> distance(count);
  std::vector<std::uint32_t> drawn;
  drawn.reserve(count);
  for (const std::uint32_t p : order_by_id(points)) {
    const Vec3f center = points.position[p] - view.eye;
    distance[p] = dot(center, view.forward);
    kind[p] = classify(view, center, distance[p], points.radius, max_point_size);
    if (kind[p] != Drawn::no) drawn.push_back(p);
  }

  PointList list;
  list.small.reserve(drawn.size());
  for (const std::uint32_t p : order_by_distance(drawn, distance)) {
    const Rgb8 c = color_of(points, p);
    const PointVertex vertex = {points.position[p] - view.eye, {c.r, c.g, c.b, 255}};
    (kind[p] == Drawn::as_point ? list.small : list.large).push_back(vertex);
  }
  return list;
}

}  // namespace neve::render
