#pragma once
/// Attributes of particles on the vertices of a surface.

#include "render/surface/field.h"

namespace neve::render::surface {

/// The particles around each vertex, the nearest first, and their shares, which sum to 1.
struct Shares {
  std::vector<std::uint32_t> first;  ///< for each vertex, and the end
  std::vector<std::uint32_t> grain;
  std::vector<float> share;  ///< > 0
};

/// Distance from a vertex at which particles have no weight, over the width of the kernel.
inline constexpr float attribute_reach = 2;

/// Weights fall smoothly to 0 at a distance; a vertex without particles that near has its nearest.
/// @param left_out particles, ascending; at least one other exists @param pool may be null
Shares shares_of(std::span<const Vec3f> vertices, const Grains& grains,
                 std::span<const std::uint32_t> left_out, float distance, ThreadPool* pool);

}  // namespace neve::render::surface
