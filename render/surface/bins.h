#pragma once
/// Numbers of particles, sorted into bins.

#include <cstdint>
#include <vector>

#include "render/surface/block_map.h"

namespace neve::render::surface {

struct Bins {
  std::vector<std::uint32_t> first;  ///< for each bin, and the end
  std::vector<std::uint32_t> grain;  ///< in ascending order in each bin
};

/// @param bin_of  bin of each particle; no_block leaves it out
inline Bins sorted_into_bins(const std::vector<std::uint32_t>& bin_of, std::size_t count) {
  Bins bins;
  bins.first.assign(count + 1, 0);
  for (const std::uint32_t bin : bin_of)
    if (bin != no_block) ++bins.first[bin + 1];
  for (std::size_t bin = 0; bin < count; ++bin) bins.first[bin + 1] += bins.first[bin];
  std::vector<std::uint32_t> next(bins.first.begin(), bins.first.end() - 1);
  bins.grain.resize(bins.first.back());
  for (std::size_t p = 0; p < bin_of.size(); ++p)
    if (bin_of[p] != no_block) bins.grain[next[bin_of[p]]++] = static_cast<std::uint32_t>(p);
  return bins;
}

}  // namespace neve::render::surface
