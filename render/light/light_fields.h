#pragma once
/// The steps of make_light_volume, one scalar field over a LightGrid each.

#include <array>
#include <functional>
#include <vector>

#include "render/light/lighting.h"

namespace neve::render::light {

/// Finest cells of light in smoke: as fine as for points of which there are two per node and axis.
inline constexpr float smoke_spacings_per_cell = 0.8f;

/// Runs task(0) ... task(count - 1), on the pool where there is one.
void for_each_task(int count, ThreadPool* pool, const std::function<void(int)>& task);

/// Memory of the steps, kept from one volume to the next: allocating it again costs as much as a
/// step.
struct LightBuffers {
  std::vector<std::vector<std::uint32_t>> sums;
  std::vector<float> density, key, sky, smooth, blurred;
  std::array<std::vector<float>, 5> arriving;  ///< the key light, and the sky from four directions
};

/// Computes how full each cell is, into buffers.density: 1 for packed points and above, trilinear;
/// a stray point is far below 1.
void bin_points(const Points& points, const LightGrid& grid, ThreadPool* pool,
                LightBuffers& buffers);

/// Takes in the smoke: a cell is as full as the fuller of points and smoke, since both show the
/// same snow.
void add_smoke(const SmokeGrid& smoke, const LightGrid& grid, ThreadPool* pool,
               std::vector<float>& density);

/// Marks the cells that the surfaces of the meshes pass through with 1.
std::vector<float> voxelize(const std::vector<TriangleMesh>& meshes, const LightGrid& grid);

/// Two passes of a box of 3 cells along every axis, from buffers.density into buffers.smooth;
/// outside is empty.
void blur(const LightGrid& grid, ThreadPool* pool, LightBuffers& buffers);

/// Part of the light from a direction that reaches each cell through the others.
/// @param toward_light unit vector
/// @param extinction of one cell of full thickness (1/e is left at 1), per cell
/// @param light resized to the cells of the grid
void sweep_light(const std::vector<float>& extinction, const LightGrid& grid, Vec3f toward_light,
                 std::vector<float>& light);

}  // namespace neve::render::light
