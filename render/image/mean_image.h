#pragma once
/// The mean of several pictures of one size.

#include <cstdint>
#include <vector>

#include "render/image/image.h"

namespace neve::render {

/// Adds pictures up. Colours are weighted by their alpha: what is transparent has none.
class MeanImage {
 public:
  /// @throws ImageError for a picture of another form than the first
  void add(const Image& image);
  /// Returns the rounded mean; equal pictures give themselves. @throws ImageError without a picture
  Image mean() const;

 private:
  Image form_;  ///< without pixels
  std::uint64_t count_ = 0;
  std::vector<std::uint32_t> sum_;  ///< of colours times alpha, where there is one
};

}  // namespace neve::render
