/// The view snow: particles as a surface with grain.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include "both_ways.h"
#include "render/light/light_fields.h"
#include "render/snow/grain_noise.h"
#include "render/snow/layer.h"

namespace neve::render {
namespace {

using snow::Body;
using snow::Marcher;
using snow::TileHits;

Frame snow_ball(int width, int height) {
  Frame frame = rough_ball(width, height);
  frame.has_snow_surface = true;
  return frame;
}

/// A ball with a crack, a thin sheet beside it, and a few loose particles.
Frame torn_snow(int width, int height) {
  Frame frame = snow_ball(width, height);
  Points& points = frame.points;
  for (Vec3f& p : points.position)
    if (p.x + 0.2f * p.y > 0.1f) p.x += 0.08f;
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j)
      add_point(frame, {0.62f, 0.025f * static_cast<float>(i), 0.025f * static_cast<float>(j)});
  for (int i = 0; i < 5; ++i) add_point(frame, {-0.6f, 0.1f * static_cast<float>(i), 0.3f});
  return frame;
}

/// Packed snow below y = 0 in a box.
Points slab(float spacing, int across, int layers) {
  Points points;
  points.spacing = spacing;
  for (int k = 0; k < across; ++k)
    for (int j = 0; j < layers; ++j)
      for (int i = 0; i < across; ++i)
        points.position.push_back({(static_cast<float>(i - across / 2) + 0.5f) * spacing,
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
  points.cut = CutAway{point, normal, {}, {}, {}, {}, {}};
  for (const Vec3f& p : whole.position)
    (dot(p - point, normal) > 0 ? points.cut->position : points.position).push_back(p);
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
  for (Vec3f& p : points.position) p.y += 20 * spacing;  // its lower side lies on y = 0
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
}

TEST(Snow, ACutShowsTheValuesInside) {
  OPEN_OR_SKIP(context, "auto");
  // Values by the distance from the middle: a cut through it shows rings, the whole ball its skin.
  Frame frame = snow_ball(160, 120);
  frame.grounds.clear();
  Points& points = frame.points;
  points.id.clear();
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
  frame.points.value.assign(frame.points.position.size(), 1.0f);
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

/// Those of each instruction set that this machine runs.
std::vector<const cpu::DrawKernels*> all_kernels() {
  std::vector<const cpu::DrawKernels*> kernels{&cpu::draw_baseline};
  if (&cpu::chosen_draw_kernels() != &cpu::draw_baseline)
    kernels.push_back(&cpu::chosen_draw_kernels());
  return kernels;
}

/// The two grains nearest to a place, from all there are.
std::array<std::uint32_t, 2> nearest_of_all(const snow::GrainList& grains, Vec3f place) {
  std::array<std::uint64_t, 2> key{~0ull, ~0ull};
  for (std::uint32_t p = 0; p < grains.grain.size(); ++p) {
    const Vec3f away = place - grains.grain[p].position;
    const std::uint64_t own =
        std::uint64_t{std::bit_cast<std::uint32_t>(dot(away, away))} << 32 | p;
    key[1] = std::min(key[1], std::max(key[0], own));
    key[0] = std::min(key[0], own);
  }
  return {static_cast<std::uint32_t>(key[0]), static_cast<std::uint32_t>(key[1])};
}

TEST(Snow, NearestGrainsAreThoseOfAll) {
  const Body body = snow::make_body(torn_snow(160, 100).points, {}, nullptr);
  const float cell = body.field.cell;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> away(-cell, cell);
  constexpr int count = 500;
  std::vector<std::uint32_t> block;
  std::array<std::vector<float>, 3> node, world;
  std::vector<Vec3f> places;
  while (places.size() < count) {
    const Vec3f place = body.grains.grain[random() % body.grains.grain.size()].position +
                        Vec3f{away(random), away(random), away(random)};
    const snow::FieldPlace at = snow::find_place(body, place);
    if (at.block == surface::no_block) continue;
    places.push_back(place);
    block.push_back(at.block);
    for (int axis = 0; axis < 3; ++axis) {
      node[static_cast<std::size_t>(axis)].push_back(at.node[axis]);
      world[static_cast<std::size_t>(axis)].push_back(place[axis]);
    }
  }
  for (const cpu::DrawKernels* k : all_kernels()) {
    std::vector<std::uint32_t> first(count), second(count);
    std::vector<float> first_squared(count), second_squared(count);
    const auto& along = body.grains.along;
    k->find_nearest({count,
                     block.data(),
                     {node[0].data(), node[1].data(), node[2].data()},
                     {world[0].data(), world[1].data(), world[2].data()},
                     reinterpret_cast<const std::uint32_t(*)[27]>(body.field.near.data()),
                     body.grains.first.data(),
                     {along[0].data(), along[1].data(), along[2].data()},
                     first.data(),
                     second.data(),
                     first_squared.data(),
                     second_squared.data()});
    int sure = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const auto [nearest, next] = nearest_of_all(body.grains, places[n]);
      // Grains are looked for up to a node away at least, and up to three at most.
      if (first[n] == surface::no_block || first_squared[n] > cell * cell) continue;
      EXPECT_EQ(first[n], nearest) << k->simd;
      if (second[n] == surface::no_block || second_squared[n] > cell * cell) continue;
      ++sure;
      EXPECT_EQ(second[n], next) << k->simd;
    }
    EXPECT_GT(sure, count / 4);
  }
}

TEST(Snow, AmongGrainsEquallyNearThatOfTheLowerNumberComesFirst) {
  // One row of cubes with grains on both sides of a place, at whole distances: many are equally
  // near, side by side in a vector, in one lane of several, and in several vectors.
  const std::uint32_t near[27] = {cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, cpu::no_grain,
                                  cpu::no_grain, 0};
  std::mt19937 random(11);
  for (int round = 0; round < 400; ++round) {
    const std::size_t count = round % 40;
    std::array<std::vector<float>, 3> along;
    for (std::vector<float>& a : along) {
      for (std::size_t p = 0; p < count; ++p)
        a.push_back(static_cast<float>(static_cast<int>(random() % 5) - 2));
      a.resize(count + snow::grain_margin);
    }
    // All of them in the cube of the place; the others are empty.
    std::vector<std::uint32_t> first(cpu::cubes_per_block + 1, 0);
    const std::size_t cube = 1 << 4 | 1 << 2 | 1;
    std::fill(first.begin() + cube + 1, first.end(), static_cast<std::uint32_t>(count));
    std::array<std::uint64_t, 2> expected{~0ull, ~0ull};
    for (std::uint32_t p = 0; p < count; ++p) {
      const Vec3f away{along[0][p], along[1][p], along[2][p]};
      const std::uint64_t key =
          std::uint64_t{std::bit_cast<std::uint32_t>(dot(away, away))} << 32 | p;
      expected[1] = std::min(expected[1], std::max(expected[0], key));
      expected[0] = std::min(expected[0], key);
    }
    const std::uint32_t block = 0;
    const float node = 3, world = 0;
    for (const cpu::DrawKernels* k : all_kernels()) {
      std::uint32_t nearest = 0, second = 0;
      float nearest_squared = 0, second_squared = 0;
      k->find_nearest({1,
                       &block,
                       {&node, &node, &node},
                       {&world, &world, &world},
                       &near,
                       first.data(),
                       {along[0].data(), along[1].data(), along[2].data()},
                       &nearest,
                       &second,
                       &nearest_squared,
                       &second_squared});
      EXPECT_EQ(nearest, static_cast<std::uint32_t>(expected[0])) << k->simd << ' ' << round;
      EXPECT_EQ(second, static_cast<std::uint32_t>(expected[1])) << k->simd << ' ' << round;
    }
  }
}

TEST(Snow, NearLightInLanesIsThatOfOnePlace) {
  const Body body = snow::make_body(torn_snow(160, 100).points, {}, nullptr);
  const snow::SnowLight light{normalized(Vec3f{0.3f, 0.8f, -0.4f}), 1, 1, false};
  light::LightVolume open;  // all light arrives from afar
  const Vec3i cells = open.grid.size;
  open.light.assign(static_cast<std::size_t>(2 * cells.x * cells.y * cells.z), 65535);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> along(-0.5f, 8.5f), unit(-1, 1);
  const auto near = std::make_unique<snow::NearField>();
  constexpr std::size_t count = 50, size = 64;
  int shaded = 0;
  for (std::uint32_t block = 0; block < body.field.block.size(); block += 3) {
    near->take(body.field, block);
    std::array<std::array<float, size>, 3> place{}, normal{}, found{};
    for (std::size_t n = 0; n < count; ++n) {
      const Vec3f outward = normalized(Vec3f{unit(random), unit(random), unit(random)});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis][n] = along(random);
        normal[axis][n] = outward[static_cast<int>(axis)];
      }
    }
    for (const cpu::DrawKernels* k : all_kernels()) {
      k->light_near({count,
                     near->values(),
                     {place[0].data(), place[1].data(), place[2].data()},
                     {normal[0].data(), normal[1].data(), normal[2].data()},
                     light.toward,
                     found[0].data(),
                     found[1].data(),
                     found[2].data()});
      for (std::size_t n = 0; n < count; ++n) {
        snow::SnowPlace at;
        at.block = block;
        at.node = {place[0][n], place[1][n], place[2][n]};
        const Vec3f outward{normal[0][n], normal[1][n], normal[2][n]};
        const snow::Exposure one = snow::expose(body, open, light, at, outward);
        const snow::Exposure lanes =
            snow::expose(open, light, at, outward, {found[0][n], found[1][n], found[2][n]});
        EXPECT_EQ(one.sun, lanes.sun) << k->simd;
        EXPECT_EQ(one.through, lanes.through) << k->simd;
        EXPECT_EQ(one.crevice, lanes.crevice) << k->simd;
        shaded += one.sun < 0.9f && one.crevice < 0.9f ? 1 : 0;
      }
    }
  }
  EXPECT_GT(shaded, 100);
}

TEST(Snow, IsDrawnAlikeByOpenGlAndOnTheCpu) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = torn_snow(320, 200);
  expect_same_picture(*context, frame, "torn snow");
  frame.supersampling = 2;
  expect_same_picture(*context, frame, "four samples a pixel");
  frame.is_transparent = true;
  Renderer gl(*context, {}, nullptr, ParticlePath::gl),
      cpu(*context, {}, nullptr, ParticlePath::cpu);
  // Without a ground behind, an edge more or less shows: see expect_same_picture.
  EXPECT_LE(compare(gl.draw(frame), cpu.draw(frame)).mean, 0.05);
}

