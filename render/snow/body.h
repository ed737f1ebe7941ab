#pragma once
/// Snow as the surface layer sees it: the field of the exported mesh (surface/field.h), the blocks
/// that its surface passes through, and the grains near each place.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/cpu/block_job.h"
#include "render/cpu/grain_look_job.h"
#include "render/cpu/near_job.h"
#include "render/frame/frame.h"
#include "render/surface/block_map.h"
#include "render/surface/field.h"

namespace neve::render::snow {

using cpu::cubes_per_block;
using cpu::padded_nodes;
using cpu::padded_side;

/// Kernels read whole vectors beyond the end of a list.
inline constexpr std::size_t grain_margin = 16;

/// Particles in the order of their cubes.
struct GrainList {
  std::vector<std::uint32_t> first;  ///< of each cube of each block, and the end
  std::vector<cpu::Grain> grain;
  std::array<std::vector<float>, 3> along;  ///< their positions by axis, longer by grain_margin
};

/// Cells of a block: the first and the last one along each axis.
struct CellBox {
  Vec3i low{7, 7, 7}, high{0, 0, 0};
};

struct Body {
  surface::BlockMap map;                 ///< numbers of the blocks of the field
  surface::Field field;                  ///< share of each place that snow fills
  float spacing = 0.01f;                 ///< m, of packed particles
  std::vector<std::uint32_t> padded_of;  ///< for each block its number in padded_block, or no_block
  std::vector<std::uint32_t> padded_block;  ///< blocks that the surface passes through
  std::vector<CellBox> surface_box;         ///< of each of them, the cells that it passes through
  std::vector<float> padded;                ///< padded_nodes for each of them, x fastest
  GrainList grains;
  Points spray;  ///< particles that the surface does not cover
};

/// Share at which the surface lies.
inline constexpr float surface_share = 0.5f;

/// Makes the body of the points, with the same bits at any number of threads.
/// @param grounds  snow that lies on them ends there, without a rounded lower edge
/// @param pool may be null
/// Check: SnowBody.*
Body make_body(const Points& shown, std::span<const GroundPlane> grounds, ThreadPool* pool);

/// A place of the field: block, and nodes from its corner, 0 to 8 along each axis.
struct FieldPlace {
  std::uint32_t block = surface::no_block;  ///< no_block: outside of the field
  Vec3f node;
};
FieldPlace find_place(const Body& body, Vec3f world);

/// Returns a place in nodes from the corner of its block.
NEVE_INLINE Vec3f node_in_block(const surface::NodePlace& place) {
  const auto along = [](int node, float rest) {
    return static_cast<float>(node & 7) + std::min(rest, 0.9999f);
  };
  return {along(place.node.x, place.rest.x), along(place.node.y, place.rest.y),
          along(place.node.z, place.rest.z)};
}

/// Value of the field at a place.
/// @param place in nodes from the corner of block b, -7 to 14 along each axis
float share_at(const surface::Field& field, std::uint32_t b, Vec3f place);

}  // namespace neve::render::snow
