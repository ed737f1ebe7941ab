#pragma once
/// The blocks of a lattice that a solid reaches, so that samplers skip the others.

#include <array>
#include <cstdint>
#include <vector>

#include "sim/shapes/solid.h"

namespace neve::sim::seeding {

/// Cubes of block_cells^3 lattice cells.
struct LatticeBlock {
  std::array<std::int64_t, 3> first_cell;
  bool is_full;  ///< every point of it is inside the solid
};
inline constexpr int block_cells = 4;

/// @throws ShapeError when the solid's bounds hold more blocks than can be looked at
void require_few_blocks(const shapes::Solid& solid, const Vec3d& origin, double spacing);

/// All blocks that may hold points inside, x fastest. Cell i spans from origin + i * spacing to
/// origin + (i+1) * spacing.
/// @throws ShapeError as require_few_blocks
std::vector<LatticeBlock> blocks_in(const shapes::Solid& solid, const Vec3d& origin,
                                    double spacing);

}  // namespace neve::sim::seeding
