/// Surfaces and smoke drawn and lit on the CPU: the picture of OpenGL, whatever the threads and the
/// instruction set.

#include "render/cpu/surfaces.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "both_ways.h"
#include "render/cpu/smoke_march.h"
#include "render/light/smoke_cache.h"
#include "render/passes/solid_cache.h"
#include "render/shapes/mesh_shapes.h"
#include "smoke_support.h"

namespace neve::render {
namespace {

Frame ball_in_smoke() {
  Frame frame = rough_ball(320, 200);
  frame.meshes.push_back(render::shapes::box_mesh({0.35f, -0.2f, 0.3f}, {0.2f, 0.4f, 0.2f}));
  frame.smoke = make_smoke({-0.6f, -0.4f, -0.6f}, {0.6f, 0.5f, 0.6f}, 0.04f, [](Vec3f p) {
    return std::max(0.0f, 0.1f * std::exp(-8 * std::abs(length(p) - 0.5f)) - 0.02f);
  });
  return frame;
}

void color_smoke(Frame& frame) {
  for (std::size_t i = 0; i < frame.smoke.density.size(); ++i)
    frame.smoke.value.edit().push_back(0.5f + 0.5f * std::sin(0.01f * static_cast<float>(i)));
}

Frame ball_in_slices() {
  Frame frame = rough_ball(320, 200);
  Arrows arrows;
  HeatMap map;
  map.corner = {-0.7f, -0.1f, -0.7f};
  map.across = {1.4f, 0, 0};
  map.up = {0, 0, 1.4f};
  map.columns = map.rows = 9;
  map.isoline_step = 0.2f;
  arrows.length_per_value = 0.2f;
  arrows.max_length = 0.2f;
  for (int k = 0; k < 81; ++k) {
    const Vec3f p = {0.17f * static_cast<float>(k % 9 - 4), 0.1f,
                     0.17f * static_cast<float>(k / 9 - 4)};
    arrows.position.edit().push_back(p);
    arrows.vector.edit().push_back({-p.z, 0.3f, p.x});
    map.value.edit().push_back(length(p));
  }
  frame.arrows.push_back(arrows);
  frame.heat_maps.push_back(map);
  return frame;
}

TEST(Surfaces, SlicesHideAndAreHiddenAsByOpenGl) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = ball_in_slices();
  expect_same_picture(*context, frame, "arrows and a heat map");
  frame.supersampling = 2;
  expect_same_picture(*context, frame, "2x2 samples");
}

TEST(Surfaces, GhostsAndLinesAreHiddenAsByOpenGl) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = rough_ball(320, 200);
  frame.ghosts.push_back(render::shapes::box_mesh({0.2f, 0, 0.1f}, {0.9f, 0.3f, 0.9f}));
  frame.lines.push_back(
      {.ends = {{-0.6f, 0, -0.6f}, {0.6f, 0.2f, 0.6f}, {0, -0.5f, 0}, {0, 0.6f, 0}}});
  expect_same_picture(*context, frame, "lines through a ball in a ghost");
}

TEST(Surfaces, SmokeIsThatOfOpenGl) {
  OPEN_OR_SKIP(context, "auto");
  for (const int samples : {1, 2, 3, 4}) {
    Frame frame = ball_in_smoke();
    frame.smoke.samples_per_ray = samples;
    expect_same_picture(*context, frame, "white, " + std::to_string(samples));
    color_smoke(frame);
    expect_same_picture(*context, frame, "coloured, " + std::to_string(samples));
  }
  Frame frame = ball_in_smoke();
  frame.camera.eye = {0.1f, 0.45f, 0.2f};
  expect_same_picture(*context, frame, "from within");
}

TEST(Surfaces, TransparentPictureIsThatOfOpenGl) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = ball_in_smoke();
  frame.is_transparent = true;
  Renderer gl(*context, {}, nullptr, ParticlePath::gl),
      cpu(*context, {}, nullptr, ParticlePath::cpu);
  const Image a = gl.draw(frame), b = cpu.draw(frame);
  ASSERT_EQ(a.channels, 4);
  int other = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
    // Nearly transparent pixels have their colour from a few levels of a premultiplied byte.
    if (a.pixels[i + 3] < 32 && b.pixels[i + 3] < 32) continue;
    for (std::size_t c = 0; c < 4; ++c)
      other += std::abs(int{a.pixels[i + c]} - int{b.pixels[i + c]}) > 8;
  }
  EXPECT_LE(other, frame.width * frame.height / 1000);
}

TEST(Surfaces, SurfacesAreLitWithoutALightVolume) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = small_frame(200, 150);  // no points: the volume is a single cell
  frame.grounds.push_back({.point = {0, -0.3f, 0}});
  frame.camera.eye = {0, 0.8f, 2};
  frame.arrows = ball_in_slices().arrows;
  expect_same_picture(*context, frame, "arrows over a ground");
}

