#pragma once
/// A field of cells by the two colours of a chess board.

#include <array>
#include <cstddef>
#include <vector>

#include "sim/dust/air_box.h"

namespace neve::sim::dust {

/// Cells of one colour lie next to each other in a row, so that one colour is worked out from the
/// other in lanes, and no thread reads what another one writes. A pad of zeros lies around.
class ChessField {
 public:
  void assign(const AirBox& box) {
    const auto nx = static_cast<std::size_t>(box.size.x());
    rows_ = static_cast<std::size_t>(box.size.y() + 1);
    length_ = (nx + 1) / 2 + 2;
    const std::size_t count =
        box.is_empty() ? 0 : length_ * rows_ * static_cast<std::size_t>(box.size.z() + 2);
    for (std::vector<float>& half : halves_) half.assign(count, 0);
  }
  void clear() {
    for (std::vector<float>& half : halves_) half.assign(half.size(), 0);
  }
  /// Cells i = 2 m + (j + k + color) & 1 of a row, from m = 0 on. j and k from -1 to the size.
  float* row(int color, int j, int k) {
    return halves_[static_cast<std::size_t>(color)].data() + place(j, k);
  }
  const float* row(int color, int j, int k) const {
    return halves_[static_cast<std::size_t>(color)].data() + place(j, k);
  }
  /// Returns the value of a cell, and 0 a cell beside the box.
  float at(int i, int j, int k) const { return row((i + j + k) & 1, j, k)[i >> 1]; }
  float& at(int i, int j, int k) { return row((i + j + k) & 1, j, k)[i >> 1]; }
  std::size_t memory_bytes() const {
    return sizeof(float) * (halves_[0].capacity() + halves_[1].capacity());
  }

 private:
  std::ptrdiff_t place(int j, int k) const {
    const std::ptrdiff_t row = (k + 1) * static_cast<std::ptrdiff_t>(rows_) + j;
    return row * static_cast<std::ptrdiff_t>(length_) + 1;
  }
  std::size_t rows_ = 0, length_ = 0;  ///< of a slab; of a row of one colour, with its pad
  std::array<std::vector<float>, 2> halves_;
};

}  // namespace neve::sim::dust
