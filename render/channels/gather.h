#pragma once
/// Fills the planes of a picture from surfaces that were drawn on the CPU.

#include "render/channels/planes.h"
#include "render/cpu/surfaces.h"
#include "render/frame/view.h"
#include "render/light/lighting.h"
#include "sim/base/thread_pool.h"

namespace neve::render::channels {

/// Surfaces of a frame with the light on them.
struct LitSurfaces {
  const Frame& frame;
  const cpu::Surfaces& surfaces;  ///< whose tiles are kept
  const light::LightVolume& light;
  const light::SmokeCover* smoke;  ///< null if there is none
};

/// The same volume with the key light and the sky as if nothing were in their way.
light::LightVolume without_shadow(const light::LightVolume& light);

/// Adds the light of one moment to the planes, with a weight; planes are made where they are empty.
void add_light(const LitSurfaces& lit, const Request& request, float weight, LightPlanes& out);

/// Reads the surfaces of the nearest sample of each pixel.
/// @param meshes  number of the mesh in each sample, in three bytes of its albedo; null: no meshes
/// @param pool may be null
DataPlanes gather_data(const LitSurfaces& lit, const Request& request, const View& view,
                       const cpu::SolidSamples* meshes, ThreadPool* pool);

}  // namespace neve::render::channels
