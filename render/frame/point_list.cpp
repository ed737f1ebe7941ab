#include "render/frame/point_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "render/frame/colormap.h"
#include "render/frame/view.h"

namespace neve::render {
namespace {

/// Square tiles of the picture, each with a depth behind which nothing can be seen: finds spheres
/// that nearer ones cover, before they cost fragments. In packed snow that is nearly all of them.
/// Never leaves out a sphere that would show in a sample.
class OcclusionGrid {
 public:
  /// @param typical_radius of spheres on the picture, samples; sets the size of the tiles
  OcclusionGrid(const View& view, float typical_radius);

  /// True if nearer spheres cover everything within reach of a place.
  /// @param x, y, reach samples, y up; @param nearest distance along the view, m
  bool hides(float x, float y, float reach, float nearest) const;

  /// Notes that a whole disc is covered.
  /// @param farthest distance along the view of its farthest visible point, m
  void cover(float x, float y, float radius, float farthest);

 private:
  /// Tiles that [low, high] touches, clamped to the picture.
  struct Span {
    int first, last;
  };
  Span touched(float low, float high, int count) const;

  float tile_;  ///< samples
  int columns_, rows_;
  std::vector<float> limit_;
};

// Tiles of a third of the radius: a disc covers a dozen of them, and asking about a disc reads few.
OcclusionGrid::OcclusionGrid(const View& view, float typical_radius)
    : tile_(std::clamp(std::floor(typical_radius / 3), 1.0f, 64.0f)),
      columns_(static_cast<int>(std::ceil(static_cast<float>(view.width) / tile_))),
      rows_(static_cast<int>(std::ceil(static_cast<float>(view.height) / tile_))),
      limit_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
             std::numeric_limits<float>::infinity()) {}

OcclusionGrid::Span OcclusionGrid::touched(float low, float high, int count) const {
  const float last = static_cast<float>(count - 1);
  return {static_cast<int>(std::clamp(std::floor(low / tile_), 0.0f, last)),
          static_cast<int>(std::clamp(std::floor(high / tile_), 0.0f, last))};
}

bool OcclusionGrid::hides(float x, float y, float reach, float nearest) const {
  const Span across = touched(x - reach, x + reach, columns_);
  const Span along = touched(y - reach, y + reach, rows_);
  for (int j = along.first; j <= along.last; ++j) {
    const float* row = limit_.data() + static_cast<std::ptrdiff_t>(j) * columns_;
    for (int i = across.first; i <= across.last; ++i) {
      if (!(row[i] < nearest)) return false;
    }
  }
  return true;
}

void OcclusionGrid::cover(float x, float y, float radius, float farthest) {
  if (radius < 0.5f * tile_) return;
  const Span across = touched(x - radius, x + radius, columns_);
  const Span along = touched(y - radius, y + radius, rows_);
  const auto far_edge = [&](int tile, float center) {
    const float low = static_cast<float>(tile) * tile_;
    return std::max(std::abs(low - center), std::abs(low + tile_ - center));
  };
  for (int j = along.first; j <= along.last; ++j) {
    const float dy = far_edge(j, y);
    float* row = limit_.data() + static_cast<std::ptrdiff_t>(j) * columns_;
    for (int i = across.first; i <= across.last; ++i) {
      const float dx = far_edge(i, x);
      if (dx * dx + dy * dy <= radius * radius) row[i] = std::min(row[i], farthest);
    }
  }
}

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

/// Slabs of distance, front to back, for a counting sort. They have equal ratios rather than
/// widths: one far stray must not squeeze the rest into one slab.
class Slabs {
 public:
  static constexpr std::size_t count = 2048;
  Slabs(float nearest, float farthest)
      : nearest_(nearest),
        scale_(static_cast<float>(count - 1) / std::log(std::max(farthest / nearest, 1.0001f))) {}
  std::uint16_t of(float z) const {
    return static_cast<std::uint16_t>(
        std::min(scale_ * std::log(z / nearest_), static_cast<float>(count - 1)));
  }

 private:
  float nearest_, scale_;
};

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

namespace {

PointVertex vertex_of(const Points& points, const PointColors& color, const View& view,
                      std::uint32_t p) {
  const Rgb8 c = color.of(p);
  return {points.position[p] - view.eye, {c.r, c.g, c.b, 255}};
}

/// Lists all that may be seen, on all threads: one counting sort over slabs of distance.
class ListOfAll {
 public:
  ListOfAll(const Points& points, const View& view, float max_point_size, ThreadPool& team)
      : points_(points),
        view_(view),
        max_point_size_(max_point_size),
        team_(team),
        order_(order_by_id(points)),
        color_(points),
        z_(points.position.size()),
        parts_(std::clamp<std::size_t>(z_.size() / 4096, 1, 64)) {}

