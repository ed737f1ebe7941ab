#pragma once
/// Smooth edges in pictures that have one sample for each pixel.

#include <cstdint>
#include <vector>

#include "sim/base/thread_pool.h"

namespace neve::render {

/// Smooths edges between neighbours that differ by more than snow's grain does. An edge is followed
/// to its ends, and the pixel takes from the other side what a straight edge would cover. The same
/// as shaders/smooth.frag, which is quick on graphics hardware alone. Source: Lottes, FXAA, 2009.
class SmoothEdges {
 public:
  /// @param picture  RGBA, `pitch` pixels from row to row
  /// @return the same with smooth edges, `width` pixels from row to row; until the next call
  const std::uint32_t* of(const std::uint32_t* picture, int pitch, int width, int height,
                          ThreadPool* pool);

 private:
  std::vector<std::uint8_t> brightness_;
  std::vector<std::uint32_t> smooth_;
};

}  // namespace neve::render
