/// The surface of particles: closed, of the right volume, the same with any number of threads.

#include "render/surface/surface.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "render/surface/cell_table.h"
#include "render/surface/nearby.h"
#include "tests/support/surfaces.h"

namespace neve::render::surface {
namespace {

/// Distance of packed particles, m.
constexpr float spacing = 0.01f;
constexpr Settings usual{{0.5f * spacing, spacing}, 8, 0};

struct Snow {
  std::vector<Vec3f> position;
  std::vector<float> volume;

  Grains grains() const { return {position, volume}; }
  void add(Vec3f x, float v = spacing * spacing * spacing) {
    position.push_back(x);
    volume.push_back(v);
  }
  double total() const {
    double sum = 0;
    for (const float v : volume) sum += double(v);
    return sum;
  }
};

/// Returns snow jittered as bodies are: one particle in each cube of a spacing, off its middle by
/// as much as a third of it.
Snow seeded(int half, const std::function<bool(Vec3f)>& is_inside) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(0.2f, 0.8f);
  Snow snow;
  for (int i = -half; i < half; ++i)
    for (int j = -half; j < half; ++j)
      for (int k = -half; k < half; ++k) {
        const Vec3f at{float(i) + place(random), float(j) + place(random),
                       float(k) + place(random)};
        if (is_inside(at)) snow.add(spacing * at);
      }
  return snow;
}

Snow ball(float radius) {
  return seeded(static_cast<int>(radius) + 1, [=](Vec3f x) { return length(x) < radius; });
}

/// Particles at random, from loose to packed, in lumps, sheets and threads: every way to cut a
/// cell.
Snow torn_snow() {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0, 1);
  Snow snow;
  for (int n = 0; n < 12000; ++n) {
    const Vec3f x{40 * unit(random), 30 * unit(random), 30 * unit(random)};
    const float lump = std::sin(0.5f * x.x) * std::sin(0.6f * x.y) * std::sin(0.7f * x.z);
    if (lump > 0.8f * unit(random) - 0.4f)
      snow.add(spacing * x, spacing * spacing * spacing * (0.7f + 2 * unit(random)));
  }
  return snow;
}

using PointsOfEdges = std::array<Vec3<double>, 12>;

std::array<Vec3<double>, 3> triangle_of(const CellCase& cell, int t, const PointsOfEdges& points) {
  const std::size_t e = static_cast<std::size_t>(3 * t);
  return {points[cell.edge[e]], points[cell.edge[e + 1]], points[cell.edge[e + 2]]};
}

/// Cuts of the edges of a cell, `along` their lengths.
PointsOfEdges cut_edges(const std::function<double()>& along) {
  PointsOfEdges points;
  for (int edge = 0; edge < 12; ++edge) {
    const int corner = low_corner(edge);
    Vec3<double> p{double(corner & 1), double(corner >> 1 & 1), double(corner >> 2)};
    p[edge / 4] = along();
    points[static_cast<std::size_t>(edge)] = p;
  }
  return points;
}

TEST(CellTable, TrianglesOfOneCellDoNotCross) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.01, 0.99);
  std::size_t pairs = 0;
  for (int trial = 0; trial < 100; ++trial) {
    // Half of the trials have all vertices as close to corners as they come.
    const PointsOfEdges points = cut_edges([&] {
      const double u = unit(random);
      return trial % 2 == 0 ? u : u < 0.5 ? 0.01 : 0.99;
    });
    for (const CellCase& cell : cell_table())
      for (int a = 0; a < cell.triangles; ++a)
        for (int b = 0; b < a; ++b, ++pairs)
          ASSERT_FALSE(
              test::triangles_cross(triangle_of(cell, a, points), triangle_of(cell, b, points)));
  }
  EXPECT_GT(pairs, 100000u);
}

