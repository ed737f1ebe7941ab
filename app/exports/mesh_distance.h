#pragma once
/// Signed distances around a closed mesh, as a level set.

#include "app/exports/columns.h"
#include "app/exports/vdb_file.h"

namespace neve::app::exports {

/// Voxels on either side of the mesh that have their distance; others have the background.
inline constexpr int band_voxels = 3;

/// Exact distances to the triangles, negative inside, by voxels of this size.
/// @param mesh  closed, its triangles not much larger than a voxel
VdbGrid distance_grid(const std::vector<double>& places, const MeshRows& mesh, double voxel);

}  // namespace neve::app::exports