TEST(Snow, PicturesHaveTheSameBytesOnAnyNumberOfThreads) {
  OPEN_OR_SKIP(context, "auto");
  const Frame frame = torn_snow(320, 200);
  ThreadPool pool(3);
  Renderer alone(*context, {}, nullptr, ParticlePath::cpu),
      together(*context, {}, &pool, ParticlePath::cpu);
  EXPECT_EQ(alone.draw(frame).pixels, together.draw(frame).pixels);
}

/// Exposures that were made for another camera are used again, and must be the same.
TEST(Snow, AnotherCameraSeesTheSameSnow) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = torn_snow(320, 200);
  Frame turned = frame;
  turned.camera.eye = {1.2f, 0.4f, 1.1f};
  Renderer kept(*context, {}, nullptr, ParticlePath::cpu),
      fresh(*context, {}, nullptr, ParticlePath::cpu);
  kept.draw(turned);
  EXPECT_EQ(kept.draw(frame).pixels, fresh.draw(frame).pixels);
  // A light that turns changes them.
  frame.light.direction = {0.8f, 0.5f, 0.1f};
  Renderer lit(*context, {}, nullptr, ParticlePath::cpu);
  EXPECT_EQ(kept.draw(frame).pixels, lit.draw(frame).pixels);
}

TEST(Snow, OnlyLooseParticlesAreSpray) {
  const Frame frame = torn_snow(96, 64);
  const Body body = snow::make_body(frame.points, {}, nullptr);
  std::vector<std::uint32_t> spray = body.spray.id;
  spray.erase(std::unique(spray.begin(), spray.end()), spray.end());
  const auto last = static_cast<std::uint32_t>(frame.points.position.size());
  for (std::uint32_t p = last - 5; p < last; ++p)
    EXPECT_TRUE(std::find(spray.begin(), spray.end(), p) != spray.end()) << p;
  for (const std::uint32_t p : spray) {
    const Vec3f x = frame.points.position[p];
    // Deeper in the ball than a kernel's width, and off the crack, nothing is loose.
    const bool is_inside = length(x) < 0.33f && x.x + 0.2f * x.y < 0.05f;
    EXPECT_FALSE(is_inside) << p;
  }
  EXPECT_LT(spray.size(), frame.points.position.size() / 4);
}