/// Edges of a case's triangles that lie in the face of an axis at 0 or 1, as pairs of edges of the
/// cell that have the same number on both faces. An edge between two triangles appears twice.
std::multiset<std::pair<int, int>> edges_in_face(const CellCase& cell, int axis, int side) {
  const auto in_face = [&](int edge) {
    return edge / 4 != axis && (low_corner(edge) >> axis & 1) == side;
  };
  const auto number = [&](int edge) { return 16 * (edge / 4) + (low_corner(edge) & ~(1 << axis)); };
  std::multiset<std::pair<int, int>> edges;
  for (int e = 0; e < 3 * cell.triangles; ++e) {
    const int from = cell.edge[static_cast<std::size_t>(e)];
    const int to = cell.edge[static_cast<std::size_t>(e % 3 == 2 ? e - 2 : e + 1)];
    if (in_face(from) && in_face(to)) edges.insert({number(from), number(to)});
  }
  return edges;
}

TEST(CellTable, NeighboursMeetInOppositeEdges) {
  const auto signs = [](int corners, int axis, int side) {
    int bits = 0;
    for (int c = 0, n = 0; c < 8; ++c)
      if ((c >> axis & 1) == side) bits |= (corners >> c & 1) << n++;
    return bits;
  };
  std::size_t met = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int a = 0; a < 256; ++a)
      for (int b = 0; b < 256; ++b) {
        if (signs(a, axis, 1) != signs(b, axis, 0)) continue;
        const auto& table = cell_table();
        const auto here = edges_in_face(table[static_cast<std::size_t>(a)], axis, 1);
        std::multiset<std::pair<int, int>> there;
        for (const auto& [from, to] : edges_in_face(table[static_cast<std::size_t>(b)], axis, 0))
          there.insert({to, from});
        ASSERT_EQ(here, there) << a << " and " << b << " along " << axis;
        // A diagonal in the face would be in both directions.
        for (const auto& [from, to] : here) ASSERT_EQ(here.count({to, from}), 0u);
        ++met;
      }
  EXPECT_EQ(met, 3u * 256 * 16);
}

TEST(Surface, IsClosedOrientedAndDoesNotCutItself) {
  for (const Snow& snow : {ball(8), torn_snow()}) {
    for (const float cell : {0.5f, 0.8f}) {
      Settings settings = usual;
      settings.kernel = {cell * spacing, 0.7f * spacing};
      const Surface surface = make_surface(snow.grains(), settings, nullptr);
      ASSERT_GT(surface.mesh.index.size(), 3000u);
      EXPECT_EQ(test::open_edges(surface.mesh), 0u);
      EXPECT_EQ(test::pinched_vertices(surface.mesh), 0u);
      EXPECT_EQ(test::crossing_triangles(surface.mesh, double(cell * spacing)), 0u);
      EXPECT_GT(test::enclosed_volume(surface.mesh), 0);
    }
  }
}

TEST(Surface, EveryTriangleStaysInItsCell) {
  const Surface surface = make_surface(torn_snow().grains(), usual, nullptr);
  const double cell = double(usual.kernel.cell);
  for (std::size_t c = 0; c < surface.mesh.index.size(); c += 3)
    for (int axis = 0; axis < 3; ++axis) {
      double low = 1e9, high = -1e9;
      for (std::size_t k = 0; k < 3; ++k) {
        low = std::min(low, test::corner_of(surface.mesh, c + k)[axis] / cell);
        high = std::max(high, test::corner_of(surface.mesh, c + k)[axis] / cell);
      }
      // Single precision leaves a few millionths of a cell.
      ASSERT_LE(std::ceil(high - 1e-4) - std::floor(low + 1e-4), 1);
    }
}

/// A kernel of width w on a surface with curvatures k1 and k2 lets it recede by w^2 (k1 + k2) / 2:
/// a ball of radius R loses 3 (w / R)^2, 0.75 % here, and a box of side 40 w the edges and corners
/// that are rounded, below 1 %. The places of the particles add a few tenths of a percent.
TEST(Surface, EnclosesTheVolumeOfItsParticles) {
  const Snow box = seeded(20, [](Vec3f) { return true; });
  for (const Snow& snow : {ball(20), box}) {
    for (const float cell : {0.4f, 0.5f, 0.75f}) {
      Settings settings = usual;
      settings.kernel.cell = cell * spacing;
      const Surface surface = make_surface(snow.grains(), settings, nullptr);
      EXPECT_EQ(surface.pieces, 1u);
      EXPECT_NEAR(test::enclosed_volume(surface.mesh) / snow.total(), 1, 0.015) << cell;
    }
  }
}

