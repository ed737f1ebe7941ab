#pragma once
/// Draws spheres into a G-buffer on the CPU: the same picture as ParticlePass, several times faster
/// where OpenGL runs on the CPU too. Depends neither on the number of threads nor on the
/// instruction set; among equals in depth the nearer centre wins, then the lower id.

#include <cstdint>
#include <functional>
#include <vector>

#include "render/frame.h"
#include "render/splat_job.h"
#include "render/view.h"
#include "sim/base/thread_pool.h"

namespace neve::render {

/// Part of the G-buffer (shaders/gbuffer.glsl): a rectangle of samples, rows from the bottom up.
struct SplatBand {
  int x = 0, y = 0, width = 0, height = 0;  ///< samples of the picture
  int pitch = 0;                            ///< samples from one row to the next
  const float* depth = nullptr;
  const std::uint16_t* normal_kind = nullptr;  ///< four half floats each
  const std::uint32_t* albedo = nullptr;       ///< four bytes each
};

/// The fastest kernels that this machine can run; NEVE_SIMD=baseline takes the plain ones.
const SplatKernels& chosen_splat_kernels();

class Splatter {
 public:
  explicit Splatter(const SplatKernels& kernels = chosen_splat_kernels()) : kernels_(kernels) {}

  /// Hands out what the points cover, band after band; nothing lies outside the bands. The memory
  /// of a band is used again for the next.
  /// @param pool may be null
  void draw(const Points& points, const View& view, ThreadPool* pool,
            const std::function<void(const SplatBand&)>& receive);

 private:
  void project(const Points& points, const SplatView& view, ThreadPool* pool);
  void fill_bins(ThreadPool* pool);
  void sort_bin(int tile);
  SplatBand draw_band(int first_row, int last_row, ThreadPool* pool, unsigned kind);

  const SplatKernels& kernels_;
  SplatView view_{};
  int columns_ = 0, rows_ = 0, part_count_ = 1;  ///< tiles; parts of the points
  int first_column_ = 0, last_column_ = -1, first_row_ = 0, last_row_ = -1;  ///< with discs
  std::vector<SplatDisc> discs_;
  std::vector<int> part_counts_;  ///< discs of each part in each tile, then where they go
  std::vector<int> bin_start_;    ///< first of each tile in list_, one more at the end
  std::vector<int> list_, sorted_;
  std::vector<float> depth_;
  std::vector<std::uint16_t> normal_kind_;
  std::vector<std::uint32_t> albedo_;
};

}  // namespace neve::render
