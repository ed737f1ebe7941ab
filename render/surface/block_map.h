#pragma once
/// Numbers for cubes of space, in the order in which they were first asked for.

#include <bit>
#include <cstdint>
#include <vector>

#include "sim/base/hash.h"
#include "sim/base/vec.h"

namespace neve::render::surface {

inline constexpr std::uint32_t no_block = 0xffffffffu;

/// A place with coordinates of 21 bits; keys are in the order of z, then y, then x.
using BlockKey = std::uint64_t;

constexpr BlockKey block_key(Vec3i b) {
  const auto bits = [](int c) { return static_cast<BlockKey>(c + (1 << 20)); };
  return bits(b.z) << 42 | bits(b.y) << 21 | bits(b.x);
}
constexpr Vec3i block_place(BlockKey key) {
  const auto coordinate = [](BlockKey bits) {
    return static_cast<int>(bits & 0x1fffff) - (1 << 20);
  };
  return {coordinate(key), coordinate(key >> 21), coordinate(key >> 42)};
}

class BlockMap {
 public:
  explicit BlockMap(std::size_t expected = 0) { grow(2 * expected + 64); }

  std::size_t size() const { return keys_.size(); }
  const std::vector<BlockKey>& keys() const { return keys_; }

  std::uint32_t find(BlockKey key) const {
    for (std::size_t slot = start(key);; slot = next(slot)) {
      if (number_[slot] == no_block || keys_[number_[slot]] == key) return number_[slot];
    }
  }

  /// @return the number of the block, a new one where it was not there
  std::uint32_t insert(BlockKey key) {
    std::size_t slot = start(key);
    for (; number_[slot] != no_block; slot = next(slot))
      if (keys_[number_[slot]] == key) return number_[slot];
    const auto number = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(key);
    number_[slot] = number;
    if (2 * keys_.size() > number_.size()) grow(4 * keys_.size());
    return number;
  }

 private:
  std::size_t start(BlockKey key) const {
    return static_cast<std::size_t>(mix64(key)) & (number_.size() - 1);
  }
  std::size_t next(std::size_t slot) const { return (slot + 1) & (number_.size() - 1); }

  void grow(std::size_t slots) {
    number_.assign(std::bit_ceil(slots), no_block);
    for (std::size_t k = 0; k < keys_.size(); ++k) {
      std::size_t slot = start(keys_[k]);
      while (number_[slot] != no_block) slot = next(slot);
      number_[slot] = static_cast<std::uint32_t>(k);
    }
  }

  std::vector<BlockKey> keys_;
  std::vector<std::uint32_t> number_;
};

}  // namespace neve::render::surface