  PointList make() {
    for_each_part(
        [&](Part& part, std::size_t begin, std::size_t end) { project(part, begin, end); });
    float nearest = INFINITY, farthest = 0;
    for (const Part& part : parts_) {
      nearest = std::min(nearest, part.nearest);
      farthest = std::max(farthest, part.farthest);
    }
    PointList list;
    if (farthest == 0) return list;
    const Slabs slabs(nearest, farthest);
    for_each_part([&](Part& part, std::size_t begin, std::size_t end) {
      part.start.assign(Slabs::count, 0);
      for (std::size_t i = begin; i < end; ++i)
        if (z_[i] > 0) ++part.start[slabs.of(z_[i])];
    });
    list.small.resize(start_parts());
    for_each_part([&](Part& part, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (z_[i] > 0) list.small[part.start[slabs.of(z_[i])]++] = vertex(i);
    });
    list.large = list_large(slabs);
    return list;
  }

 private:
  struct Part {
    float nearest = INFINITY, farthest = 0;  ///< of all that is drawn, m
    std::vector<std::uint32_t> start;        ///< of each slab: how many, then where they begin
    std::vector<std::pair<float, PointVertex>> large;  ///< behind the distance of each, m
  };

  template <class Body>
  void for_each_part(const Body& body) {
    const std::size_t count = z_.size(), of = parts_.size();
    team_.run(team_.thread_count(), static_cast<int>(of), [&](int k) {
      const auto part = static_cast<std::size_t>(k);
      body(parts_[part], count * part / of, count * (part + 1) / of);
    });
  }

  std::uint32_t point(std::size_t i) const {
    return order_.empty() ? static_cast<std::uint32_t>(i) : order_[i];
  }
  PointVertex vertex(std::size_t i) const { return vertex_of(points_, color_, view_, point(i)); }

  void project(Part& part, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Disc disc =
          disc_of(view_, points_.position[point(i)] - view_.eye, points_.radius, max_point_size_);
      if (disc.drawn == Drawn::no) continue;
      part.nearest = std::min(part.nearest, disc.z);
      part.farthest = std::max(part.farthest, disc.z);
      if (disc.drawn == Drawn::as_point)
        z_[i] = disc.z;
      else
        part.large.emplace_back(disc.z, vertex(i));
    }
  }

  /// Slab by slab, and in each part by part. @returns how many there are in all
  std::size_t start_parts() {
    std::uint32_t total = 0;
    for (std::size_t slab = 0; slab < Slabs::count; ++slab)
      for (Part& part : parts_) total += std::exchange(part.start[slab], total);
    return total;
  }

  std::vector<PointVertex> list_large(const Slabs& slabs) const {
    std::vector<std::pair<float, PointVertex>> all;
    for (const Part& part : parts_) all.insert(all.end(), part.large.begin(), part.large.end());
    std::ranges::stable_sort(all, {}, [&](const auto& one) { return slabs.of(one.first); });
    std::vector<PointVertex> list;
    for (const auto& [z, vertex] : all) list.push_back(vertex);
    return list;
  }

  const Points& points_;
  const View& view_;
  float max_point_size_;
  ThreadPool& team_;
  std::vector<std::uint32_t> order_;
  PointColors color_;
  std::vector<float> z_;  ///< distance of what is drawn as a point, m; 0 of the others
  std::vector<Part> parts_;
};

/// Leaves out what nearer spheres cover. On one thread: a sphere goes because of those before it.
void leave_out_hidden(const View& view, float radius, float max_point_size, PointList& list) {
  const auto disc = [&](const PointVertex& vertex) {
    return disc_of(view, vertex.center, radius, max_point_size);
  };
  double sum = 0;
  for (const auto* some : {&list.small, &list.large})
    for (const PointVertex& vertex : *some) sum += static_cast<double>(disc(vertex).on_picture);
  const std::size_t count = list.small.size() + list.large.size();
  if (count == 0) return;
  OcclusionGrid grid(view, static_cast<float>(sum / static_cast<double>(count)));
  for (auto* some : {&list.large, &list.small})
    std::erase_if(*some, [&](const PointVertex& vertex) {
      return is_hidden(disc(vertex), view.pixels_per_slope, grid);
    });
}

}  // namespace

PointList list_points(const Points& points, const View& view, float max_point_size,
                      bool is_without_hidden, ThreadPool* pool) {
  ThreadPool alone(1);
  PointList list = ListOfAll(points, view, max_point_size, pool ? *pool : alone).make();
  if (is_without_hidden) leave_out_hidden(view, points.radius, max_point_size, list);
  return list;
}

}  // namespace neve::render
