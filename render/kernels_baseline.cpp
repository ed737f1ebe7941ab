/// The drawing kernels for the baseline instruction set.

#include "render/draw_kernel_table.h"

namespace neve::render {

constinit const DrawKernels draw_baseline = draw_kernel_table<Lanes<float, 4>>("baseline");

}  // namespace neve::render
