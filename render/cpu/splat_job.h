#pragma once
/// Data of the CPU splatter's kernels: plain data, so that a file compiled for another instruction
/// set shares no inline function with the rest of the program.
///
/// Places on the picture are in samples, y up. Slopes are samples / pixels_per_slope, so that the
/// ray of slope s is (s.x, s.y, 1) in the axes of the view, with length 1 along it.

#include "render/light/gbuffer_tile.h"
#include "sim/base/vec.h"

namespace neve::render::cpu {

/// A sphere on the picture. One that is not seen has x_low > x_high.
struct SplatDisc {
  float x, y;      ///< where its centre appears
  float ratio;     ///< radius over the distance z of the centre along the view
  float scale;     ///< 1 / (z (1 + slope^2 - ratio^2)), 1/m; see splat_kernel.h
  float nearest;   ///< 1/m, no point of it has a larger inverse distance along the view
  unsigned color;  ///< albedo as the G-buffer has it
  unsigned short x_low, x_high, y_low, y_high;  ///< samples that it may touch, ends included
};

struct SplatView {
  Vec3f eye, right, up, forward;
  float pixels_per_slope;
  float near_distance;  ///< m
  int width, height;    ///< samples
  float radius;         ///< m
  float min_ratio;      ///< of radius and distance: smaller spheres are drawn as if they had this
};

/// Turns points into discs; colours are left as they are.
struct ProjectJob {
  SplatView view;
  const Vec3f* position;
  const unsigned* order;  ///< point of each disc; null: the same index
  SplatDisc* discs;
  int begin, end;  ///< of the discs
};

/// Draws discs, nearest first, into one tile of the G-buffer.
struct TileJob {
  SplatView view;
  const SplatDisc* discs;
  const int* list;  ///< indices of discs, nearest first
  int count;
  int x, y;                 ///< lower left sample of the tile
  int kind;                 ///< of surface (gbuffer_tile.h)
  light::GBufferTile* out;  ///< where there is no disc, only `inverse` and `kind` are set
};

}  // namespace neve::render::cpu
