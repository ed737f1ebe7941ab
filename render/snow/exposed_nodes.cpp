#include "render/snow/exposed_nodes.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "render/cpu/draw_kernels.h"
#include "render/surface/loops.h"
#include "sim/base/lanes.h"

namespace neve::render::snow {

namespace {

/// Share at a node, and how fast it falls outwards.
struct NodeShare {
  float share;
  Vec3f fall;  ///< per node
};

NodeShare share_of(const float* padded, Vec3i node) {
  const float* at = padded + ((node.z + 1) * padded_side + node.y + 1) * padded_side + node.x + 1;
  const auto fall = [&](int step) { return 0.5f * (at[-step] - at[step]); };
  return {*at, {fall(1), fall(padded_side), fall(padded_side * padded_side)}};
}

/// Returns an outward unit normal: without the bumps of single particles where snow is flat but for
/// these; as it is at edges and broken faces.
Vec3f without_bumps(Vec3f normal, Vec3f even) {
  constexpr float rough = 0.80f, flat = 0.95f;  // cosines of the angle between the two
  const float t = std::clamp((dot(normal, even) - rough) / (flat - rough), 0.0f, 1.0f);
  const float part = 0.85f * t * t * (3 - 2 * t);
  return normalized(normal * (1 - part) + even * part);
}

Vec3f floats(Vec3i v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

/// Nodes of a block that need light, side by side as the kernel wants them.
struct ExposedNodes::NewNodes {
  static constexpr std::size_t size = 736;  ///< 9x9x9, and to the end of a vector
  struct Vectors {
    float x[size], y[size], z[size];
    void set(std::size_t n, Vec3f v) {
      x[n] = v.x;
      y[n] = v.y;
      z[n] = v.z;
    }
    Vec3f at(std::size_t n) const { return {x[n], y[n], z[n]}; }
  };

  void add(std::uint32_t node, Vec3f at, Vec3f outward) {
    number[count] = node;
    place.set(count, at);
    normal.set(count++, outward);
  }
  void light_near(Vec3f toward) {
    for (std::size_t n = count; n < count + cpu::max_light_lanes && n < size; ++n) {
      place.set(n, {});
      normal.set(n, {});
    }
    cpu::chosen_draw_kernels().light_near({static_cast<int>(count),
                                           near.values(),
                                           {place.x, place.y, place.z},
                                           {normal.x, normal.y, normal.z},
                                           toward,
                                           before_sun,
                                           within,
                                           open_sky});
  }

  NearField near;
  std::size_t count;
  std::uint32_t number[size];  ///< among those of the block
  Vectors place, normal;       ///< in nodes from the corner of the block; unit, outward
  float before_sun[size], within[size], open_sky[size];
};

ExposedNodes::ExposedNodes(const Body& body) {
  std::size_t count = 0;
  blocks_.reserve(body.surface_box.size());
  for (const CellBox& box : body.surface_box) {
    const auto nodes = [](int low, int high) { return std::max(high - low + 2, 0); };
    const int row = nodes(box.low.x, box.high.x), slice = row * nodes(box.low.y, box.high.y);
    blocks_.push_back({count, box, row, slice});
    count += static_cast<std::size_t>(slice * nodes(box.low.z, box.high.z));
  }
  nodes_ = std::make_unique_for_overwrite<Exposure[]>(count);
}

void ExposedNodes::want(std::uint32_t padded, Vec3f node) {
  Block& block = blocks_[padded];
  const Vec3i cell = cell_of(block, node);
  const std::uint64_t bit = std::uint64_t{1} << (8 * cell.y + cell.x);
  std::atomic_ref<std::uint64_t> slice(block.wanted[static_cast<std::size_t>(cell.z)]);
  if (!(slice.load(std::memory_order_relaxed) & bit))
    slice.fetch_or(bit, std::memory_order_relaxed);
}

void ExposedNodes::expose_wanted(const Body& body, const light::LightVolume& volume,
                                 const SnowLight& light, ThreadPool* pool) {
  surface::for_ranges(pool, blocks_.size(), [&](std::size_t begin, std::size_t end) {
    const auto nodes = std::make_unique_for_overwrite<NewNodes>();
    for (std::size_t b = begin; b < end; ++b)
      if (blocks_[b].wanted != blocks_[b].exposed)
        expose_block(static_cast<std::uint32_t>(b), body, volume, light, *nodes);
  });
}

void ExposedNodes::expose_block(std::uint32_t padded, const Body& body,
                                const light::LightVolume& volume, const SnowLight& light,
                                NewNodes& nodes) {
  Block& of = blocks_[padded];
  const float* value = body.padded.data() + std::size_t{padded} * padded_nodes;
  const std::uint32_t block = body.padded_block[padded];
  const float cell = body.field.cell;
  const Vec3f corner = floats(body.field.block[block] * 8);
  nodes.near.take(body.field, block);
  // Bit 8 j + i: cells that are new on either side of a node.
  const auto new_beside = [&](int k) {
    const auto new_in = [&](int slice) {
      const auto n = static_cast<std::size_t>(slice);
      return slice < 0 || slice > 7 ? std::uint64_t{0} : of.wanted[n] & ~of.exposed[n];
    };
    return new_in(k - 1) | new_in(k);
  };
  const auto nodes_of_row = [](std::uint64_t cells, int j) {
    const auto cells_of = [&](int row) {
      return row < 0 || row > 7 ? 0u : static_cast<unsigned>(cells >> (8 * row)) & 0xff;
    };
    const unsigned beside = cells_of(j - 1) | cells_of(j);
    return beside | beside << 1;
  };
  nodes.count = 0;
  std::uint32_t at = 0;
  for (int k = of.box.low.z; k <= of.box.high.z + 1; ++k) {
    const std::uint64_t cells = new_beside(k);
    for (int j = of.box.low.y; j <= of.box.high.y + 1; ++j) {
      const unsigned row = nodes_of_row(cells, j);
      for (int i = of.box.low.x; i <= of.box.high.x + 1; ++i, ++at) {
        if (!(row >> i & 1)) continue;
        const NodeShare here = share_of(value, {i, j, k});
        const Vec3f normal = normalized(here.fall);
        // Light is that of the surface beside the node, at most a cell away.
        const float away = (here.share - surface_share) / std::max(length(here.fall), 0.1f);
        nodes.add(at, floats({i, j, k}) + normal * std::clamp(away, -1.0f, 1.0f),
                  without_bumps(normal, normalized(nodes.near.even_fall({i, j, k}))));
      }
    }
  }
  nodes.light_near(light.toward);
  SnowPlace place;
  place.block = block;
  for (std::size_t n = 0; n < nodes.count; ++n) {
    place.node = nodes.place.at(n);
    place.world = (corner + place.node) * cell;
    nodes_[of.first + nodes.number[n]] =
        expose(volume, light, place, nodes.normal.at(n),
               {nodes.before_sun[n], nodes.within[n], nodes.open_sky[n]});
  }
  of.exposed = of.wanted;
}

Exposure ExposedNodes::at(std::uint32_t padded, Vec3f node) const {
  const ExposedCell cell = cell_at(padded, node);
  const auto* corner = reinterpret_cast<const float*>(cell.corner);
  const int row = cell.row * cpu::exposure_numbers, slice = cell.slice * cpu::exposure_numbers,
            first = 0;
  Exposure out;
  cpu::chosen_draw_kernels().mix_exposures({1,
                                            &corner,
                                            &row,
                                            &slice,
                                            {&cell.part.x, &cell.part.y, &cell.part.z},
                                            &first,
                                            {&out.normal.x, &out.normal.y, &out.normal.z, &out.sun,
                                             &out.sky, &out.crevice, &out.through}});
  return out;
}

}  // namespace neve::render::snow