/// The finished samples of a frame.
std::vector<std::uint32_t> lit_samples(const Frame& frame, const render::cpu::DrawKernels& kernels,
                                       ThreadPool* pool) {
  const View view = make_view(frame.camera, frame.width, frame.height);
  const render::light::SmokeGrid grid = render::light::make_smoke_grid(frame.smoke, nullptr);
  const render::light::LightVolume light = render::light::make_light_volume(frame, grid, nullptr);
  render::cpu::Surfaces surfaces(pool, kernels);
  surfaces.prepare(frame, view, frame.points);
  std::optional<render::light::SmokeCover> cover;
  render::cpu::SmokeMarch march(pool, kernels);
  if (!grid.is_empty()) {
    surfaces.keep_points();
    surfaces.keep_grounds();
    cover = march.march(frame.smoke, grid,
                        render::light::make_smoke_volume(
                            grid, light, render::light::toward_light(frame.light), nullptr),
                        frame.light, surfaces, view);
    EXPECT_TRUE(cover);
  }
  surfaces.shade(light, cover ? &*cover : nullptr, true);
  std::vector<std::uint32_t> samples;
  for (int y = 0; y < frame.height; ++y) {
    const std::ptrdiff_t row = y * std::ptrdiff_t{surfaces.pitch()};
    samples.insert(samples.end(), surfaces.picture() + row, surfaces.picture() + row + frame.width);
    for (int x = 0; x < frame.width; ++x) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, surfaces.depth() + row + x, sizeof bits);
      samples.push_back(bits);
    }
  }
  return samples;
}

TEST(Surfaces, DependNeitherOnThreadsNorOnTheInstructionSet) {
  for (const int what : {0, 1, 2, 3}) {
    Frame frame = what == 0 ? rough_ball(301, 173) : ball_in_smoke();  // no whole tiles
    if (what == 2) color_smoke(frame);
    if (what == 3) frame.is_transparent = true;
    const std::vector<std::uint32_t> plain =
        lit_samples(frame, render::cpu::draw_baseline, nullptr);
    ThreadPool pool(3);
    EXPECT_TRUE(lit_samples(frame, render::cpu::draw_baseline, &pool) == plain) << what;
    EXPECT_TRUE(lit_samples(frame, render::cpu::chosen_draw_kernels(), nullptr) == plain)
        << what << ", " << render::cpu::chosen_draw_kernels().simd;
    frame.light.intensity *= 0.9f;
    EXPECT_FALSE(lit_samples(frame, render::cpu::draw_baseline, nullptr) == plain)
        << "light counts";
  }
}

TEST(Surfaces, KeptTilesGiveTheSamePicture) {
  const Frame frame = rough_ball(301, 173);
  const View view = make_view(frame.camera, frame.width, frame.height);
  const render::light::LightVolume light = render::light::make_light_volume(frame, {}, nullptr);
  render::cpu::Surfaces kept(nullptr), tile_by_tile(nullptr);
  kept.prepare(frame, view, frame.points);
  kept.keep_points();
  kept.keep_grounds();
  kept.keep_solids();
  kept.shade(light, nullptr, false);
  tile_by_tile.prepare(frame, view, frame.points);
  tile_by_tile.shade(light, nullptr, false);
  const auto samples = static_cast<std::size_t>(kept.pitch()) * 173;
  EXPECT_EQ(std::memcmp(kept.picture(), tile_by_tile.picture(), 4 * samples), 0);
}

// ---- what is kept from one picture to the next --------------------------------------------------

TEST(Values, CopiesShareAnArrayUntilOneIsEdited) {
  Values<float> a{1, 2, 3};
  Values<float> b = a;
  EXPECT_EQ(b.data(), a.data());
  b.edit()[1] = 5;
  EXPECT_EQ(a[1], 2);
  EXPECT_EQ(b[1], 5);
  const float* own = b.data();
  b.edit()[1] = 6;
  EXPECT_EQ(b.data(), own) << "an array of one owner is not copied";
}

TEST(Values, AreEqualWhereTheirBytesAre) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  using Floats = Values<float>;
  EXPECT_EQ(Floats({1, nan}), Floats({1, nan}));
  EXPECT_FALSE(Floats({0.0f}) == Floats({-0.0f}));
  EXPECT_FALSE(Floats({1}) == Floats({1, 1}));
  EXPECT_EQ(Floats(), Floats(std::vector<float>()));
}

