#include "render/cpu/draw_kernels.h"

#include <cstdlib>
#include <string_view>

#include "sim/base/cpu.h"

namespace neve::render::cpu {

const DrawKernels& chosen_draw_kernels() {
#ifdef NEVE_X86_DRAW
  const char* wanted = std::getenv("NEVE_SIMD");
  if (runs_x86_64_v3() && !(wanted && std::string_view(wanted) == "baseline")) return draw_avx2;
#endif
  return draw_baseline;
}

}  // namespace neve::render::cpu
