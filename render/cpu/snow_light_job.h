#pragma once
/// Data of the kernel that lights samples of snow: plain data, as splat_job.h.

#include "sim/base/vec.h"

namespace neve::render::cpu {

/// Arrays have a number for each sample, and are written and read in whole vectors of up to
/// max_light_lanes.
inline constexpr int max_light_lanes = 16;

struct SnowLightJob {
  int count;
  Vec3f toward;                                ///< unit, to the light
  float key, ambient;                          ///< intensities
  int is_value;                                ///< colours show values: less contrast
  float spacing;                               ///< m, of packed particles
  const float* ray[3];                         ///< from the eye
  const float* sample_size;                    ///< m
  const float* normal[3];                      ///< along it; the kernel makes it a unit
  const float *sun, *sky, *crevice, *through;  ///< see snow::Exposure
  const float* albedo[3];                      ///< linear
  const float *slope[3], *height;              ///< of the relief of grains
  const float* facet[3];                       ///< unit, of a crystal; 0: none
  float* unit_normal[3];                       ///< out
  unsigned* word;        ///< out: finished light as the G-buffer has it, see light::kind_lit
  int wants_parts;       ///< or leaves what follows
  float* lit_sun[3];     ///< out: linear light of the sun, on the surface and through the snow
  float* open_sun[3];    ///< out: as if nothing were in its way to the surface
  float* lit_around[3];  ///< out: of the sky, and from inside the snow
};

}  // namespace neve::render::cpu