/// Mean difference of two pictures of snow whose particles, camera and lattice moved together.
double difference_after_move(render::gl::Context& context, std::uint32_t first_id) {
  Frame still = snow_ball(320, 200), moved = still;
  // A whole number of the field's cells: the lattice samples the snow alike.
  const float way = 16 * 0.8f * still.points.spacing;
  for (Vec3f& p : moved.points.position) p.x += way;
  for (GroundPlane& ground : moved.grounds) ground.point.x += way;
  moved.camera.eye.x += way;
  moved.camera.target.x += way;
  still.grounds.clear();
  moved.grounds.clear();
  for (std::uint32_t& id : moved.points.id) id += first_id;
  Renderer a(context, {}, nullptr, ParticlePath::cpu), b(context, {}, nullptr, ParticlePath::cpu);
  return compare(a.draw(still), b.draw(moved)).mean;
}

TEST(Snow, GrainMovesWithTheParticles) {
  OPEN_OR_SKIP(context, "auto");
  const double same = difference_after_move(*context, 0),
               other = difference_after_move(*context, 100000);
  // Rounding of the positions and the cells of the light; other particles have other grain.
  EXPECT_LT(same, 0.1);
  EXPECT_GT(other, 5 * same);
}

/// By a quarter turn about y, which takes the field's lattice to itself.
Vec3f quarter(Vec3f v) {
  return {v.z, v.y, -v.x};
}

