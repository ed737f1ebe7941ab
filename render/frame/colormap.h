#pragma once
/// Colour maps for attributes.

#include <cstdint>

#include "render/frame/frame.h"

namespace neve::render {

/// 8-bit sRGB.
struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// Colour at t in [0, 1]; values outside are clamped, not-a-number is pink, unlike any map.
Rgb8 map_color(ColorMap map, float t);

/// Colour of a value in a range; a range of no width maps everything to its middle.
Rgb8 map_value(ColorMap map, float value, float range_min, float range_max);

}  // namespace neve::render