TEST(Surface, PackedSnowHasTheVolumeOfItsDensity) {
  Snow snow = ball(20);
  for (Vec3f& x : snow.position) x = 0.8f * x;
  for (float& v : snow.volume) v *= 0.512f;
  const Surface surface = make_surface(snow.grains(), usual, nullptr);
  EXPECT_NEAR(test::enclosed_volume(surface.mesh) / snow.total(), 1, 0.02);
}

TEST(Surface, NormalsPointOutOfABall) {
  const Surface surface = make_surface(ball(12).grains(), usual, nullptr);
  for (std::size_t v = 0; v < surface.mesh.position.size(); ++v) {
    EXPECT_NEAR(length(surface.mesh.normal[v]), 1, 1e-5f);
    ASSERT_GT(dot(surface.mesh.normal[v], normalized(surface.mesh.position[v])), 0.6f);
  }
}

bool is_same(const Surface& a, const Surface& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
  };
  return same(a.mesh.position, b.mesh.position) && same(a.mesh.normal, b.mesh.normal) &&
         a.mesh.index == b.mesh.index && a.spray == b.spray && a.pieces == b.pieces;
}

TEST(Surface, SameBitsAtAnyNumberOfThreads) {
  const Snow snow = torn_snow();
  const Surface alone = make_surface(snow.grains(), usual, nullptr);
  const Shares shares = shares_of(alone.mesh.position, snow.grains(), alone.spray, 0.02f, nullptr);
  for (const int threads : {1, 2, 3, 7}) {
    ThreadPool pool(threads);
    EXPECT_TRUE(is_same(make_surface(snow.grains(), usual, &pool), alone)) << threads;
    const Shares other = shares_of(alone.mesh.position, snow.grains(), alone.spray, 0.02f, &pool);
    EXPECT_TRUE(other.first == shares.first && other.grain == shares.grain &&
                other.share == shares.share);
  }
}

/// The volume that particles give to each node, one after the other: sums in the order of the
/// blocks that the kernels begin in, and of the particles there.
class PlainVolume {
 public:
  PlainVolume(const Grains& grains, float cell) {
    for (std::size_t p = 0; p < grains.position.size(); ++p) add(grains, p, cell);
  }
  float at(Vec3i node) const {
    float sum = 0;
    for (const auto& [block, nodes] : blocks_) {
      const auto found = nodes.find({node.z, node.y, node.x});
      if (found != nodes.end()) sum += found->second;
    }
    return sum;
  }

 private:
  using Place = std::array<int, 3>;  ///< z, y, x

  void add(const Grains& grains, std::size_t p, float cell) {
    Place first;
    std::array<std::array<float, 3>, 3> weight;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = double(grains.position[p][axis]) / double(cell), below = std::floor(x);
      const auto rest = float(x - below);
      const auto a = std::size_t(2 - axis);
      first[a] = int(below) - (rest < 0.5f ? 1 : 0);
      const float u = rest + (rest < 0.5f ? 1.0f : 0.0f);
      weight[a] = {0.5f * (1.5f - u) * (1.5f - u), 0.75f - (u - 1) * (u - 1),
                   0.5f * (u - 0.5f) * (u - 0.5f)};
    }
    const float share = grains.volume[p] * (1 / (cell * cell * cell));
    auto& nodes = blocks_[{first[0] >> 3, first[1] >> 3, first[2] >> 3}];
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          nodes[{first[0] + k, first[1] + j, first[2] + i}] += share * weight[0][std::size_t(k)] *
                                                               weight[1][std::size_t(j)] *
                                                               weight[2][std::size_t(i)];
  }

  std::map<Place, std::map<Place, float>> blocks_;
};