/// Mean difference of a picture of snow and one of it, its light and its camera, all turned.
double difference_after_turn(render::gl::Context& context, const PackedTurn& turn) {
  Frame still = snow_ball(320, 200);
  still.grounds.clear();
  Frame turned = still;
  for (Vec3f& p : turned.points.position) p = quarter(p);
  turned.points.turn.assign(turned.points.position.size(), turn);
  turned.camera.eye = quarter(still.camera.eye);
  turned.light.direction = quarter(still.light.direction);
  Renderer a(context, {}, nullptr, ParticlePath::cpu), b(context, {}, nullptr, ParticlePath::cpu);
  return compare(a.draw(still), b.draw(turned)).mean;
}

TEST(Snow, GrainTurnsWithTheParticles) {
  OPEN_OR_SKIP(context, "auto");
  constexpr std::int16_t half_angle = 23170;  // cos and sin of 45 degrees
  const double same = difference_after_turn(*context, {half_angle, 0, half_angle, 0}),
               other = difference_after_turn(*context, no_turn),
               wrong = difference_after_turn(*context, {half_angle, 0, -half_angle, 0});
  // The cells of the light begin elsewhere, and the sky is not that of the other side.
  EXPECT_LT(same, 0.35);
  EXPECT_GT(other, 3 * same);
  EXPECT_GT(wrong, 3 * same);
}

TEST(Snow, ValuesColorTheSurface) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = snow_ball(160, 100);
  frame.grounds.clear();
  frame.points.colormap = ColorMap::coolwarm;
  const auto middle = [&](float value) {
    frame.points.value.assign(frame.points.position.size(), value);
    Renderer renderer(*context, {}, nullptr, ParticlePath::cpu);
    return pixel(renderer.draw(frame), 80, 50);
  };
  const Pixel cold = middle(0), hot = middle(1);
  EXPECT_GT(cold.b, cold.r + 40);
  EXPECT_GT(hot.r, hot.b + 40);
}

