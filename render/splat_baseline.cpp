/// The splatter's kernels for the baseline instruction set.

#include "render/splat_kernel.h"

namespace neve::render {
namespace {

using V = Lanes<float, 4>;

void project(const ProjectJob& job) {
  project_discs<V>(job);
}
void draw_tile(const TileJob& job) {
  draw_tile_lanes<V>(job);
}

}  // namespace

const SplatKernels splat_baseline = {"baseline", project, draw_tile};

}  // namespace neve::render
