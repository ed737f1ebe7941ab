#include "render/surface/nearby.h"

#include <algorithm>
#include <limits>

#include "render/surface/block_map.h"
#include "render/surface/loops.h"

namespace neve::render::surface {

namespace {

/// Particles in cubes as wide as the distance within which they are looked for.
class GrainCubes {
 public:
  GrainCubes(const Grains& grains, std::span<const std::uint32_t> left_out, float side)
      : grains_(grains), side_(side) {
    std::vector<std::uint32_t> bin_of(grains.position.size(), no_block);
    std::size_t next_out = 0;
    for (std::size_t p = 0; p < bin_of.size(); ++p) {
      if (next_out < left_out.size() && left_out[next_out] == p) {
        ++next_out;
        continue;
      }
      NodePlace place;
      if (find_node(grains.position[p], side, place)) bin_of[p] = map_.insert(key_of(place.node));
    }
    bins_ = sorted_into_bins(bin_of, map_.size());
  }

  /// use(particle, squared distance) for the particles of all bins that are at most `rings` bins
  /// away.
  template <class Use>
  void for_near(Vec3f vertex, int rings, const Use& use) const {
    NodePlace place;
    if (!find_node(vertex, side_, place)) return;
    for (int z = -rings; z <= rings; ++z)
      for (int y = -rings; y <= rings; ++y)
        for (int x = -rings; x <= rings; ++x) {
          const std::uint32_t bin = map_.find(key_of(place.node + Vec3i{x, y, z}));
          if (bin == no_block) continue;
          for (std::uint32_t k = bins_.first[bin]; k < bins_.first[bin + 1]; ++k) {
            const Vec3f away = grains_.position[bins_.grain[k]] - vertex;
            use(bins_.grain[k], dot(away, away));
          }
        }
  }

 private:
  /// Places share a key where they are further apart than anything that is looked for.
  static BlockKey key_of(Vec3i bin) {
    const auto wrapped = [](int c) { return ((c + (1 << 20)) & 0x1fffff) - (1 << 20); };
    return block_key({wrapped(bin.x), wrapped(bin.y), wrapped(bin.z)});
  }

  const Grains& grains_;
  float side_;
  BlockMap map_;
  Bins bins_;
};

/// A run of vertices.
struct Part {
  std::vector<std::uint32_t> count, grain;
  std::vector<float> share;
};

/// Rings of bins that are searched for the nearest particle: further away than any kernel reaches.
constexpr int most_rings = 12;

void add_nearest(Vec3f vertex, const GrainCubes& cubes, Part& part) {
  float least = std::numeric_limits<float>::infinity();
  std::uint32_t nearest = no_block;
  for (int rings = 1; rings <= most_rings && nearest == no_block; ++rings)
    cubes.for_near(vertex, rings, [&](std::uint32_t p, float squared) {
      if (!(squared < least)) return;
      least = squared;
      nearest = p;
    });
  if (nearest == no_block) return;
  part.grain.push_back(nearest);
  part.share.push_back(1);
}

void add_vertex(Vec3f vertex, const GrainCubes& cubes, float distance, Part& part) {
  const std::size_t begin = part.grain.size();
  float sum = 0, largest = 0;
  std::size_t nearest = begin;
  cubes.for_near(vertex, 1, [&](std::uint32_t p, float squared) {
    const float room = 1 - squared / (distance * distance);
    const float weight = room * room * room;
    if (!(room > 0) || !(weight > 0)) return;
    if (weight > largest) {
      largest = weight;
      nearest = part.grain.size();
    }
    part.grain.push_back(p);
    part.share.push_back(weight);
    sum += weight;
  });
  if (part.grain.size() == begin) {
    add_nearest(vertex, cubes, part);
  } else {
    std::swap(part.grain[begin], part.grain[nearest]);
    std::swap(part.share[begin], part.share[nearest]);
    for (std::size_t k = begin; k < part.share.size(); ++k) part.share[k] /= sum;
  }
  part.count.push_back(static_cast<std::uint32_t>(part.grain.size() - begin));
}

}  // namespace

Shares shares_of(std::span<const Vec3f> vertices, const Grains& grains,
                 std::span<const std::uint32_t> left_out, float distance, ThreadPool* pool) {
  const GrainCubes cubes(grains, left_out, distance);
  constexpr std::size_t part_size = 4096;
  std::vector<Part> parts((vertices.size() + part_size - 1) / part_size);
  for_ranges(pool, parts.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part)
      for (const Vec3f& vertex :
           vertices.subspan(part * part_size)
               .first(std::min(part_size, vertices.size() - part * part_size)))
        add_vertex(vertex, cubes, distance, parts[part]);
  });
  Shares shares;
  shares.first.push_back(0);
  for (const Part& part : parts) {
    for (const std::uint32_t count : part.count)
      shares.first.push_back(shares.first.back() + count);
    shares.grain.insert(shares.grain.end(), part.grain.begin(), part.grain.end());
    shares.share.insert(shares.share.end(), part.share.begin(), part.share.end());
  }
  return shares;
}

}  // namespace neve::render::surface