TEST(Snow, IsBrightWithBlueShade) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = snow_ball(160, 100);
  Renderer renderer(*context, {}, nullptr, ParticlePath::cpu);
  frame.light.direction = frame.camera.eye;
  const Pixel lit = pixel(renderer.draw(frame), 80, 50);
  EXPECT_GT(lit.brightness(), 225);
  EXPECT_LT(lit.brightness(), 255);
  frame.light.direction = -frame.camera.eye;
  frame.light.direction.y = 0.1f;
  const Pixel shade = pixel(renderer.draw(frame), 80, 50);
  EXPECT_LT(shade.brightness(), lit.brightness() - 40);
  EXPECT_GT(shade.brightness(), 60);
  EXPECT_GT(shade.b, shade.r + 5);
}

/// A block of jittered snow, seen from above a corner; the sun shines on the side to +z.
Frame block_of_snow(Vec3f size, Vec3f toward_sun) {
  Frame frame = small_frame(320, 200);
  frame.has_snow_surface = true;
  frame.camera = {.eye = {0.5f, 0.5f, 1.4f}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 30};
  frame.light.direction = toward_sun;
  frame.points.spacing = 0.02f;
  frame.points.radius = 0.7f * frame.points.spacing;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> away(-0.006f, 0.006f);
  const auto count = [&](float width) {
    return static_cast<int>(std::lround(width / frame.points.spacing));
  };
  const Vec3i counts{count(size.x), count(size.y), count(size.z)};
  for (int k = 0; k < counts.z; ++k)
    for (int j = 0; j < counts.y; ++j)
      for (int i = 0; i < counts.x; ++i) {
        const auto along = [&](int n, int of) {
          return (static_cast<float>(n - of / 2) + 0.5f) * frame.points.spacing + away(random);
        };
        add_point(frame, {along(i, counts.x), along(j, counts.y), along(k, counts.z)});
      }
  return frame;
}

/// Mean brightness of a square of pixels around the picture of a place.
double brightness_around(const Image& image, const Frame& frame, Vec3f place, int half) {
  const Vec3f at = make_view(frame.camera, frame.width, frame.height).project(place);
  double sum = 0;
  for (int y = -half; y <= half; ++y)
    for (int x = -half; x <= half; ++x)
      sum += pixel(image, static_cast<int>(at.x) + x, frame.height - 1 - static_cast<int>(at.y) + y)
                 .brightness();
  return sum / ((2 * half + 1) * (2 * half + 1));
}

TEST(Snow, LitAndShadedFacesOfABlockAreToldApart) {
  OPEN_OR_SKIP(context, "auto");
  const Frame frame = block_of_snow({0.4f, 0.4f, 0.4f}, {-0.5f, 0.5f, 0.7f});
  const Image image = Renderer(*context, {}, nullptr, ParticlePath::cpu).draw(frame);
  const double lit = brightness_around(image, frame, {0, 0, 0.2f}, 8),
               shaded = brightness_around(image, frame, {0.2f, 0, 0}, 4);
  // A photograph of snow in the sun has two to three stops between them: a quarter to an eighth of
  // the light, which is 0.39 to 0.53 of the numbers in the picture. Diffuse light of the sky makes
  // it one and a half.
  EXPECT_GT(lit, 190);
  EXPECT_LT(shaded, 0.62 * lit);
  EXPECT_GT(shaded, 0.35 * lit) << "snow in the shade is no coal";
}

TEST(Snow, FlatSnowIsEven) {
  OPEN_OR_SKIP(context, "auto");
  const Frame frame = block_of_snow({0.6f, 0.4f, 0.4f}, {-0.5f, 0.7f, 0.4f});
  const Image image = Renderer(*context, {}, nullptr, ParticlePath::cpu).draw(frame);
  // Patches of some particles, on a face whose particles are as uneven as simulated ones.
  std::vector<double> patch;
  for (int j = -3; j <= 3; ++j)
    for (int i = -5; i <= 3; ++i)
      patch.push_back(brightness_around(
          image, frame, {0.04f * static_cast<float>(i), 0.04f * static_cast<float>(j), 0.2f}, 4));
  const auto count = static_cast<double>(patch.size());
  double mean = 0, squared = 0;
  for (const double b : patch) mean += b / count;
  for (const double b : patch) squared += (b - mean) * (b - mean) / count;
  // Steps of one in a hundred are about the least that an eye sees in large patches; two and a half
  // is a face without spots.
  EXPECT_LT(std::sqrt(squared), 0.025 * mean);
}

