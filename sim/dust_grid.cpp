#include "sim/dust_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

namespace neve::sim {

namespace {

constexpr int block_side = 4, block_nodes = 64, reach = 5;
/// Nodes beyond which a place is no place of dust.
constexpr double farthest = 1e6;

std::uint64_t key_of(const Vec3i& block) {
  constexpr std::int64_t middle = 1 << 20;
  std::uint64_t key = 0;
  for (int a = 0; a < 3; ++a) key = key << 21 | static_cast<std::uint64_t>(block[a] + middle);
  return key;
}

/// The quadratic B-spline, smoothed once more by (1, 2, 1) / 4.
/// @param part  of the place from the middle one of the nodes, in [-0.5, 0.5]
std::array<double, reach> weights_of(double part) {
  const double low = 0.5 * (0.5 - part) * (0.5 - part), middle = 0.75 - part * part,
               high = 0.5 * (0.5 + part) * (0.5 + part);
  return {0.25 * low, 0.25 * middle + 0.5 * low, 0.25 * (low + high) + 0.5 * middle,
          0.25 * middle + 0.5 * high, 0.25 * high};
}

/// Blocks in the order in which they are met.
class Blocks {
 public:
  /// Numbers of a block and of the seven above it.
  const std::array<std::size_t, 8>& from(const Vec3i& low) {
    const auto [found, is_new] = around_.try_emplace(key_of(low));
    if (is_new)
      for (std::size_t n = 0; n < 8; ++n)
        found->second[n] = at(low + Vec3i(n & 1 ? 1 : 0, n & 2 ? 1 : 0, n & 4 ? 1 : 0));
    return found->second;
  }
  const std::vector<Vec3i>& list() const { return list_; }

  /// Momentum, and in the fourth number mass.
  using Node = Eigen::Vector4d;
  std::vector<Node> nodes;

 private:
  std::size_t at(const Vec3i& block) {
    const auto [found, is_new] = index_.try_emplace(key_of(block), list_.size());
    if (is_new) {
      list_.push_back(block);
      nodes.resize(nodes.size() + block_nodes, Node::Zero());
    }
    return found->second;
  }
  std::unordered_map<std::uint64_t, std::size_t> index_;
  std::unordered_map<std::uint64_t, std::array<std::size_t, 8>> around_;  ///< by the lowest
  std::vector<Vec3i> list_;
};

int floor_div(int a, int b) {
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}

void spread(const Vec3d& place, double m, const Vec3d& v, Blocks& blocks) {
  std::array<std::array<double, reach>, 3> w;
  Vec3i first;
  for (int a = 0; a < 3; ++a) {
    const double middle = std::floor(place[a] + 0.5);
    w[static_cast<std::size_t>(a)] = weights_of(place[a] - middle);
    first[a] = static_cast<int>(middle) - reach / 2;
  }
  const Vec3i low(floor_div(first.x(), block_side), floor_div(first.y(), block_side),
                  floor_div(first.z(), block_side));
  const std::array<std::size_t, 8>& around = blocks.from(low);
  const Vec3i in = first - block_side * low;
  const Blocks::Node all(m * v.x(), m * v.y(), m * v.z(), m);
  for (int i = 0; i < reach; ++i)
    for (int j = 0; j < reach; ++j) {
      const double w_xy = w[0][static_cast<std::size_t>(i)] * w[1][static_cast<std::size_t>(j)];
      for (int k = 0; k < reach; ++k) {
        const int x = in.x() + i, y = in.y() + j, z = in.z() + k;
        // Five nodes from the last of a block end in the next one.
        const std::size_t block = around[static_cast<std::size_t>(
            (x >= block_side) | (y >= block_side) << 1 | (z >= block_side) << 2)];
        const std::size_t node =
            block_nodes * block + static_cast<std::size_t>(16 * (x & 3) + 4 * (y & 3) + (z & 3));
        blocks.nodes[node] += w_xy * w[2][static_cast<std::size_t>(k)] * all;
      }
    }
}

}  // namespace

RasterizedNodes dust_nodes(const DustArrays& dust) {
  RasterizedNodes out;
  if (!(dust.air_spacing > 0)) return out;
  out.spacing = 0.5 * dust.air_spacing;
  Blocks blocks;
  for (std::size_t k = 0; k < dust.x.size(); ++k) {
    const Vec3d place = dust.x[k] / out.spacing;
    if (place.cwiseAbs().maxCoeff() < farthest) spread(place, dust.m[k], dust.v[k], blocks);
  }
  const std::vector<Vec3i>& list = blocks.list();
  std::vector<std::size_t> order(list.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return key_of(list[a]) < key_of(list[b]); });
  for (const std::size_t b : order) {
    // A block that only a wider reach would touch.
    const Blocks::Node* first = blocks.nodes.data() + block_nodes * b;
    if (std::all_of(first, first + block_nodes, [](const auto& node) { return !(node[3] > 0); }))
      continue;
    out.block.push_back(list[b]);
    for (const Blocks::Node* node = first; node < first + block_nodes; ++node) {
      const double mass = (*node)[3];
      out.mass.push_back(mass);
      out.velocity.push_back(mass > 0 ? Vec3d(node->head<3>() / mass) : Vec3d::Zero());
    }
  }
  return out;
}

}  // namespace neve::sim
