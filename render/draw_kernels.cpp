#include "render/draw_kernels.h"

#include <cstdlib>
#include <string_view>

namespace neve::render {

const DrawKernels& chosen_draw_kernels() {
#ifdef NEVE_X86_DRAW
  const char* wanted = std::getenv("NEVE_SIMD");
  if (__builtin_cpu_supports("x86-64-v3") && !(wanted && std::string_view(wanted) == "baseline"))
    return draw_avx2;
#endif
  return draw_baseline;
}

}  // namespace neve::render
