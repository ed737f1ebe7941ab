/// Places where rays meet the surface of the view snow, and the face of a cut.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "render/snow/layer.h"
#include "snow_support.h"

namespace neve::render {
namespace {

using snow::Body;
using snow::Marcher;
using snow::TileHits;

/// Packed snow below y = 0 in a box.
Points slab(float spacing, int across, int layers) {
  Points points;
  points.spacing = spacing;
  for (int k = 0; k < across; ++k)
    for (int j = 0; j < layers; ++j)
      for (int i = 0; i < across; ++i)
        points.position.edit().push_back({(static_cast<float>(i - across / 2) + 0.5f) * spacing,
                                          -(static_cast<float>(j) + 0.5f) * spacing,
                                          (static_cast<float>(k - across / 2) + 0.5f) * spacing});
  return points;
}

/// All hits of a picture, tile by tile.
std::vector<TileHits> march(const Body& body, const View& view, const cpu::DrawKernels& kernels) {
  const Marcher marcher(body, view, kernels);
  std::vector<TileHits> hits;
  for (int y = 0; y < view.height; y += light::tile_height)
    for (int x = 0; x < view.width; x += light::tile_width) {
      hits.emplace_back();
      std::memset(&hits.back(), 0, sizeof(TileHits));
      marcher.march_tile(x, y, hits.back());
    }
  return hits;
}

template <class Use>
void for_samples(const View& view, const Use& use) {
  std::size_t tile = 0;
  for (int y = 0; y < view.height; y += light::tile_height)
    for (int x = 0; x < view.width; x += light::tile_width, ++tile)
      for (int at = 0; at < light::tile_samples; ++at) {
        const int i = x + at % light::tile_width, j = y + at / light::tile_width;
        if (i < view.width && j < view.height) use(tile, at, i, j);
      }
}

TEST(Snow, SurfaceOfASlabLiesWhereItsParticlesEnd) {
  constexpr float spacing = 0.02f;
  const Body body = snow::make_body(slab(spacing, 40, 12), {}, nullptr);
  const Camera camera{
      .eye = {0.003f, 1, 0.002f}, .target = {0.003f, 0, 0.002f}, .up = {0, 0, 1}, .fov = 20};
  const View view = make_view(camera, 64, 32);
  int count = 0;
  const std::vector<TileHits> hits = march(body, view, cpu::chosen_draw_kernels());
  for_samples(view, [&](std::size_t tile, int at, int, int) {
    ++count;
    // A lattice of particles is level to within some hundredths of their spacing: the kernel is
    // nearly as wide as they are apart, and nodes between which it is linear lie 0.8 apart.
    EXPECT_NEAR(hits[tile].distance[at], 1, 0.08f * spacing) << at;
  });
  EXPECT_EQ(count, 64 * 32);
}

/// Cuts points open: those beyond the plane go to the other side of it.
void cut_open(Vec3f point, Vec3f normal, Points& points) {
  const Points whole = std::exchange(points, Points{});
  points.spacing = whole.spacing;
  points.cut = CutAway{point, normal, {}, {}, {}, {}, {}, {}};
  for (const Vec3f& p : whole.position)
    (dot(p - point, normal) > 0 ? points.cut->position : points.position).edit().push_back(p);
}

TEST(Snow, ACutIsFlatAndLiesInItsPlane) {
  constexpr float spacing = 0.02f;
  // Neither the lattice of the particles nor that of the field is in line with the plane.
  const Vec3f point{0.003f, -0.4f, 0.011f}, normal = normalized(Vec3f{0.5f, 0.7f, 0.3f});
  Points points = slab(spacing, 40, 40);
  cut_open(point, normal, points);
  const Body body = snow::make_body(points, {}, nullptr);
  for (const Vec3f& p : body.spray.position)  // corners of the slab are
    EXPECT_GT(length(p - point), 0.3f) << "a cut makes no spray";
  const Camera camera{.eye = point + normal, .target = point, .up = {0, 0, 1}, .fov = 14};
  const View view = make_view(camera, 64, 32);
  const std::vector<TileHits> hits = march(body, view, cpu::chosen_draw_kernels());
  for_samples(view, [&](std::size_t tile, int at, int, int) {
    // Linear interpolation keeps the plane as it is where the field is that of the plane at all
    // corners of a cell; snow whose own share is a little less than that of the plane there moves
    // it.
    EXPECT_NEAR(hits[tile].distance[at], 1, 0.02f * spacing) << at;
  });
  // Without the particles beyond, the surface follows the particles before the plane.
  points.cut.reset();
  const Body lumpy = snow::make_body(points, {}, nullptr);
  const std::vector<TileHits> other = march(lumpy, view, cpu::chosen_draw_kernels());
  float most = 0;
  for_samples(view, [&](std::size_t tile, int at, int, int) {
    most = std::max(most, std::abs(other[tile].distance[at] - 1));
  });
  EXPECT_GT(most, 0.1f * spacing);
}

/// Nodes of the field lie on such a plane, and rounding decides whether a ray has met it.
TEST(Snow, ACutThroughNodesHasNoHoles) {
  Points points = slab(0.02f, 40, 40);
  cut_open({}, {0, 0, 1}, points);
  const Body body = snow::make_body(points, {}, nullptr);
  const Camera camera{
      .eye = {0.003f, -0.2f, 1}, .target = {0.003f, -0.39f, 0}, .up = {0, 1, 0}, .fov = 14};
  const View view = make_view(camera, 256, 128);
  const std::vector<TileHits> hits = march(body, view, cpu::chosen_draw_kernels());
  const Marcher marcher(body, view, cpu::chosen_draw_kernels());
  for_samples(view, [&](std::size_t tile, int at, int x, int y) {
    const Vec3f place = marcher.ray(x, y) * hits[tile].distance[at];
    EXPECT_NEAR((camera.eye + place).z, 0, 0.001f) << x << ", " << y;
  });
}

/// Place of the side of a body towards +x at a height, m.
float side_at(const Body& body, float height) {
  for (float x = 0;; x += 0.0005f) {
    const snow::FieldPlace place = snow::find_place(body, {x, height, 0.004f});
    if (place.block == surface::no_block ||
        snow::share_at(body.field, place.block, place.node) < snow::surface_share)
      return x;
  }
}

TEST(Snow, SidesGoStraightDownToTheGround) {
  constexpr float spacing = 0.02f;
  Points points = slab(spacing, 30, 20);
  for (Vec3f& p : points.position.edit()) p.y += 20 * spacing;  // its lower side lies on y = 0
  const std::vector<GroundPlane> ground(1);
  const Body body = snow::make_body(points, ground, nullptr);
  const float middle = side_at(body, 10 * spacing);
  EXPECT_NEAR(middle, 15 * spacing, 0.15f * spacing);
  EXPECT_NEAR(side_at(body, 0.1f * spacing), middle, 0.15f * spacing);
  EXPECT_EQ(side_at(body, -2 * spacing), 0) << "its mirror image ends below the ground";
  // Alone it is rounded below, as it is above.
  const Body alone = snow::make_body(points, {}, nullptr);
  EXPECT_LT(side_at(alone, 0.1f * spacing), middle - 0.5f * spacing);
  EXPECT_NEAR(side_at(body, 19.5f * spacing), side_at(alone, 19.5f * spacing), 1e-4f);
  // A mesh is met like a ground, where particles know the way to it.
  for (const Vec3f& p : points.position)
    points.to_solid.edit().push_back(p.y < mirror_reach * spacing ? Vec3f{0, -p.y, 0} : Vec3f{});
  const Body on_mesh = snow::make_body(points, {}, nullptr);
  EXPECT_NEAR(side_at(on_mesh, 0.1f * spacing), middle, 0.15f * spacing);
}

TEST(Snow, ACutShowsTheValuesInside) {
  OPEN_OR_SKIP(context, "auto");
  // Values by the distance from the middle: a cut through it shows rings, the whole ball its skin.
  Frame frame = snow_ball(160, 120);
  frame.grounds.clear();
  Points& points = frame.points;
  points.id.edit().clear();
  const auto values = [](const std::vector<Vec3f>& from) {
    std::vector<float> to;
    for (const Vec3f& p : from) to.push_back(length(p));
    return to;
  };
  const Vec3f toward = normalized(frame.camera.eye - frame.camera.target);
  cut_open({}, toward, points);
  points.value = values(points.position);
  points.cut->value = values(points.cut->position);
  points.colormap = ColorMap::viridis;
  points.range_max = 0.4f;
  Renderer renderer(*context, {}, nullptr, ParticlePath::cpu);
  const Image image = renderer.draw(frame);
  const auto at = [&](int x) {
    const std::size_t first = 3 * (60 * 160 + static_cast<std::size_t>(x));
    return std::array<int, 3>{image.pixels[first], image.pixels[first + 1],
                              image.pixels[first + 2]};
  };
  // viridis: from dark violet in the middle to yellow.
  EXPECT_GT(at(80)[2], at(80)[1]);
  EXPECT_LT(at(80)[1], at(60)[1]);
  EXPECT_LT(at(80)[1], at(100)[1]);
}

TEST(Snow, PointsThatAreCutAwayNeedTheArraysOfThePoints) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = snow_ball(32, 24);
  cut_open({}, {0, 0, 1}, frame.points);
  frame.points.value.edit().assign(frame.points.position.size(), 1.0f);
  Renderer renderer(*context, {}, nullptr, ParticlePath::cpu);
  EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
}

/// Distance of the first place of the level along a ray, in steps of a hundredth of a cell.
float first_level(const Body& body, Vec3f eye, Vec3f ray) {
  const float step = 0.01f * body.field.cell / length(ray);
  for (float t = 0.5f; t < 3; t += step) {
    const snow::FieldPlace place = snow::find_place(body, eye + ray * t);
    if (place.block != surface::no_block &&
        snow::share_at(body.field, place.block, place.node) >= snow::surface_share)
      return t;
  }
  return 0;
}

TEST(Snow, RaysFindTheFirstPlaceOfTheLevel) {
  const Frame frame = torn_snow(60, 40);
  const Body body = snow::make_body(frame.points, {}, nullptr);
  const View view = make_view(frame.camera, 60, 40);
  const Marcher marcher(body, view);
  const std::vector<TileHits> hits = march(body, view, cpu::chosen_draw_kernels());
  int compared = 0, other = 0;
  for_samples(view, [&](std::size_t tile, int at, int i, int j) {
    const float expected = first_level(body, view.eye, marcher.ray(i, j));
    const float found = hits[tile].distance[at];
    if (expected == 0 && found == 0) return;
    ++compared;
    // Two steps of regula falsi leave a few hundredths of a cell where the field is curved.
    if (!(std::abs(found - expected) < 0.05f * body.field.cell)) ++other;
  });
  EXPECT_GT(compared, 400);
  // Rays that graze the surface over less than a step may pass it, most of all at thin sheets.
  EXPECT_LE(other, compared / 50);
}

TEST(Snow, HitsDependNeitherOnThreadsNorOnTheInstructionSet) {
  const Frame frame = torn_snow(160, 100);
  ThreadPool pool(3);
  const Body alone = snow::make_body(frame.points, {}, nullptr),
             together = snow::make_body(frame.points, {}, &pool);
  EXPECT_EQ(alone.padded, together.padded);
  EXPECT_EQ(alone.padded_block, together.padded_block);
  EXPECT_EQ(alone.grains.along, together.grains.along);
  EXPECT_EQ(alone.grains.first, together.grains.first);
  EXPECT_EQ(alone.spray.position, together.spray.position);
#ifdef NEVE_X86_DRAW
  if (cpu::chosen_draw_kernels().simd == std::string("baseline")) return;
  const View view = make_view(frame.camera, 160, 100);
  const std::vector<TileHits> plain = march(alone, view, cpu::draw_baseline),
                              fast = march(alone, view, cpu::draw_avx2);
  std::size_t found = 0;
  for_samples(view, [&](std::size_t tile, int at, int, int) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(plain[tile].distance[at]),
              std::bit_cast<std::uint32_t>(fast[tile].distance[at]));
    if (plain[tile].distance[at] > 0) {
      ++found;
      EXPECT_EQ(plain[tile].block[at], fast[tile].block[at]);
    }
  });
  EXPECT_GT(found, 1000u);
#endif
}

}  // namespace
}  // namespace neve::render
