#pragma once
/// Light on a place of a body of snow, for one sample of the picture.

#include <cstdint>

#include "render/light/lighting.h"
#include "render/snow/body.h"

namespace neve::render::snow {

struct SnowLight {
  Vec3f toward;        ///< unit
  float key, ambient;  ///< intensities
  bool is_value;       ///< colours show values: less contrast
};

/// Light that reaches a place from far and near, and the way its surface faces. All fields change
/// slowly along a surface.
struct alignas(16) Exposure {
  Vec3f normal{0, 1, 0};  ///< outward, without relief
  float sun = 1;          ///< part of the key light that arrives
  float sky = 1;          ///< part of the sky that far snow and solids leave
  float crevice = 1;      ///< part of it that near snow leaves
  float through = 1;      ///< key light inside, just below the surface
  float unused = 0;       ///< as wide as two vectors of four
};

/// A place of the surface, or on a grain of spray.
struct SnowPlace {
  Vec3f world;                              ///< m
  Vec3f toward_eye;                         ///< unit
  std::uint32_t block = surface::no_block;  ///< of the field; no_block: far from any
  Vec3f node;                               ///< place in nodes from the corner of the block
  float sample_size = 1;                    ///< m, of a sample of the picture there
};

/// Outward normal of the field, unit.
Vec3f normal_at(const surface::Field& field, std::uint32_t block, Vec3f node);

/// @param normal  unit, outward
Exposure expose(const Body& body, const light::LightVolume& volume, const SnowLight& light,
                const SnowPlace& place, Vec3f normal);

/// Nearest grains: colour, and relief in the frame of the grain.
struct GrainLook {
  Vec3f albedo{1, 1, 1};   ///< linear
  Vec3f slope;             ///< of the relief, in spacings per spacing
  float height = 0;        ///< about -1 to 1
  std::uint32_t seed = 0;  ///< of the nearest grain
  Vec3f offset;            ///< from there, in spacings
};

/// @param place  with a block
GrainLook grain_look(const Body& body, const SnowPlace& place);

/// Linear light towards the eye.
struct SnowLightParts {
  Vec3f sun;       ///< of the key light, on the surface and through the snow
  Vec3f open_sun;  ///< as if nothing were in its way to the surface
  Vec3f around;    ///< of the sky, and from inside the snow
};
SnowLightParts snow_light(const Body& body, const SnowLight& light, const SnowPlace& place,
                          const Exposure& exposure, const GrainLook& grain);

}  // namespace neve::render::snow
