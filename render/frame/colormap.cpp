#include "render/frame/colormap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/frame/range.h"

namespace neve::render {
namespace {

// Each map at 33 equally spaced positions, linear in between (within 2/255 of the full tables).
using Table = std::array<std::uint32_t, 33>;

// viridis and magma: S. van der Walt and N. Smith, 2015, matplotlib, CC0.
constexpr Table viridis_table = {
    0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453681, 0x424086, 0x3f4989, 0x3b528b,
    0x375a8d, 0x33638d, 0x2f6a8e, 0x2c728e, 0x297a8e, 0x26818e, 0x23898e, 0x21908c, 0x1f988b,
    0x1f9f88, 0x21a685, 0x28ae80, 0x31b57b, 0x3ebc74, 0x4cc26c, 0x5dc963, 0x6ece58, 0x82d34c,
    0x96d83f, 0xabdc32, 0xc0df24, 0xd5e21a, 0xeae51a, 0xfde725};
constexpr Table magma_table = {0x000004, 0x030311, 0x0a0822, 0x130d33, 0x1d1146, 0x28115a, 0x36106a,
                               0x430f76, 0x50127c, 0x5d177f, 0x691c81, 0x762181, 0x822681, 0x8f2a81,
                               0x9c2e7f, 0xa9327d, 0xb63779, 0xc33b75, 0xcf4170, 0xdb486a, 0xe65163,
                               0xee5c5e, 0xf5695c, 0xf9785d, 0xfb8761, 0xfd9668, 0xfea571, 0xfeb47b,
                               0xfec387, 0xfed194, 0xfde0a2, 0xfceeb0, 0xfcfdbf};
// turbo: A. Mikhailov, Google, 2019, Apache-2.0.
constexpr Table turbo_table = {0x30123b, 0x392a73, 0x4040a1, 0x4456c7, 0x466be3, 0x467ff6, 0x4293ff,
                               0x37a7fa, 0x29bbec, 0x1dcdd8, 0x18dcc3, 0x1ee8b0, 0x31f299, 0x4cf97e,
                               0x6bfd64, 0x8aff4d, 0xa3fd3c, 0xb8f735, 0xcced34, 0xdee037, 0xedd03a,
                               0xf8c03a, 0xfdae35, 0xfe982c, 0xfb8022, 0xf56817, 0xec520f, 0xe04009,
                               0xd23105, 0xc02302, 0xac1701, 0x950d01, 0x7a0403};
// coolwarm: K. Moreland, Diverging color maps for scientific visualization, 2009.
constexpr Table coolwarm_table = {
    0x3b4cc0, 0x445acc, 0x4d68d7, 0x5775e1, 0x6282ea, 0x6c8ef1, 0x779af7, 0x82a5fb, 0x8db0fe,
    0x98b9ff, 0xa3c2fe, 0xaec9fc, 0xb8d0f9, 0xc2d5f4, 0xccd9ee, 0xd5dbe6, 0xdddddd, 0xe5d8d1,
    0xecd3c5, 0xf1ccb9, 0xf4c4ad, 0xf7bba0, 0xf7b194, 0xf7a687, 0xf49a7b, 0xf18d6f, 0xec7f63,
    0xe57058, 0xde604d, 0xd55042, 0xcb3e38, 0xc0282f, 0xb40426};

const Table& table_of(ColorMap map) {
  switch (map) {
    case ColorMap::viridis:
      return viridis_table;
    case ColorMap::magma:
      return magma_table;
    case ColorMap::turbo:
      return turbo_table;
    case ColorMap::coolwarm:
      break;
  }
  return coolwarm_table;
}

}  // namespace

Rgb8 map_color(ColorMap map, float t) {
  if (std::isnan(t)) return {255, 0, 200};
  const Table& table = table_of(map);
  const float x = std::clamp(t, 0.0f, 1.0f) * 32;
  const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(x), 31);
  const float f = x - static_cast<float>(i);
  const auto channel = [&](int shift) {
    const auto at = [&](std::size_t k) { return static_cast<float>((table[k] >> shift) & 255u); };
    return static_cast<std::uint8_t>(at(i) * (1 - f) + at(i + 1) * f + 0.5f);
  };
  return {channel(16), channel(8), channel(0)};
}

Rgb8 map_value(ColorMap map, float value, float range_min, float range_max) {
  if (std::isnan(value)) return map_color(map, value);
  if (!has_width(static_cast<double>(range_min), static_cast<double>(range_max)))
    return map_color(map, 0.5f);
  // Halves keep the difference finite for the widest ranges.
  const float width = 0.5f * range_max - 0.5f * range_min;
  return map_color(map, (0.5f * value - 0.5f * range_min) / width);
}

}  // namespace neve::render
