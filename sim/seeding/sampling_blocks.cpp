#include "sim/seeding/sampling_blocks.h"

#include <cmath>

namespace neve::sim::seeding {
namespace {

// About ten seconds of looking. A solid that fills less than a ten-thousandth of its bounds at two
// million particles comes here; such needles and sheets are better built of several bodies.
constexpr double max_blocks = 1e9;

// Far beyond it a double no longer tells the points of a cell apart.
constexpr double max_block_index = 1e12;

/// The blocks that bounds reach, along each axis: the lowest and how many.
struct BlockRange {
  Vec3d low, count;
};

BlockRange range_of(const shapes::Solid& solid, const Vec3d& origin, double spacing) {
  const shapes::Bounds bounds = solid.local_bounds();
  const double edge = spacing * block_cells;
  const Vec3d low = ((bounds.min - origin) / edge).array().floor();
  const Vec3d count = ((bounds.max - origin) / edge).array().floor() - low.array() + 1;
  if (!(count.prod() < max_blocks))
    throw ShapeError("the shape is too thin for its length to be filled with particles");
  if (!(low.cwiseAbs().maxCoeff() < max_block_index))
    throw ShapeError("the mesh is too far from its file's origin to be filled with particles");
  return {low, count};
}

}  // namespace

void require_few_blocks(const shapes::Solid& solid, const Vec3d& origin, double spacing) {
  range_of(solid, origin, spacing);
}

std::vector<LatticeBlock> blocks_in(const shapes::Solid& solid, const Vec3d& origin,
                                    double spacing) {
  const double edge = spacing * block_cells;
  const auto [low, count] = range_of(solid, origin, spacing);
  const double reach = 0.5 * std::sqrt(3.0) * edge * (1 + 1e-9);  // of a block from its middle
  std::vector<LatticeBlock> blocks;
  for (double z = 0; z < count.z(); ++z)
    for (double y = 0; y < count.y(); ++y)
      for (double x = 0; x < count.x(); ++x) {
        const Vec3d corner = low + Vec3d(x, y, z);
        const double clearance = solid.clearance(origin + edge * (corner + Vec3d::Constant(0.5)));
        if (clearance > reach) continue;
        LatticeBlock block{{}, clearance < -reach};
        for (std::size_t a = 0; a < 3; ++a)
          block.first_cell[a] =
              static_cast<std::int64_t>(corner[static_cast<Eigen::Index>(a)]) * block_cells;
        blocks.push_back(block);
      }
  return blocks;
}

}  // namespace neve::sim::seeding
