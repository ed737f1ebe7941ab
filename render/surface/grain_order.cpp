#include "render/surface/grain_order.h"

#include <algorithm>

#include "render/surface/loops.h"

namespace neve::render::surface {

namespace {

constexpr BlockKey no_key = ~BlockKey{0};

void fill_run(const Grains& grains, float cell, std::size_t begin, std::size_t end, Run& to,
              std::vector<std::uint32_t>& block_of) {
  BlockKey last = no_key;
  std::uint32_t b = no_block;
  for (std::size_t p = begin; p < end; ++p) {
    NodePlace place;
    const float volume = grains.volume[p];
    if (!(volume > 0) || !is_finite(volume) || !find_node(grains.position[p], cell, place))
      continue;
    const Vec3i node = spline_node(place);
    const BlockKey key = block_key({node.x >> 3, node.y >> 3, node.z >> 3});
    if (key != last) {
      b = to.occupied.insert(last = key);
      to.count.resize(to.occupied.map.size());
    }
    const Vec3i in{node.x & 7, node.y & 7, node.z & 7};
    to.occupied.reach[b].include(in, in);
    ++to.count[b];
    block_of[p] = b;
  }
}

}  // namespace

Runs::Runs(const Grains& grains, float cell, ThreadPool* pool)
    : run(part_count(pool)), block_of(grains.position.size(), no_block) {
  for_parts(pool, block_of.size(), [&](std::size_t part, std::size_t begin, std::size_t end) {
    fill_run(grains, cell, begin, end, run[part], block_of);
  });
}

Occupied occupied_blocks(const Runs& runs) {
  Occupied all;
  for (const Run& run : runs.run)
    for (std::size_t b = 0; b < run.count.size(); ++b) {
      const Occupied::Reach& reach = run.occupied.reach[b];
      all.reach[all.insert(run.occupied.map.keys()[b])].include(reach.low, reach.high);
    }
  return all;
}

void sort_grains(const Grains& grains, Runs& runs, const BlockMap& map, ThreadPool* pool,
                 GrainField& made) {
  std::vector<std::uint32_t> count(map.size(), 0);
  for (Run& run : runs.run) {
    run.next.resize(run.count.size());
    for (std::size_t b = 0; b < run.count.size(); ++b) {
      std::uint32_t& before = count[map.find(run.occupied.map.keys()[b])];
      run.next[b] = before;
      before += run.count[b];
    }
  }
  Bins& bins = made.grains;
  bins.first.assign(map.size() + 1, 0);
  for (std::size_t b = 0; b < map.size(); ++b) bins.first[b + 1] = bins.first[b] + count[b];
  bins.grain.resize(bins.first.back());
  made.placed.resize(bins.first.back());
  for_parts(pool, runs.block_of.size(), [&](std::size_t part, std::size_t begin, std::size_t end) {
    Run& run = runs.run[part];
    for (std::size_t b = 0; b < run.next.size(); ++b)
      run.next[b] += bins.first[map.find(run.occupied.map.keys()[b])];
    for (std::size_t p = begin; p < end; ++p) {
      if (runs.block_of[p] == no_block) continue;
      const std::uint32_t to = run.next[runs.block_of[p]]++;
      bins.grain[to] = static_cast<std::uint32_t>(p);
      made.placed[to] = {grains.position[p], grains.volume[p]};
    }
  });
}

}  // namespace neve::render::surface