TEST(Snow, EdgesHaveNoFur) {
  const Frame frame = block_of_snow({0.4f, 0.4f, 0.4f}, {-0.5f, 0.5f, 0.7f});
  const Body body = snow::make_body(frame.points, {}, nullptr);
  std::vector<std::uint32_t> id = body.spray.id;
  id.erase(std::unique(id.begin(), id.end()), id.end());
  // Particles along the twelve edges are looser than the surface covers; their crumbs lie in it.
  EXPECT_GT(id.size(), 20u);
  std::size_t outside = 0;
  for (const Vec3f& p : body.spray.position) {
    const snow::FieldPlace at = snow::find_place(body, p);
    if (at.block == surface::no_block || snow::share_at(body.field, at.block, at.node) < 0.3f)
      ++outside;
  }
  // The jitter puts a few really off it.
  EXPECT_LT(outside, body.spray.position.size() / 10);
}

TEST(Snow, ThinSnowShinesAgainstTheSun) {
  OPEN_OR_SKIP(context, "auto");
  const auto seen = [&](float thickness) {
    const Frame frame = block_of_snow({0.5f, 0.5f, thickness}, {-0.3f, 0.3f, -1});
    const Image image = Renderer(*context, {}, nullptr, ParticlePath::cpu).draw(frame);
    return brightness_around(image, frame, {0, 0, thickness / 2}, 8);
  };
  const double thin = seen(0.04f), thick = seen(0.3f);
  EXPECT_GT(thin, 1.4 * thick) << "two particles against fifteen";
}

TEST(Snow, BadAndMissingParticlesAreNoSurface) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = torn_snow(96, 64);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  frame.points.position[3].x = nan;
  frame.points.position[4].y = std::numeric_limits<float>::infinity();
  frame.points.position[5].z = 1e30f;
  frame.points.volume.assign(frame.points.position.size(), 1e-5f);
  frame.points.volume[6] = nan;
  frame.points.volume[7] = -1;
  frame.points.volume[8] = 1e30f;
  const Image bad = renderer.draw(frame);
  frame.points.volume.clear();
  frame.camera.eye = {0.01f, 0, 0};  // inside
  renderer.draw(frame);
  for (const std::size_t count : {std::size_t{1}, std::size_t{0}}) {
    frame.points.position.resize(count);
    frame.points.id.resize(count);
    renderer.draw(frame);
  }
  Frame nothing = torn_snow(96, 64);
  nothing.points = {};
  EXPECT_GT(compare(bad, renderer.draw(nothing)).mean, 1);
}

/// Relief of a grain at its origin, which has not turned and whose seed shifts nothing.
struct SeenRelief {
  float height;
  Vec3f slope;
};

/// @param place  in spacings from the grain @param pixels  samples per spacing
SeenRelief relief_at(const cpu::DrawKernels& kernels, Vec3f place, float pixels) {
  const snow::GrainNoise& noise = snow::grain_noise();
  const cpu::Grain grain{{}, 0xffffffffu, 0, {32767, 0, 0, 0}};
  constexpr std::size_t size = cpu::most_light_lanes;
  const std::array<std::uint32_t, size> number{};
  std::array<std::array<float, size>, 3> world{}, albedo{}, slope{};
  std::array<float, size> sample_size{}, height{};
  for (std::size_t axis = 0; axis < 3; ++axis) world[axis][0] = place[static_cast<int>(axis)];
  sample_size[0] = 1 / pixels;
  kernels.look_at_grains({1,
                          1,
                          &grain,
                          {noise.texels(0), noise.texels(1), noise.texels(2)},
                          number.data(),
                          {world[0].data(), world[1].data(), world[2].data()},
                          sample_size.data(),
                          0,
                          {albedo[0].data(), albedo[1].data(), albedo[2].data()},
                          {slope[0].data(), slope[1].data(), slope[2].data()},
                          height.data(),
                          {}});
  EXPECT_EQ(albedo[0][0], 1.0f);
  return {height[0], {slope[0][0], slope[1][0], slope[2][0]}};
}