/// A kernel as wide as the spline alone needs no filter.
TEST(Surface, FieldHasTheBitsOfThePlainSums) {
  const Snow snow = torn_snow();
  const float cell = 0.8f * spacing;
  ThreadPool pool(3);
  const GrainField made = make_field(snow.grains(), {cell, 0.5f * cell}, 0, &pool);
  const PlainVolume plain(snow.grains(), cell);
  std::size_t full = 0;
  for (std::size_t b = 0; b < made.field.block.size(); b += 7)
    for (int n = 0; n < block_nodes; ++n) {
      const Vec3i node = made.field.block[b] * block_side + Vec3i{n & 7, n >> 3 & 7, n >> 6};
      const float value = made.field.value[b * block_nodes + std::size_t(n)];
      if (value == 0) continue;  // nodes beside an absent block are cleared
      ++full;
      // The sums of eight blocks are added in another order than here.
      const bool is_of_one_block = (n & 7) > 1 && (n >> 3 & 7) > 1 && (n >> 6) > 1;
      if (is_of_one_block) {
        EXPECT_EQ(value, plain.at(node));
      } else {
        EXPECT_NEAR(value, plain.at(node), 1e-6f * value);
      }
    }
  EXPECT_GT(full, 3000u);
}

TEST(Surface, BinsDoNotDependOnThreads) {
  std::mt19937 random(3);
  std::vector<std::uint32_t> bin_of(20000);
  for (std::uint32_t& bin : bin_of)
    bin = random() % 5 == 0 ? no_block : std::uint32_t(random() % 777);
  const Bins alone = sorted_into_bins(bin_of, 777);
  for (std::size_t bin = 0; bin < 777; ++bin)
    for (std::uint32_t k = alone.first[bin]; k < alone.first[bin + 1]; ++k)
      EXPECT_EQ(bin_of[alone.grain[k]], bin);
  for (const int threads : {1, 2, 3, 7}) {
    ThreadPool pool(threads);
    const Bins together = sorted_into_bins(bin_of, 777, &pool);
    EXPECT_EQ(together.first, alone.first);
    EXPECT_EQ(together.grain, alone.grain);
  }
}

TEST(Surface, SmallPiecesAreSpray) {
  Snow snow = ball(6);
  const auto body = static_cast<std::uint32_t>(snow.position.size());
  for (int n = 0; n < 27; ++n)  // a lump of 27 and a particle alone
    snow.add(spacing * Vec3f{20 + float(n % 3), float(n / 3 % 3), float(n / 9)});
  snow.add(spacing * Vec3f{0, 40, 0});
  Settings settings = usual;
  settings.kernel.width = 0.7f * spacing;
  for (const auto& [smallest, pieces] : {std::pair{1, 2u}, {27, 2u}, {28, 1u}, {100000, 0u}}) {
    settings.smallest_piece = smallest;
    const Surface surface = make_surface(snow.grains(), settings, nullptr);
    EXPECT_EQ(surface.pieces, pieces) << smallest;
    EXPECT_EQ(surface.spray.back(), body + 27) << "the particle alone";
    const std::size_t others = surface.spray.size() - 1;
    EXPECT_EQ(others, pieces == 2 ? 0u : pieces == 1 ? 27u : body + 27);
    EXPECT_EQ(surface.mesh.index.empty(), pieces == 0);
    EXPECT_EQ(test::open_edges(surface.mesh), 0u);
  }
}

