#pragma once
/// Data of the kernels that finish and light a tile of surfaces: plain data, as splat_job.h.
///
/// Positions are relative to the eye, in m, with the axes of the world. Samples count from the
/// lower left corner of the picture.

#include "render/light/gbuffer_tile.h"
#include "render/light/light_job.h"
#include "sim/base/vec.h"

namespace neve::render::cpu {

/// An infinite plane with grid lines, as shaders/ground.frag takes it.
struct GroundJob {
  light::LaneView view;
  Vec3f point, normal, tangent, bitangent;
  float eye_on_grid[2], line_spacing;
  Vec3f fade_center;
  float fade_distance;
  Vec3f root_color;  ///< square root of linear light
  float line_width;  ///< samples
  int kind;          ///< light::kind_ground or light::kind_holdout
};

/// Samples that OpenGL has drawn, as the textures of the G-buffer hold them.
struct SolidJob {
  float near_distance;                ///< m
  const float* depth;                 ///< of the lower left sample of the tile
  const unsigned short* normal_kind;  ///< four half floats each
  const unsigned* albedo;
  int pitch;  ///< samples from one row to the next
  int columns, rows;
};

/// Lights one tile, as shaders/shade.frag does.
struct ShadeJob {
  light::LaneView view;
  light::LightCells light;
  Vec3f toward_light;
  float key_intensity, ambient_intensity;
  /// Strengths of the light whose share holdouts leave of the background.
  float holdout_key_intensity, holdout_ambient_intensity;
  int is_transparent;
  const light::SmokeCover* smoke;  ///< null if there is none
  const light::GBufferTile* tile;
  /// Parts of the light of samples of kind_lit, each times its strength, in place of their colour;
  /// may be null.
  const light::LitTile* lit;
  float lit_sun, lit_open_sun, lit_around;
  int x, y;  ///< lower left corner of the tile
  unsigned*
      out;    ///< of that corner; sRGB and alpha, red lowest; whole rows of the tile are written
  int pitch;  ///< samples from one row to the next
  /// Output of linear light before the tone mapping, and of cover, instead of sRGB: corner and
  /// pitch are those of `out`; null: sRGB.
  float *linear[3], *cover;
};

}  // namespace neve::render::cpu
