#pragma once
/// Part of a G-buffer on the CPU, in the order that lanes read it: the content of
/// shaders/gbuffer.glsl in textures. Plain data, for kernels.

namespace neve::render::light {

inline constexpr int tile_width = 64, tile_height = 32, tile_samples = tile_width * tile_height;

/// Rows from the bottom up.
struct GBufferTile {
  alignas(64) float inverse[tile_samples];  ///< 1/m along the view; 0: nothing there
  alignas(64) int kind[tile_samples];       ///< of surface, see shading_constants.h
  alignas(64) float normal_x[tile_samples], normal_y[tile_samples], normal_z[tile_samples];
  alignas(64) unsigned albedo[tile_samples];  ///< four bytes as in gbuffer.glsl, red lowest
};

/// Light of the samples of kind_lit of a tile before it was finished, in parts: linear, by colour.
struct LitTile {
  alignas(64) float sun[3][tile_samples];
  alignas(64) float open_sun[3][tile_samples];  ///< as if nothing were in its way
  alignas(64) float around[3][tile_samples];    ///< of the sky, and from inside
  unsigned albedo[tile_samples];                ///< as above, without light
};

}  // namespace neve::render::light
