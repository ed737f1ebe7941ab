#pragma once
/// Bytewise comparison of inputs, for caches.

#include <cstring>
#include <vector>

namespace neve::render {

/// Bytes and not values: not-a-number is the same as itself, and 0 is not -0.
template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace neve::render
