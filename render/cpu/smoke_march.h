#pragma once
/// Marches through smoke on the CPU: the picture of SmokePass, where OpenGL runs on the CPU too and
/// is slower at it.

#include <memory>
#include <optional>

#include "render/cpu/surfaces.h"
#include "render/light/smoke_volume.h"

namespace neve::render::cpu {

class SmokeMarch {
 public:
  /// @param pool may be null
  explicit SmokeMarch(ThreadPool* pool, const DrawKernels& kernels = chosen_draw_kernels())
      : kernels_(kernels), pool_(pool) {}

  /// @param grid of `smoke`, not empty
  /// @param surfaces keeps its tiles: rays end there
  /// @return the smoke on the rays, valid until the next call; empty if no smoke is in view
  std::optional<light::SmokeCover> march(const Smoke& smoke, const light::SmokeGrid& grid,
                                         const light::SmokeVolume& volume, const Light& light,
                                         const Surfaces& surfaces, const View& view);

 private:
  void make_rays(int width, int height);
  const DrawKernels& kernels_;
  ThreadPool* pool_;
  std::size_t size_ = 0;
  std::unique_ptr<float[]> rays_;  ///< four sums and the depth, one after another
};

}  // namespace neve::render::cpu
