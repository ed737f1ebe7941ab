/// Particles in block order and the blocks of nodes around them, against what the definition says.

#include "sim/state/partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <tuple>

namespace {

using namespace neve;
using namespace neve::sim;

struct Point {
  Vec3d x;  ///< cells
  int model;
};

/// Points that wander over the lattice, and what kernels would say about them.
struct Cloud {
  std::vector<Point> points;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint16_t> locals;
  std::mt19937 random{5};

  void add(std::size_t count, double size) {
    std::uniform_real_distribution<double> place(-size / 2, size / 2);
    for (std::size_t q = 0; q < count; ++q) {
      const double x = place(random), y = place(random), z = place(random);
      points.push_back({Vec3d(x, y, z), static_cast<int>(random() % 3)});
    }
  }
  void move(double distance) {
    std::uniform_real_distribution<double> step(-distance, distance);
    for (Point& p : points)
      for (int a = 0; a < 3; ++a) p.x[a] += step(random);
  }
  void locate() {
    keys.resize(points.size());
    locals.resize(points.size());
    for (std::size_t q = 0; q < points.size(); ++q) {
      int cell[3];
      for (int a = 0; a < 3; ++a) cell[a] = static_cast<int>(std::floor(points[q].x[a]));
      keys[q] = kernels::block_key(cell[0] >> 2, cell[1] >> 2, cell[2] >> 2);
      locals[q] = static_cast<std::uint16_t>(points[q].model << 6 | (cell[0] & 3) << 4 |
                                             (cell[1] & 3) << 2 | (cell[2] & 3));
    }
  }
};

std::uint64_t key_at(std::uint64_t key, int o, const neve::sim::Vec3i& period) {
  int at[3];
  for (int a = 0; a < 3; ++a) {
    at[a] = kernels::block_coordinate(key, a) + (o >> (2 - a) & 1);
    if (period[a] > 0) at[a] = (at[a] % period[a] + period[a]) % period[a];
  }
  return kernels::block_key(at[0], at[1], at[2]);
}

void expect_order(const engine::Partition& p, const Cloud& c) {
  std::vector<std::uint32_t> expected(c.points.size());
  std::iota(expected.begin(), expected.end(), 0u);
  std::sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple(c.keys[a], c.locals[a], a) < std::tuple(c.keys[b], c.locals[b], b);
  });
  ASSERT_EQ(p.order(), expected);
  std::uint32_t at = 0;
  for (const kernels::ParticleBlock& block : p.blocks()) {
    ASSERT_EQ(block.begin, at);
    ASSERT_LT(block.begin, block.end);
    int first[2] = {3, 3}, last[2] = {0, 0};
    for (; at < block.end; ++at) {
      ASSERT_EQ(c.keys[p.order()[at]], block.key);
      ASSERT_EQ(c.locals[p.order()[at]], p.sorted_locals()[at]);
      for (int a = 0; a < 2; ++a) {
        const int cell = p.sorted_locals()[at] >> (4 - 2 * a) & 3;
        first[a] = std::min(first[a], cell);
        last[a] = std::max(last[a], cell);
      }
    }
    for (int a = 0; a < 2; ++a) {
      ASSERT_EQ(block.first_cell[a], first[a]);
      ASSERT_EQ(block.last_cell[a], last[a]);
    }
  }
  ASSERT_EQ(at, c.points.size());
}

void expect_links(const engine::Partition& p, const neve::sim::Vec3i& period) {
  std::map<std::uint64_t, kernels::NodeBlock> expected;
  for (std::size_t b = 0; b < p.blocks().size(); ++b) {
    for (int o = 0; o < 8; ++o) {
      const std::uint64_t key = key_at(p.blocks()[b].key, o, period);
      const auto [at, is_new] = expected.try_emplace(key, kernels::NodeBlock{key, {}});
      if (is_new) std::fill(std::begin(at->second.tile), std::end(at->second.tile), -1);
      at->second.tile[o] = static_cast<std::int32_t>(b);
      ASSERT_EQ(p.node_blocks()[p.blocks()[b].node_block[o]].key, key);
    }
  }
  ASSERT_EQ(p.node_blocks().size(), expected.size());
  std::size_t n = 0;
  for (const auto& [key, block] : expected) {
    ASSERT_EQ(p.node_blocks()[n].key, key);
    for (int o = 0; o < 8; ++o) ASSERT_EQ(p.node_blocks()[n].tile[o], block.tile[o]);
    ++n;
  }
}

