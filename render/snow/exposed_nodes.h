#pragma once
/// Exposures on the nodes around the seen part of the surface: samples of a picture interpolate
/// them, since there are more of these, and since they stay while a camera turns.

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/snow/shading.h"

namespace neve::render::snow {

/// A place between eight of them.
struct ExposedCell {
  const Exposure* corner;  ///< the first one
  int row, slice;          ///< from one row, and from one slice, to the next
  Vec3f part;              ///< of the way through the cell, 0 to 1
};

class ExposedNodes {
 public:
  explicit ExposedNodes(const Body& body);

  /// Asks for the corners of the cell around a place that the surface passes through. Several
  /// threads may ask at once.
  /// @param padded  number of a block in padded_block
  void want(std::uint32_t padded, Vec3f node);
  /// Makes those that were asked for and are not there. Same bits with any number of threads.
  /// @param body  that of the constructor @param pool may be null
  void expose_wanted(const Body& body, const light::LightVolume& volume, const SnowLight& light,
                     ThreadPool* pool);
  /// @param node  in a cell that was asked for
  NEVE_INLINE ExposedCell cell_at(std::uint32_t padded, Vec3f node) const;
  /// The same, interpolated. @return its normal is no unit
  Exposure at(std::uint32_t padded, Vec3f node) const;

 private:
  /// Bit 8 j + i of slice k.
  using CellBits = std::array<std::uint64_t, 8>;
  struct Block {
    std::size_t first;  ///< in nodes_
    CellBox box;
    int row, slice;  ///< nodes from one row, and from one slice, to the next
    CellBits wanted{}, exposed{};
  };
  struct NewNodes;
  static NEVE_INLINE Vec3i cell_of(const Block& block, Vec3f node);
  void expose_block(std::uint32_t padded, const Body& body, const light::LightVolume& volume,
                    const SnowLight& light, NewNodes& nodes);

  std::vector<Block> blocks_;
  std::unique_ptr<Exposure[]> nodes_;
};

Vec3i ExposedNodes::cell_of(const Block& block, Vec3f node) {
  const auto cell = [](float x, int low, int high) {
    return std::min(std::max(static_cast<int>(x), low), high);
  };
  const CellBox& box = block.box;
  return {cell(node.x, box.low.x, box.high.x), cell(node.y, box.low.y, box.high.y),
          cell(node.z, box.low.z, box.high.z)};
}

ExposedCell ExposedNodes::cell_at(std::uint32_t padded, Vec3f node) const {
  const Block& block = blocks_[padded];
  const Vec3i cell = cell_of(block, node), from = cell - block.box.low;
  const auto part = [](float x, int low) {
    return std::clamp(x - static_cast<float>(low), 0.0f, 1.0f);
  };
  return {nodes_.get() + block.first + (from.z * block.slice + from.y * block.row + from.x),
          block.row,
          block.slice,
          {part(node.x, cell.x), part(node.y, cell.y), part(node.z, cell.z)}};
}

}  // namespace neve::render::snow
