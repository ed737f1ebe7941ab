/// The drawing kernels for AVX2 (x86-64-v3).

#include "render/cpu/draw_kernel_table.h"

namespace neve::render::cpu {

constinit const DrawKernels draw_avx2 = draw_kernel_table<Lanes<float, 8>>("avx2");

}  // namespace neve::render::cpu
