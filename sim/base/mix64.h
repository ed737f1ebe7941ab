#pragma once
/// The mixer of integer hashes, without standard headers: kernels draw random numbers too.

#include "sim/base/scalar.h"

namespace neve {

/// Bijective 64-bit mixer. Source: finalizer of SplitMix64 (Steele, Lea, Flood 2014).
NEVE_INLINE constexpr __UINT64_TYPE__ mix64(__UINT64_TYPE__ x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

}  // namespace neve
