/// The drawing kernels for AVX2 (x86-64-v3).

#include "render/draw_kernel_table.h"

namespace neve::render {

constinit const DrawKernels draw_avx2 = draw_kernel_table<Lanes<float, 8>>("avx2");

}  // namespace neve::render
