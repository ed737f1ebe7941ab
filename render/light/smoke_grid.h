#pragma once
/// The opacity of smoke on one box of texels: the blocks of a node lattice before light
/// falls on them and rays march through them. A function of the smoke alone.

#include "render/frame/frame.h"
#include "sim/base/thread_pool.h"

namespace neve::render::light {

/// Extinction over a node spacing at opacity 1: three nodes of packed snow pass 40 % of the light.
inline constexpr float smoke_extinction = 0.3054f;  // -ln(0.4) / 3

/// Texels lie on nodes, or on cubes of nodes where the smoke is too wide for that; the outermost
/// ones are empty. Index = (z * size.y + y) * size.x + x.
struct SmokeGrid {
  Vec3f origin;       ///< m, where texel (0, 0, 0) lies
  float spacing = 1;  ///< m between texels
  Vec3i size{0, 0, 0};
  float node_spacing = 1;  ///< m
  Values<float> opacity;   ///< 0 and more
  Values<float> value;     ///< place in the range, [0, 1], times opacity; empty without values

  bool operator==(const SmokeGrid&) const = default;
  /// Extinction at opacity 1: packed snow at density_scale 1.
  float extinction() const { return smoke_extinction / node_spacing; }  // 1/m
  bool is_empty() const { return opacity.empty(); }
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(x);
  }
};

/// Boxes of more texels, or longer than this, first lose resolution down to a quarter, then strays
/// where these alone are the cause, and then more resolution.
inline constexpr int max_smoke_texels = 1 << 22, max_smoke_side = 256;

/// Opacity that a density is drawn with: less than proportional, so that powder shows.
/// @param share density over that of packed snow; values that are not positive and finite have none
float smoke_opacity(float share);

/// Blocks of nodes with smoke that is not drawn, as it lies too far from the rest.
std::size_t strays_of(const Smoke& smoke);

/// Makes the grid of smoke, empty where there is nothing to see. @param pool may be null
SmokeGrid make_smoke_grid(const Smoke& smoke, ThreadPool* pool);

}  // namespace neve::render::light
