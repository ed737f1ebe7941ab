#pragma once
/// A picture as channels of numbers for compositing: linear light in parts, and data of the surface
/// that each pixel shows.
///
/// Light is averaged over the samples of a pixel, and over the moments of the shutter. Data are
/// those of the nearest sample alone: an average of two depths or two numbers of particles is the
/// depth or the number of nothing. Heat maps and arrows are surfaces with depth, without a body.

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "render/frame/frame.h"
#include "render/image/exr.h"

namespace neve::render::channels {

enum class Pass {
  depth,
  position,
  normal,
  albedo,
  direct,
  indirect,
  emission,
  shadow,
  motion,
  id,
  body,
  collider
};

/// Depth where there is nothing, m: what Blender writes.
inline constexpr float nothing_depth = 1e10f;
/// Number of a particle, body or collider if there is none.
inline constexpr float no_number = -1;

/// A change of place of a rigid thing: p goes to rotation p + offset.
struct Displacement {
  std::array<Vec3f, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< rows
  Vec3f offset;                                                      ///< m

  Vec3f operator()(Vec3f p) const {
    return Vec3f{dot(rotation[0], p), dot(rotation[1], p), dot(rotation[2], p)} + offset;
  }
};

/// A thing that is no snow, and where its parts are an interval before and after.
struct Thing {
  std::int32_t collider = -1;  ///< number in the scene
  Displacement before, after;
};

/// Numbers of each point of the frame, as channels "<name>.<channel>".
struct PointNumbers {
  std::string name;
  std::vector<std::string> channels;
  std::vector<float> value;  ///< one per channel and point, point by point
};

/// Wanted passes, and facts about the frame that they need.
struct Request {
  std::set<Pass> passes;
  std::vector<PointNumbers> numbers;
  float interval = 0;                  ///< s, from a frame to the next
  Camera before, after;                ///< an interval earlier and later
  std::vector<Vec3f> velocity;         ///< m/s, of each point
  std::vector<std::int32_t> body;      ///< of each point
  std::vector<Thing> meshes, grounds;  ///< one for each of the frame's
  /// Frames over which light is averaged; without any, light is that of the frame itself.
  Moments moments;
};

/// Header with the matrices of the frame's camera, as the standard of OpenEXR has them: camera
/// space is left-handed, x right, y up and z ahead, in m; normalised device coordinates go from (0,
/// 0), the upper left corner, to (1, 1).
ExrHeader camera_header(const Frame& frame);

/// @throws std::invalid_argument for lists that are not as long as those of the frame
void check_request(const Frame& frame, const Request& request);
/// @throws std::invalid_argument for one of another size than the frame
void check_moment(const Frame& frame, const Frame& moment);

}  // namespace neve::render::channels
