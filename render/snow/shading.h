#pragma once
/// Light on a place of a body of snow, for one sample of the picture.

#include <array>
#include <cstdint>

#include "render/cpu/near_light_job.h"
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
  float sample_size = 1;  ///< m, of a sample of the picture there, for the detail of grain
};

/// Outward normal of the field, unit.
Vec3f normal_at(const surface::Field& field, std::uint32_t block, Vec3f node);

/// The field from a block to as far as near shadows reach, in one piece: quick to read often.
class NearField {
 public:
  void take(const surface::Field& field, std::uint32_t block);
  const float* values() const { return value_.data(); }
  /// The way shares fall around a node, over a few particle spacings: without the bumps of single
  /// particles. Not a unit.
  Vec3f even_fall(Vec3i node) const;

 private:
  std::array<float, cpu::near_nodes> value_;
};

/// Snow within a few nodes leaves this of the light; see near_light_job.h.
struct NearLight {
  float before_sun, within, open_sky;
};

/// @param normal  unit, outward
Exposure expose(const light::LightVolume& volume, const SnowLight& light, const SnowPlace& place,
                Vec3f normal, const NearLight& near);
/// The same, with what near snow leaves as the kernel finds it.
Exposure expose(const Body& body, const light::LightVolume& volume, const SnowLight& light,
                const SnowPlace& place, Vec3f normal);

}  // namespace neve::render::snow
