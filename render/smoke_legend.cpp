#include "render/smoke_legend.h"

#include <algorithm>
#include <cmath>

#include "render/light/smoke_grid.h"

namespace neve::render {

namespace {

constexpr int cells = 3, shades = 64;
constexpr float dark = 46, bright = 240;  ///< sRGB, behind the smoke and of smoke without end

}  // namespace

Legend smoke_legend(float full_density, float density_scale) {
  Legend legend{"density, " + std::to_string(cells) + " cells deep", "kg/m3", ColorMap::viridis, 0,
                2 * full_density};
  for (int k = 0; k < shades; ++k) {
    const float share = 2.0f * static_cast<float>(k) / (shades - 1);
    const float opacity = density_scale * light::smoke_opacity(share);
    const float seen = 1 - std::exp(-light::smoke_extinction * opacity * cells);
    const auto grey = static_cast<std::uint8_t>(std::lround(dark + (bright - dark) * seen));
    legend.colors.push_back({grey, grey, grey});
  }
  return legend;
}

std::size_t smoke_left_out(const Smoke& smoke) {
  return light::strays_of(smoke);
}

}  // namespace neve::render
