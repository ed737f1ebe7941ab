#pragma once
/// Draws spheres into a G-buffer on the CPU: the same picture as ParticlePass, several times faster
/// where OpenGL runs on the CPU too. Depends neither on the number of threads nor on the
/// instruction set; among equals in depth the nearer centre wins, then the lower id.

#include <cstdint>
#include <vector>

#include "render/cpu/draw_kernels.h"
#include "render/frame/frame.h"
#include "render/frame/view.h"
#include "render/light/shading_constants.h"
#include "sim/base/thread_pool.h"

namespace neve::render::cpu {

/// Content of a tile in place of a colour: the albedo of the point, or its index in the frame.
enum class Paint { albedo, index };

class Splatter {
 public:
  explicit Splatter(const DrawKernels& kernels = chosen_draw_kernels()) : kernels_(kernels) {}

  /// Finds out which points lie in which tile of the picture.
  /// @param pool may be null
  void prepare(const Points& points, const View& view, ThreadPool* pool,
               Paint paint = Paint::albedo);
  /// Tiles of the picture.
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Draws those of one tile; several threads may draw a tile each.
  /// @param out all of it is set @param tile row by row, from the lower left one
  void draw_tile(int tile, light::GBufferTile& out);

 private:
  void project(const Points& points, ThreadPool* pool, Paint paint);
  void fill_bins(ThreadPool* pool);
  void sort_bin(int tile);

  const DrawKernels& kernels_;
  SplatView view_{};
  int kind_ = light::kind_snow;
  int columns_ = 0, rows_ = 0, part_count_ = 1;  ///< tiles; parts of the points
  std::vector<SplatDisc> discs_;
  std::vector<int> part_counts_;  ///< discs of each part in each tile, then where they go
  std::vector<int> bin_start_;    ///< first of each tile in list_, one more at the end
  std::vector<int> list_, sorted_;
};

}  // namespace neve::render::cpu
