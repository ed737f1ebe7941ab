#pragma once
/// Numbers of particles, sorted into bins.

#include <cstdint>
#include <vector>

#include "render/surface/block_map.h"
#include "render/surface/loops.h"

namespace neve::render::surface {

struct Bins {
  std::vector<std::uint32_t> first;  ///< for each bin, and the end
  std::vector<std::uint32_t> grain;  ///< in ascending order in each bin
};

/// Each thread fills bins of its own, so the result depends on none.
/// @param bin_of  bin of each particle; no_block leaves it out @param pool may be null
inline Bins sorted_into_bins(const std::vector<std::uint32_t>& bin_of, std::size_t count,
                             ThreadPool* pool = nullptr) {
  Bins bins;
  bins.first.assign(count + 1, 0);
  const int parts = pool ? pool->thread_count() : 1;
  // use(first bin, end) for the bins of each part
  const auto for_own_bins = [&](const auto& use) {
    const auto run = [&](int part) {
      const auto end_of = [&](int n) {
        return static_cast<std::uint32_t>(count * static_cast<std::size_t>(n) /
                                          static_cast<std::size_t>(parts));
      };
      use(end_of(part), end_of(part + 1));
    };
    if (pool)
      pool->run(parts, parts, run);
    else
      run(0);
  };
  for_own_bins([&](std::uint32_t begin, std::uint32_t end) {
    for (const std::uint32_t bin : bin_of)
      if (bin - begin < end - begin) ++bins.first[bin + 1];
  });
  for (std::size_t bin = 0; bin < count; ++bin) bins.first[bin + 1] += bins.first[bin];
  bins.grain.resize(bins.first.back());
  for_own_bins([&](std::uint32_t begin, std::uint32_t end) {
    std::vector<std::uint32_t> next(bins.first.data() + begin, bins.first.data() + end);
    for (std::size_t p = 0; p < bin_of.size(); ++p)
      if (const std::uint32_t bin = bin_of[p] - begin; bin < end - begin)
        bins.grain[next[bin]++] = static_cast<std::uint32_t>(p);
  });
  return bins;
}

}  // namespace neve::render::surface
