#pragma once
/// Part of a G-buffer on the CPU, in the order that lanes read it: what shaders/gbuffer.glsl has in
/// textures. Plain data, for kernels.

namespace neve::render::light {

inline constexpr int tile_width = 64, tile_height = 32, tile_samples = tile_width * tile_height;

/// Kinds of surface, as in shaders/gbuffer.glsl.
inline constexpr int kind_nothing = 0, kind_ground = 1, kind_solid = 2, kind_snow = 3,
                     kind_attribute = 4, kind_flat = 5;

/// Rows from the bottom up.
struct GBufferTile {
  alignas(64) float inverse[tile_samples];  ///< 1/m along the view; 0: nothing there
  alignas(64) int kind[tile_samples];       ///< of surface
  alignas(64) float normal_x[tile_samples], normal_y[tile_samples], normal_z[tile_samples];
  alignas(64) unsigned albedo[tile_samples];  ///< four bytes as in gbuffer.glsl, red lowest
};

}  // namespace neve::render::light
