#pragma once
/// Light on a place of a body of snow, for one sample of the picture.

#include <array>
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
  std::uint32_t block = surface::no_block;  ///< of the field; no_block: far from any
  Vec3f node;                               ///< place in nodes from the corner of the block
  float sample_size = 1;                    ///< m, of a sample of the picture there
};

/// Outward normal of the field, unit.
Vec3f normal_at(const surface::Field& field, std::uint32_t block, Vec3f node);

/// The field from a block to as far as near shadows reach, in one piece: quick to read often.
class NearField {
 public:
  void take(const surface::Field& field, std::uint32_t block);
  /// As share_at. @param node  -6.5 to 13.5 along each axis
  float share(Vec3f node) const;
  /// The way shares fall around a node, over a few particle spacings: without the bumps of single
  /// particles. Not a unit.
  Vec3f even_fall(Vec3i node) const;

 private:
  static constexpr int margin = 7, side = surface::block_side + 2 * margin;
  std::array<float, side * side * side> value_;
};

/// @param normal  unit, outward
Exposure expose(const Body& body, const light::LightVolume& volume, const SnowLight& light,
                const SnowPlace& place, Vec3f normal);
/// The same bits. @param near  of the block of the place
Exposure expose(const NearField& near, const light::LightVolume& volume, const SnowLight& light,
                const SnowPlace& place, Vec3f normal);

/// Colour, and relief in the frame of the grain.
struct GrainLook {
  Vec3f albedo{1, 1, 1};  ///< linear
  Vec3f slope;            ///< of the relief, in spacings per spacing
  float height = 0;       ///< about -1 to 1
  Vec3f facet;            ///< unit, of a crystal that may mirror the sun; 0: too small to be seen
};

/// The look of a grain at a place. @param pixels  samples per spacing @param wants_facet  or leaves
/// it
GrainLook look_of_grain(const Body& body, Vec3f world, float pixels, bool wants_facet,
                        std::uint32_t grain);

/// Part of the look of the second grain: half of it where both are equally near.
/// @param spacing  m
float part_of_second(float first_squared, float second_squared, float spacing);

/// Samples per spacing below which nothing sparkles; see snow_light_kernel.h.
inline constexpr float least_sparkling = 2;

}  // namespace neve::render::snow
