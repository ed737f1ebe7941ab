/// The drawing kernels for AVX2 (x86-64-v3).

#include "render/draw_kernels.h"
#include "render/ground_kernel.h"
#include "render/shade_kernel.h"
#include "render/smoke_kernel.h"
#include "render/splat_kernel.h"

namespace neve::render {
namespace {

using V = Lanes<float, 8>;

void project(const ProjectJob& job) {
  project_discs<V>(job);
}
void splat_tile(const TileJob& job) {
  draw_tile_lanes<V>(job);
}
void ground_tile(const GroundJob& job, GBufferTile& tile, int x, int y) {
  ground_tile_lanes<V>(job, tile, x, y);
}
void solid_tile(const SolidJob& job, GBufferTile& tile) {
  solid_tile_lanes<V>(job, tile);
}
void march(const SmokeJob& job) {
  march_rays<V>(job);
}
void shade_tile(const ShadeJob& job) {
  shade_tile_lanes<V>(job);
}

}  // namespace

const DrawKernels draw_avx2 = {"avx2",     project, splat_tile, ground_tile,
                               solid_tile, march,   shade_tile};

}  // namespace neve::render