TEST(SolidCache, SolidCacheHoldsOnlyWhatIsTheSame) {
  Frame frame = ball_in_slices();
  frame.meshes.push_back(render::shapes::box_mesh({0, 0, 0}, {0.2f, 0.2f, 0.2f}));
  const auto view_of = [](const Frame& f) { return make_view(f.camera, f.width, f.height); };
  render::passes::SolidCache cache;
  EXPECT_FALSE(cache.holds(frame, view_of(frame)));
  cache.renew(frame, view_of(frame));
  Frame other = frame;
  other.points.position.edit().clear();
  other.light.intensity = 0.5f;
  other.caption = {"another moment"};
  EXPECT_TRUE(cache.holds(other, view_of(other))) << "it has no solid";
  const auto expect_new = [&](const char* what, const auto& change) {
    Frame changed = frame;
    change(changed);
    EXPECT_FALSE(cache.holds(changed, view_of(changed))) << what;
  };
  expect_new("camera", [](Frame& f) { f.camera.eye.x += 0.01f; });
  expect_new("size", [](Frame& f) { f.width += 1; });
  expect_new("samples", [](Frame& f) { f.supersampling = 2; });
  expect_new("vertex", [](Frame& f) { f.meshes[0].position.edit()[3].y += 0.01f; });
  expect_new("colour", [](Frame& f) { f.meshes[0].color.x += 0.01f; });
  expect_new("mesh", [](Frame& f) { f.meshes.push_back(f.meshes[0]); });
  expect_new("value", [](Frame& f) { f.heat_maps[0].value.edit()[5] += 0.01f; });
  expect_new("range", [](Frame& f) { f.heat_maps[0].range_max += 0.01f; });
  expect_new("arrow", [](Frame& f) { f.arrows[0].vector.edit()[5].y += 0.01f; });
  expect_new("cover", [](Frame& f) { f.heat_maps[0].cover = std::vector<float>(81, 0.0f); });
  expect_new("middle", [](Frame& f) { f.arrows[0].is_centred = true; });
  expect_new("white", [](Frame& f) { f.arrows[0].is_white = true; });
  expect_new("arrow's colours", [](Frame& f) { f.arrows[0].colormap = ColorMap::magma; });
}

TEST(SmokeCache, SmokeCacheRecomputesOnlyChangedSmoke) {
  Frame frame = ball_in_smoke();
  render::light::SmokeCache cache;
  render::light::Lighting lighting;
  const auto ask = [&] {
    const render::light::SmokeGrid& grid = cache.grid(frame.smoke, nullptr);
    const render::light::LightVolume& light = lighting.volume(frame, grid, nullptr);
    const Vec3f toward = render::light::toward_light(frame.light);
    const render::light::SmokeVolume& volume = cache.volume(light, toward, nullptr);
    EXPECT_EQ(grid.opacity, render::light::make_smoke_grid(frame.smoke, nullptr).opacity);
    EXPECT_EQ(volume.texels, render::light::make_smoke_volume(grid, light, toward, nullptr).texels);
    return cache.renewals();
  };
  EXPECT_EQ(ask(), 2u);
  frame.camera.eye.x += 1;
  frame.smoke.samples_per_ray = 4;
  EXPECT_EQ(ask(), 2u) << "another view of the same";
  frame.light.direction.x += 0.3f;
  EXPECT_EQ(ask(), 3u) << "another light on the same grid";
  frame.points.position.edit()[0].x += 0.3f;
  EXPECT_EQ(ask(), 4u) << "another shadow on it";
  frame.smoke.density.edit()[700] += 10;
  EXPECT_EQ(ask(), 6u) << "a node";
  color_smoke(frame);
  EXPECT_EQ(ask(), 8u) << "values";
  frame.smoke.range_max += 0.5f;
  EXPECT_EQ(ask(), 10u) << "their range";
  frame.smoke.nodes = std::make_shared<NodeLattice>(*frame.smoke.nodes);
  EXPECT_EQ(ask(), 12u) << "a lattice that may be another";
}

TEST(Surfaces, CachesDoNotShowInThePicture) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, ParticlePath::cpu);
  Frame frame = ball_in_smoke();
  frame.arrows = ball_in_slices().arrows;
  const auto expect_as_new = [&](const char* what) {
    Renderer fresh(*context, {}, nullptr, ParticlePath::cpu);
    EXPECT_EQ(renderer.draw(frame).pixels, fresh.draw(frame).pixels) << what;
  };
  expect_as_new("the first");
  expect_as_new("the same again");
  for (Vec3f& p : frame.points.position.edit()) p.x += 0.05f;
  expect_as_new("solids kept, points moved");
  frame.smoke = {};
  expect_as_new("no smoke any more");
  frame.heat_maps = ball_in_slices().heat_maps;
  expect_as_new("a heat map");
  frame.heat_maps[0].cover = std::vector<float>(81, 0.0f);
  expect_as_new("nothing of it shown");
  frame.arrows[0].is_centred = true;
  expect_as_new("arrows with their middle at their places");
  frame.arrows[0].is_white = true;
  expect_as_new("white arrows");
  frame.camera.eye.x += 0.2f;
  expect_as_new("another camera");
  frame.arrows.clear();
  frame.meshes.clear();
  expect_as_new("no solids any more");
}

}  // namespace
}  // namespace neve::render
