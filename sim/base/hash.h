#pragma once
/// Integer hashing: random numbers keyed by their purpose, and order-free state hashes.

#include <cstdint>

#include "sim/base/mix64.h"

namespace neve {

/// Hash of two numbers, order matters.
constexpr std::uint64_t mix64(std::uint64_t a, std::uint64_t b) {
  return mix64(mix64(a) ^ b);
}

/// Returns a uniform number in [0, 1) with 53 bits, from a hash.
constexpr double unit_double(std::uint64_t hash) {
  return static_cast<double>(hash >> 11) * 0x1.0p-53;
}

/// FNV-1a over bytes, for file contents.
inline std::uint64_t hash_bytes(const void* data, std::size_t size,
                                std::uint64_t hash = 0xcbf29ce484222325ull) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t k = 0; k < size; ++k) hash = (hash ^ bytes[k]) * 0x100000001b3ull;
  return hash;
}

}  // namespace neve