TEST(Snow, ReliefHasTheSlopeOfItsHeight) {
  for (const cpu::DrawKernels* kernels : all_kernels())
    for (const float pixels : {10.0f, 5.0f, 2.0f}) {  // one for each level of the noise
      double sum = 0, worst = 0;
      for (int n = 0; n < 500; ++n) {
        const float f = static_cast<float>(n);
        const Vec3f p = Vec3f{0.37f * f, 0.61f * f - 20, 0.93f * f} * (1 / 1.4f);
        // Central differences over a texel: exactly the table's own at its nodes, and means of them
        // between. A spacing has 1.4 units of eight texels.
        constexpr float d = 1.0f / 8 / 1.4f;
        const auto height = [&](Vec3f at) {
          return static_cast<double>(relief_at(*kernels, at, pixels).height);
        };
        const SeenRelief here = relief_at(*kernels, p, pixels);
        for (int axis = 0; axis < 3; ++axis) {
          Vec3f step{};
          step[axis] = d;
          const double slope = (height(p + step) - height(p - step)) / (2 * static_cast<double>(d));
          worst = std::max(worst, std::abs(slope - static_cast<double>(here.slope[axis])));
        }
        sum += static_cast<double>(here.height);
        EXPECT_LT(std::abs(here.height), 1.2f);
      }
      EXPECT_LT(worst, 1e-3) << pixels;  // rounding of places up to 500 units away, and of 1.4
      EXPECT_LT(std::abs(sum / 500), 0.05) << pixels;
    }
}

TEST(Snow, LooksOfGrainsDoNotDependOnTheInstructionSet) {
  constexpr std::size_t grains = 40, count = 61, size = 64;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<cpu::Grain> list(grains);
  for (cpu::Grain& grain : list) {
    grain.position = {unit(random), unit(random), unit(random)};
    grain.color = static_cast<unsigned>(random());
    grain.seed = static_cast<unsigned>(random());
    double q[4], squared = 0;
    for (double& part : q) {
      part = static_cast<double>(unit(random));
      squared += part * part;
    }
    for (int n = 0; n < 4; ++n)
      grain.turn[n] = static_cast<short>(std::lround(32767 * q[n] / std::sqrt(squared)));
  }
  std::array<std::uint32_t, size> number{};
  std::array<std::array<float, size>, 3> world{};
  std::array<float, size> sample_size{};
  for (std::size_t n = 0; n < size; ++n) {
    number[n] = static_cast<std::uint32_t>(random() % grains);
    for (auto& axis : world) axis[n] = unit(random);
    sample_size[n] = 0.01f + 0.2f * std::abs(unit(random));
  }
  using Numbers = std::array<std::array<float, size>, 10>;
  std::vector<Numbers> looks;
  int facets = 0, without = 0;
  for (const cpu::DrawKernels* k : all_kernels()) {
    Numbers& to = looks.emplace_back();
    const snow::GrainNoise& noise = snow::grain_noise();
    k->look_at_grains({static_cast<int>(count),
                       0.3f,
                       list.data(),
                       {noise.texels(0), noise.texels(1), noise.texels(2)},
                       number.data(),
                       {world[0].data(), world[1].data(), world[2].data()},
                       sample_size.data(),
                       1,
                       {to[0].data(), to[1].data(), to[2].data()},
                       {to[3].data(), to[4].data(), to[5].data()},
                       to[6].data(),
                       {to[7].data(), to[8].data(), to[9].data()}});
    for (std::size_t n = 0; n < count; ++n) {
      const Vec3f facet{to[7][n], to[8][n], to[9][n]};
      const bool is_seen = 0.3f / sample_size[n] > cpu::least_sparkling;
      (is_seen ? facets : without) += 1;
      EXPECT_NEAR(length(facet), is_seen ? 1 : 0, 1e-6) << k->simd;
      const float root = static_cast<float>(list[number[n]].color & 0xff) / 255;
      EXPECT_NEAR(to[0][n], root * root, 1e-6) << k->simd;
      for (std::size_t kind = 0; kind < to.size(); ++kind)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(to[kind][n]),
                  std::bit_cast<std::uint32_t>(looks[0][kind][n]))
            << k->simd << ' ' << kind;
    }
  }
  EXPECT_GT(facets, 10);
  EXPECT_GT(without, 10);
}

}  // namespace
}  // namespace neve::render
