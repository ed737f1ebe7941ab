/// The splatter's kernels for AVX2 (x86-64-v3).

#include "render/splat_kernel.h"

namespace neve::render {
namespace {

using V = Lanes<float, 8>;

void project(const ProjectJob& job) {
  project_discs<V>(job);
}
void draw_tile(const TileJob& job) {
  draw_tile_lanes<V>(job);
}

}  // namespace

const SplatKernels splat_avx2 = {"avx2", project, draw_tile};

}  // namespace neve::render