TEST(Partition, PartitionKeepsTheOrderOfADefinitionThatKnowsNoHistory) {
  for (const int threads : {1, 2, 3, 7}) {
    ThreadPool pool(threads);
    // Sizes are packed, spray and single particles; distances slow, and as no stable step allows.
    for (const double size : {10.0, 30.0, 150.0}) {
      for (const double distance : {0.02, 3.0}) {
        Cloud cloud;
        cloud.add(5000, size);
        engine::Partition partition;
        for (int step = 0; step < 12; ++step) {
          cloud.locate();
          partition.build(cloud.keys, cloud.locals, pool, threads);
          partition.put_on_grid(pool, threads);
          expect_order(partition, cloud);
          expect_links(partition, neve::sim::Vec3i::Zero());
          if (step % 5 == 4) {
            engine::Reordering<Point> reordering;
            partition.sort_storage(cloud.points, reordering, cloud.keys, cloud.locals, pool,
                                   threads);
            const Cloud before = cloud;
            cloud.locate();
            ASSERT_EQ(cloud.keys, before.keys);
            ASSERT_EQ(cloud.locals, before.locals);
            expect_order(partition, cloud);
          }
          cloud.move(distance);
        }
      }
    }
  }
}

TEST(Partition, PartitionTakesParticlesThatComeAndGo) {
  ThreadPool pool(2);
  Cloud cloud;
  engine::Partition partition;
  for (const int count : {0, 1, 2000, 2000, 2500, 1800, 0, 700}) {
    cloud.points.resize(
        std::min<std::size_t>(cloud.points.size(), static_cast<std::size_t>(count)));
    cloud.add(static_cast<std::size_t>(count) - cloud.points.size(), 20);
    cloud.move(0.3);
    cloud.locate();
    partition.build(cloud.keys, cloud.locals, pool, 2);
    partition.put_on_grid(pool, 2);
    expect_order(partition, cloud);
    expect_links(partition, neve::sim::Vec3i::Zero());
  }
}

TEST(Partition, LinksBlocksAroundAPeriod) {
  ThreadPool pool(2);
  for (const neve::sim::Vec3i& period :
       {neve::sim::Vec3i(1, 0, 2), neve::sim::Vec3i(3, 2, 5), neve::sim::Vec3i(0, 0, 4)}) {
    Cloud cloud;
    cloud.add(3000, 30);
    engine::Partition partition;
    partition.set_period(period);
    for (int step = 0; step < 5; ++step) {
      cloud.locate();
      partition.wrap(cloud.keys, pool, 2);
      partition.build(cloud.keys, cloud.locals, pool, 2);
      partition.put_on_grid(pool, 2);
      expect_order(partition, cloud);
      expect_links(partition, period);
      cloud.move(0.5);
    }
  }
}

TEST(Partition, OneParticleFarAwayCostsOneBlock) {
  ThreadPool pool(1);
  Cloud cloud;
  cloud.add(5000, 20);
  cloud.locate();
  engine::Partition near, both;
  near.build(cloud.keys, cloud.locals, pool, 1);
  near.put_on_grid(pool, 1);
  cloud.points.push_back({Vec3d(1e6, -1e6, 1e6), 0});
  cloud.locate();
  both.build(cloud.keys, cloud.locals, pool, 1);
  both.put_on_grid(pool, 1);
  EXPECT_EQ(both.blocks().size(), near.blocks().size() + 1);
  EXPECT_EQ(both.node_blocks().size(), near.node_blocks().size() + 8);
  expect_links(both, neve::sim::Vec3i::Zero());
}

}  // namespace
