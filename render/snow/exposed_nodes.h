#pragma once
/// Exposures on the nodes around the seen part of the surface: samples of a picture interpolate
/// them, since there are more of these, and since they stay while a camera turns.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/snow/shading.h"

namespace neve::render::snow {

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
  /// @param node  in a cell that was asked for @return its normal is no unit
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
  static Vec3i cell_of(const Block& block, Vec3f node);
  void expose_block(std::uint32_t padded, const Body& body, const light::LightVolume& volume,
                    const SnowLight& light, NearField& near);

  std::vector<Block> blocks_;
  std::unique_ptr<Exposure[]> nodes_;
};

}  // namespace neve::render::snow
