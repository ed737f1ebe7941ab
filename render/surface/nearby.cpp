#include "render/surface/nearby.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <memory>

#include "render/surface/block_map.h"
#include "render/surface/loops.h"
#include "sim/base/lanes.h"

namespace neve::render::surface {

namespace {

/// A run of particles in GrainCubes.
struct GrainRun {
  std::uint32_t first, end;
};

/// Particles in cubes as wide as the distance within which they are looked for, in the order of the
/// cubes, so that most neighbours along x are one run.
class GrainCubes {
 public:
  GrainCubes(const Grains& grains, std::span<const std::uint32_t> left_out, float side)
      : side_(side) {
    std::vector<std::uint32_t> bin_of = number_cubes(grains, left_out);
    Bins bins = sorted_into_bins(bin_of, map_.size());
    first_ = std::move(bins.first);
    grain_ = std::move(bins.grain);
    for (std::vector<float>& along : along_) along.resize(grain_.size() + lane_count<V>);
    for (std::size_t k = 0; k < grain_.size(); ++k)
      for (int axis = 0; axis < 3; ++axis)
        along_[static_cast<std::size_t>(axis)][k] = grains.position[grain_[k]][axis];
  }

  /// The cube of a place. @return false: off the lattice
  bool find(Vec3f vertex, Vec3i& cube) const {
    NodePlace place;
    if (!find_node(vertex, side_, place)) return false;
    cube = place.node;
    return true;
  }

  /// The particles of all cubes that are at most `rings` cubes away.
  void list_runs(Vec3i cube, int rings, std::vector<GrainRun>& runs) const {
    runs.clear();
    for (int z = -rings; z <= rings; ++z)
      for (int y = -rings; y <= rings; ++y)
        for (int x = -rings; x <= rings; ++x) {
          const std::uint32_t bin = map_.find(key_of(cube + Vec3i{x, y, z}));
          if (bin == no_block) continue;
          if (!runs.empty() && runs.back().end == first_[bin])
            runs.back().end = first_[bin + 1];
          else
            runs.push_back({first_[bin], first_[bin + 1]});
        }
  }

  /// use(particle, squared distance) for those of the runs that are nearer than a distance, and
  /// for some a little further.
  template <class Use>
  void for_near(Vec3f vertex, const std::vector<GrainRun>& runs, float distance,
                const Use& use) const {
    const V most = all<V>(1.001f * distance * distance);
    for (const GrainRun& run : runs)
      for (std::uint32_t k = run.first; k < run.end; k += lane_count<V>) {
        const V x = load_lanes<V>(along_[0].data() + k) - vertex.x,
                y = load_lanes<V>(along_[1].data() + k) - vertex.y,
                z = load_lanes<V>(along_[2].data() + k) - vertex.z;
        const V squared = x * x + y * y + z * z;
        unsigned near = lane_bits(squared < most);
        if (run.end - k < lane_count<V>) near &= (1u << (run.end - k)) - 1;
        for (; near != 0; near &= near - 1) {
          const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
          use(grain_[k + lane], squared[static_cast<int>(lane)]);
        }
      }
  }

 private:
  using V = Quad<float>;

  /// Puts the cubes that have particles into the map, in order.
  /// @return the number of each particle's cube
  std::vector<std::uint32_t> number_cubes(const Grains& grains,
                                          std::span<const std::uint32_t> left_out) {
    std::vector<std::uint32_t> cube_of(grains.position.size(), no_block);
    BlockMap seen;
    std::size_t next_out = 0;
    for (std::size_t p = 0; p < cube_of.size(); ++p) {
      if (next_out < left_out.size() && left_out[next_out] == p) {
        ++next_out;
        continue;
      }
      NodePlace place;
      if (find_node(grains.position[p], side_, place)) cube_of[p] = seen.insert(key_of(place.node));
    }
    std::vector<BlockKey> keys = seen.keys();
    std::sort(keys.begin(), keys.end());
    for (const BlockKey key : keys) map_.insert(key);
    std::vector<std::uint32_t> number;
    for (const BlockKey key : seen.keys()) number.push_back(map_.find(key));
    for (std::uint32_t& cube : cube_of)
      if (cube != no_block) cube = number[cube];
    return cube_of;
  }

  /// Places share a key where they are further apart than anything that is looked for.
  static BlockKey key_of(Vec3i cube) {
    const auto wrapped = [](int c) { return ((c + (1 << 20)) & 0x1fffff) - (1 << 20); };
    return block_key({wrapped(cube.x), wrapped(cube.y), wrapped(cube.z)});
  }