TEST(Surface, StrangeParticlesAreSprayAndNothingElse) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  EXPECT_TRUE(make_surface({}, usual, nullptr).mesh.index.empty());
  Snow snow;
  snow.add({1, 2, 3});
  const Surface one = make_surface(snow.grains(), usual, nullptr);
  EXPECT_TRUE(one.mesh.index.empty());
  EXPECT_EQ(one.spray, std::vector<std::uint32_t>{0});
  Snow strange = ball(6);
  const Surface plain = make_surface(strange.grains(), usual, nullptr);
  const std::size_t count = strange.position.size() + plain.spray.size();
  for (const float x : {nan, inf, -inf, 1e30f, 1e6f}) strange.add({0, x, 0});
  for (const float v : {nan, inf, 0.0f, -1.0f}) strange.add({0, 0, 0}, v);
  const Surface surface = make_surface(strange.grains(), usual, nullptr);
  EXPECT_TRUE(surface.mesh.index == plain.mesh.index);
  EXPECT_EQ(strange.position.size() - surface.spray.size(), count - 2 * plain.spray.size());
  // Volumes that grew without bound still give numbers, and a closed mesh.
  strange.add({0.2f, 0, 0}, 1e30f);
  const Surface grown = make_surface(strange.grains(), usual, nullptr);
  EXPECT_EQ(test::open_edges(grown.mesh), 0u);
  for (const Vec3f x : grown.mesh.position)
    ASSERT_TRUE(is_finite(x.x) && is_finite(x.y) && is_finite(x.z));
}

/// The kernel reaches over several blocks, and is cut where next to nothing is left of it.
TEST(Surface, WideKernelsOnFineCellsKeepVolumeAndTopology) {
  const Snow snow = ball(10);
  for (const auto& [cell, width] : {std::pair{0.2f, 1.5f}, {1.0f, 0.5f}}) {
    Settings settings = usual;
    settings.kernel = {cell * spacing, width * spacing};
    const Surface surface = make_surface(snow.grains(), settings, nullptr);
    EXPECT_EQ(surface.pieces, 1u);
    EXPECT_EQ(test::open_edges(surface.mesh), 0u);
    // It recedes as above, by 3 (width / R)^2 of the volume.
    const double share = double(width) / 10;
    EXPECT_NEAR(test::enclosed_volume(surface.mesh) / snow.total(), 1 - 3 * share * share, 0.03);
  }
}

TEST(Surface, LatticesBeyondTheMemoryAreRefused) {
  Snow scattered;
  for (int n = 0; n < 1000; ++n) scattered.add({float(n), 0, 0});
  Settings settings = usual;
  settings.max_bytes = 10'000'000;
  EXPECT_THROW(make_surface(scattered.grains(), settings, nullptr), MemoryError);
  EXPECT_NO_THROW(make_surface(ball(6).grains(), settings, nullptr));
}

/// The weights are symmetric around a vertex, so a linear attribute comes out shifted by no more
/// than the middle of the particles around is away from the vertex, which lies at their rim.
TEST(Surface, AttributesAreThoseOfTheParticlesAround) {
  const Snow snow = ball(12);
  const Surface surface = make_surface(snow.grains(), usual, nullptr);
  const Shares shares =
      shares_of(surface.mesh.position, snow.grains(), surface.spray, 2.5f * spacing, nullptr);
  ASSERT_EQ(shares.first.size(), surface.mesh.position.size() + 1);
  for (std::size_t v = 0; v < surface.mesh.position.size(); ++v) {
    double sum = 0, x = 0;
    float nearest = 1e9f;
    ASSERT_LT(shares.first[v], shares.first[v + 1]);
    for (std::uint32_t k = shares.first[v]; k < shares.first[v + 1]; ++k) {
      const Vec3f p = snow.position[shares.grain[k]];
      nearest = std::min(nearest, length(p - surface.mesh.position[v]));
      sum += double(shares.share[k]);
      x += double(shares.share[k] * p.x);
    }
    EXPECT_NEAR(sum, 1, 1e-5);
    EXPECT_NEAR(x, double(surface.mesh.position[v].x), double(1.5f * spacing));
    const Vec3f first = snow.position[shares.grain[shares.first[v]]];
    ASSERT_FLOAT_EQ(length(first - surface.mesh.position[v]), nearest);
  }
}

}  // namespace
}  // namespace neve::render::surface
