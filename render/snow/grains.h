#pragma once
/// Grains of the surface: the particles that are grains, those that are buried, and the spray.

#include "render/snow/body.h"

namespace neve::render::snow {

/// The field at each particle, and the place of its grain.
struct GrainPlaces {
  std::vector<float> share;         ///< of the field at the particle
  std::vector<std::uint32_t> cube;  ///< of its grain; no_block: off the field, or buried
};

/// @param made  with the particles by blocks, their mirror images behind them; its field is that of
///              the body
GrainPlaces place_grains(const Points& points, const surface::GrainField& made, const Body& body,
                         ThreadPool* pool);

/// Sorts the grains into their cubes.
void list_grains(const Points& points, const GrainPlaces& places, ThreadPool* pool, Body& body);

/// Makes lumps, the spray of the body, of the particles that the surface does not cover.
/// @param count  points that are not cut away
void take_spray(const Points& points, std::size_t count, const GrainPlaces& places, Body& body);

}  // namespace neve::render::snow
