/// The drawing kernels for the baseline instruction set.

#include "render/cpu/draw_kernel_table.h"

namespace neve::render::cpu {

constinit const DrawKernels draw_baseline = draw_kernel_table<Lanes<float, 4>>("baseline");

}  // namespace neve::render::cpu