  float side_;
  BlockMap map_;
  std::vector<std::uint32_t> first_, grain_;  ///< of each cube, and the end
  std::array<std::vector<float>, 3> along_;   ///< positions by axis, longer by a vector
};

/// The runs around cubes, for vertices of which many lie in the same few.
class NearRuns {
 public:
  explicit NearRuns(const GrainCubes& cubes) : cubes_(cubes) {}

  const std::vector<GrainRun>& around(Vec3i cube) {
    const int number = (cube.x & 7) | (cube.y & 3) << 3 | (cube.z & 3) << 5;
    Entry& entry = entries_[static_cast<std::size_t>(number)];
    if (!entry.is_there || entry.cube != cube) {
      cubes_.list_runs(cube, 1, entry.runs);
      entry.cube = cube;
      entry.is_there = true;
    }
    return entry.runs;
  }

 private:
  struct Entry {
    bool is_there = false;
    Vec3i cube;
    std::vector<GrainRun> runs;
  };
  const GrainCubes& cubes_;
  std::array<Entry, 128> entries_;
};

/// A run of vertices.
struct Part {
  std::vector<std::uint32_t> count, grain;
  std::vector<float> share;
};

/// Rings of bins that are searched for the nearest particle: further away than any kernel reaches.
constexpr int max_rings = 12;

void add_nearest(Vec3f vertex, Vec3i cube, const GrainCubes& cubes, Part& part) {
  constexpr float everywhere = 1e18f;  // its square is finite
  float least = std::numeric_limits<float>::infinity();
  std::uint32_t nearest = no_block;
  std::vector<GrainRun> runs;
  for (int rings = 1; rings <= max_rings && nearest == no_block; ++rings) {
    cubes.list_runs(cube, rings, runs);
    cubes.for_near(vertex, runs, everywhere, [&](std::uint32_t p, float squared) {
      if (!(squared < least)) return;
      least = squared;
      nearest = p;
    });
  }
  if (nearest == no_block) return;
  part.grain.push_back(nearest);
  part.share.push_back(1);
}

void add_vertex(Vec3f vertex, const GrainCubes& cubes, float distance, NearRuns& near, Part& part) {
  const std::size_t begin = part.grain.size();
  float sum = 0, largest = 0;
  std::size_t nearest = begin;
  Vec3i cube;
  const bool is_on_lattice = cubes.find(vertex, cube);
  if (is_on_lattice)
    cubes.for_near(vertex, near.around(cube), distance, [&](std::uint32_t p, float squared) {
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
    if (is_on_lattice) add_nearest(vertex, cube, cubes, part);
  } else {
    std::swap(part.grain[begin], part.grain[nearest]);
    std::swap(part.share[begin], part.share[nearest]);
    for (std::size_t k = begin; k < part.share.size(); ++k) part.share[k] /= sum;
  }
  part.count.push_back(static_cast<std::uint32_t>(part.grain.size() - begin));
}

Shares joined(const std::vector<Part>& parts, std::size_t vertices, ThreadPool* pool) {
  Shares shares;
  shares.first.reserve(vertices + 1);
  shares.first.push_back(0);
  std::vector<std::ptrdiff_t> first_of;
  for (const Part& part : parts) {
    first_of.push_back(shares.first.back());
    for (const std::uint32_t count : part.count)
      shares.first.push_back(shares.first.back() + count);
  }
  shares.grain.resize(shares.first.back());
  shares.share.resize(shares.first.back());
  for_ranges(pool, parts.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      std::copy(parts[p].grain.begin(), parts[p].grain.end(), shares.grain.begin() + first_of[p]);
      std::copy(parts[p].share.begin(), parts[p].share.end(), shares.share.begin() + first_of[p]);
    }
  });
  return shares;
}

}  // namespace

Shares shares_of(std::span<const Vec3f> vertices, const Grains& grains,
                 std::span<const std::uint32_t> left_out, float distance, ThreadPool* pool) {
  const GrainCubes cubes(grains, left_out, distance);
  constexpr std::size_t part_size = 4096;
  std::vector<Part> parts((vertices.size() + part_size - 1) / part_size);
  for_ranges(pool, parts.size(), [&](std::size_t begin, std::size_t end) {
    const auto near = std::make_unique<NearRuns>(cubes);
    for (std::size_t part = begin; part < end; ++part)
      for (const Vec3f& vertex :
           vertices.subspan(part * part_size)
               .first(std::min(part_size, vertices.size() - part * part_size)))
        add_vertex(vertex, cubes, distance, *near, parts[part]);
  });
  return joined(parts, vertices.size(), pool);
}

}  // namespace neve::render::surface
