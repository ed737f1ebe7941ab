#pragma once
/// Planes of numbers, one number a pixel, top row first.

#include <array>
#include <vector>

#include "render/channels/channels.h"
#include "render/image/exr.h"

namespace neve::render::channels {

using Plane = std::vector<float>;
using ColorPlanes = std::array<Plane, 3>;

/// Parts of the light: beauty = direct + indirect + emission.
struct LightPlanes {
  ColorPlanes beauty, direct, indirect, emission;
  /// Direct light, with the background behind holdouts lit as they are: with shadows and as it
  /// would be without any.
  ColorPlanes shaded, open;
  Plane cover;
};

/// Data of the surface in each pixel; planes that nobody wants are empty.
struct DataPlanes {
  Plane depth;
  ColorPlanes position, normal, albedo;
  std::array<Plane, 4> motion;  ///< forward u and v, backward u and v
  Plane id, body, collider;
  std::vector<Plane> numbers;  ///< of each channel of each of Request::numbers
};

/// Names the channels as compositors know them: half floats for light, albedo and normals, single
/// precision for the rest. Moves the planes out.
ExrPicture to_picture(int width, int height, const Request& request, LightPlanes light,
                      DataPlanes data);

}  // namespace neve::render::channels
