#pragma once
/// Turns the points of a frame into the buffer that the particle pass uploads.

#include <array>
#include <cstdint>
#include <vector>

#include "render/frame/colormap.h"
#include "render/frame/frame.h"
#include "render/frame/view.h"
#include "sim/base/thread_pool.h"

namespace neve::render {

/// One sphere for the shaders: centre relative to the eye and albedo in sRGB.
struct PointVertex {
  Vec3f center;
  std::uint8_t color[4];
};

struct PointList {
  std::vector<PointVertex> small;  ///< drawn as points
  std::vector<PointVertex> large;  ///< drawn as quads
};

/// Smallest radius on the picture, in samples, at which a sphere cannot fall between samples.
inline constexpr float min_radius_pixels = 0.75f;

/// Indices of points in the order of ids; empty where they come in that order, as they nearly
/// always do.
std::vector<std::uint32_t> order_by_id(const Points& points);

/// Colour of each point: its value on the colour map, or one of many shades of snow.
class PointColors {
 public:
  explicit PointColors(const Points& points) : points_(points) {}
  /// Returns the colour in sRGB.
  Rgb8 of(std::uint32_t point) const;
  /// Returns the colour for the G-buffer: roots of linear light in bytes, opaque, red lowest.
  std::uint32_t root_albedo(std::uint32_t point) const;

 private:
  const Points& points_;
};

/// Leaves out points outside the picture, behind the eye, or at no finite position. Front to back,
/// equals in the order of ids: then nearer spheres keep fragments of those behind from being
/// shaded.
/// @param max_point_size largest point of the driver, pixels
/// @param is_without_hidden also leaves out spheres that nearer ones cover: the picture stays the
/// same; pays where fragments are drawn on the CPU @param pool may be null
PointList list_points(const Points& points, const View& view, float max_point_size,
                      bool is_without_hidden, ThreadPool* pool);

}  // namespace neve::render
