#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "gl_test.h"
#include "render/light/smoke_volume.h"
#include "render/shapes/mesh_shapes.h"
#include "smoke_support.h"

namespace neve::render {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Undoes tone mapping and gamma of shaders/shade.frag.
double linear(double level) {
  const double y = std::pow(level / 255, 2.2);
  // y (1 + 0.55 c) = c (1 + c / 4.84), c = 0.8 of what was there.
  const double b = 1 - 0.55 * y, c = 4.84 * (-b + std::sqrt(b * b + 4 * y / 4.84)) / 2;
  return c / 0.8;
}

/// Mean linear green of a square of pixels around the middle.
double middle(const Image& image) {
  double sum = 0;
  for (int y = -6; y <= 6; ++y) {
    for (int x = -6; x <= 6; ++x)
      sum += linear(pixel(image, image.width / 2 + x, image.height / 2 + y).g);
  }
  return sum / 169;
}

/// Share of the background that a slab across the view, of this many layers of nodes, passes. In
/// the dark, so that it gives no light of its own.
double opacity_of_slab(Renderer& renderer, int layers, float share, float scale, int samples) {
  Frame frame = small_frame(160, 120);
  frame.light.intensity = frame.light.ambient = 0;
  const double open = middle(renderer.draw(frame));
  constexpr float h = 0.02f;
  const float last = h * (static_cast<float>(layers) - 0.5f);
  frame.smoke = make_smoke({-0.4f, -0.3f, 0}, {0.4f, 0.3f, last}, h,
                           [&](Vec3f p) { return p.z > -0.5f * h && p.z < last ? share : 0.0f; });
  frame.smoke.density_scale = scale;
  frame.smoke.samples_per_ray = samples;
  return 1 - middle(renderer.draw(frame)) / open;
}

TEST(Smoke, OpacityIsThatOfBeerAndLambert) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  // Layers of nodes are as thick as their spacing, with linear flanks on both sides.
  const double per_layer = -std::log(0.4) / 3;
  struct Case {
    int layers;
    float share, scale;
  };
  for (const Case c : {Case{3, 1, 1}, {1, 1, 1}, {8, 0.2f, 1}, {3, 1, 0.3f}, {4, 0.01f, 2}}) {
    const double expected =
        1 - std::exp(-per_layer * c.layers * c.scale * std::pow(double{c.share}, 0.7));
    for (const int samples : {1, 2}) {
      // Half a level of the darkened background is 1 %, and the start of each ray is jittered.
      EXPECT_NEAR(opacity_of_slab(renderer, c.layers, c.share, c.scale, samples), expected, 0.02)
          << c.layers << " layers of " << c.share << " times " << c.scale;
    }
  }
}

TEST(Smoke, ThreeLayersOfPackedSnowReachSixtyPercentAndPowderShows) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  EXPECT_NEAR(opacity_of_slab(renderer, 3, 1, 1, 2), 0.6, 0.02);
  EXPECT_GT(opacity_of_slab(renderer, 3, 0.02f, 1, 2), 0.03);
}

/// Red in the middle with a red plate at a depth, seen through smoke between -0.3 and 0.3.
int red_of_plate(Renderer& renderer, float z, bool has_smoke) {
  Frame frame = small_frame();
  frame.meshes.push_back(render::shapes::box_mesh({0, 0, z}, {0.3f, 0.3f, 0.01f}));
  frame.meshes[0].color = {0.6f, 0.02f, 0.02f};
  if (has_smoke)
    frame.smoke =
        make_smoke({-0.3f, -0.3f, -0.3f}, {0.3f, 0.3f, 0.3f}, 0.05f, [](Vec3f) { return 0.1f; });
  const Pixel p = pixel(renderer.draw(frame), 60, 45);
  return p.r - p.b;
}

TEST(Smoke, SmokeIsHiddenByWhatIsInFrontAndHidesWhatIsBehind) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const int open = red_of_plate(renderer, 0.6f, false);
  ASSERT_GT(open, 80);
  // Before the smoke only the light on the plate differs a little.
  EXPECT_NEAR(red_of_plate(renderer, 0.6f, true), open, 12);
  const int near = red_of_plate(renderer, 0.15f, true), far = red_of_plate(renderer, -0.15f, true),
            behind = red_of_plate(renderer, -0.6f, true);
  EXPECT_LT(near, open - 10);
  EXPECT_LT(far, near - 10);
  EXPECT_LT(behind, far - 5);
}

TEST(Smoke, EmptySmokeChangesNoPixel) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  add_ball(frame, {0, 0, 0}, 0.2f, 0.03f);
  const Image without = renderer.draw(frame);
  frame.smoke = smoke_ball({0, 0, 0}, 0.2f, 0.03f);
  const Smoke ball = frame.smoke;
  EXPECT_NE(renderer.draw(frame).pixels, without.pixels);
  for (const float nothing : {0.0f, -1.0f, nan, std::numeric_limits<float>::infinity()}) {
    std::ranges::fill(frame.smoke.density.edit(), nothing);
    EXPECT_EQ(renderer.draw(frame).pixels, without.pixels) << nothing;
  }
  frame.smoke = ball;
  frame.smoke.density_scale = 0;
  EXPECT_EQ(renderer.draw(frame).pixels, without.pixels);
  frame.smoke = {};
  frame.smoke.nodes = std::make_shared<NodeLattice>();
  EXPECT_EQ(renderer.draw(frame).pixels, without.pixels);
}

Frame ball_of_smoke() {
  Frame frame = small_frame(160, 120);
  frame.smoke = smoke_ball({0, 0, 0}, 0.25f, 0.02f);
  return frame;
}

TEST(Smoke, SameFrameGivesTheSameBytes) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = ball_of_smoke();
  add_ball(frame, {0.2f, 0, 0.1f}, 0.1f, 0.02f);
  frame.meshes.push_back(render::shapes::box_mesh({-0.2f, 0, 0.1f}, {0.2f, 0.2f, 0.2f}));
  Renderer renderer(*context);
  const Image first = renderer.draw(frame);
  renderer.draw(small_frame(77, 41));
  EXPECT_EQ(renderer.draw(frame).pixels, first.pixels);
  ThreadPool pool(3);
  Renderer with_threads(*context, {}, &pool);
  EXPECT_EQ(with_threads.draw(frame).pixels, first.pixels);
}

TEST(Smoke, LightFromTheSideLeavesTheFarSideDark) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = ball_of_smoke();
  frame.light.direction = {-1, 0.2f, 0.1f};
  const Image image = renderer.draw(frame);
  const Pixel lit = pixel(image, 64, 60), dark = pixel(image, 96, 60);
  EXPECT_GT(lit.brightness(), dark.brightness() + 40);
  EXPECT_GT(dark.b, dark.r);  // and blue rather than grey
}

TEST(Smoke, SmokeThrowsAShadowOnTheGroundAndLiesInThatOfMeshes) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(160, 120);
  frame.camera = {.eye = {0, 1.8f, 1.8f}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 40};
  frame.light.direction = {-1, 1, 0};
  frame.grounds.push_back({.point = {0, -0.3f, 0}, .line_spacing = 10});
  const auto at = [&](Vec3f place) {
    const Vec3f p = make_view(frame.camera, frame.width, frame.height).project(place);
    return pixel(renderer.draw(frame), static_cast<int>(p.x),
                 frame.height - 1 - static_cast<int>(p.y))
        .brightness();
  };
  const Vec3f in_shadow = {0.4f, -0.3f, 0};
  const int open = at(in_shadow);
  frame.smoke = smoke_ball({0.1f, 0, 0}, 0.15f, 0.03f);
  EXPECT_LT(at(in_shadow), open - 15);

  const Vec3f top = {0.1f, 0.12f, 0.05f};
  const int lit = at(top);
  frame.meshes.push_back(render::shapes::box_mesh({-0.35f, 0.5f, 0}, {0.05f, 0.5f, 0.5f}));
  EXPECT_LT(at(top), lit - 15);
}

TEST(Smoke, HalfResolutionIsCloseToFullAndKeepsEdges) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(301, 201);  // odd: the last ray covers less than the others
  frame.smoke = make_smoke({-0.4f, -0.3f, -0.3f}, {0.4f, 0.3f, 0.3f}, 0.03f, [](Vec3f p) {
    return 0.15f + 0.1f * std::sin(9 * p.x) * std::cos(11 * p.y);
  });
  frame.meshes.push_back(render::shapes::box_mesh({-0.2f, 0, 0}, {0.05f, 0.5f, 0.05f}));
  add_ball(frame, {0.2f, 0, 0}, 0.12f, 0.02f);
  frame.smoke.samples_per_ray = 1;
  const Image full = renderer.draw(frame);
  frame.smoke.samples_per_ray = 2;
  const Image half = renderer.draw(frame);
  frame.smoke.samples_per_ray = 4;
  const Image quarter = renderer.draw(frame);
  EXPECT_NE(half.pixels, full.pixels);
  EXPECT_LT(compare(full, half).mean, 1);
  EXPECT_LT(compare(full, quarter).mean, 1.5);
  // A halo would be a line of pixels along each edge, 2 % of the picture.
  std::size_t far_off = 0;
  for (std::size_t i = 0; i < full.pixels.size(); i += 3)
    far_off += std::abs(full.pixels[i] - half.pixels[i]) > 16;
  EXPECT_LT(far_off, full.pixels.size() / 3 / 500);
}

TEST(Smoke, RaysAreAsFarApartAsItsTexelsAllow) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const auto picture = [&](float spacing, int samples) {
    Frame frame = small_frame(301, 201);
    frame.smoke = make_smoke({-0.4f, -0.3f, -0.3f}, {0.4f, 0.3f, 0.3f}, spacing,
                             [](Vec3f p) { return 0.15f + 0.1f * std::sin(9 * p.x); });
    frame.smoke.samples_per_ray = samples;
    return renderer.draw(frame).pixels;
  };
  // 301 x 201 samples: the smoke is 160 wide, so that a texel has 3 of them, or 20.
  EXPECT_EQ(picture(0.015f, 0), picture(0.015f, 2));
  EXPECT_EQ(picture(0.1f, 0), picture(0.1f, 4));
  EXPECT_NE(picture(0.1f, 4), picture(0.1f, 2));
}

TEST(Smoke, ColoursShowValues) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = ball_of_smoke();
  for (const Vec3i block : frame.smoke.nodes->block) {
    // A value without density, or not a number, must not colour anything.
    for (int n = 0; n < 64; ++n)
      frame.smoke.value.edit().push_back(4 * block.x + n / 16 < 0 ? 2.0f : 7.0f);
  }
  for (std::size_t i = 0; i < frame.smoke.density.size(); ++i) {
    if (!(frame.smoke.density[i] > 0)) frame.smoke.value.edit()[i] = i % 2 ? nan : 1e30f;
  }
  frame.smoke.range_min = 2;
  frame.smoke.range_max = 7;
  const Image image = renderer.draw(frame);
  const Pixel low = pixel(image, 60, 60), high = pixel(image, 100, 60);
  // viridis: purple at the lower end, yellow at the upper.
  EXPECT_GT(low.b, low.g + 20);
  EXPECT_GT(high.g, high.b + 60);
  EXPECT_GT(high.r, high.b + 60);
}

TEST(Smoke, SmokeCanBeLookedAtFromWithin) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = ball_of_smoke();
  frame.camera.eye = {0, 0, 0.05f};
  const Image image = renderer.draw(frame);
  for (const auto& [x, y] : {std::pair{5, 5}, {80, 60}, {155, 115}})
    EXPECT_GT(pixel(image, x, y).brightness(), 60) << x << " " << y;
}

TEST(Smoke, FarFromTheOriginLooksTheSame) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = ball_of_smoke();
  const Image here = renderer.draw(frame);
  const Vec3f shift{1024, 512, -2048};
  auto moved = std::make_shared<NodeLattice>(*frame.smoke.nodes);
  moved->origin = shift;
  frame.smoke.nodes = moved;
  frame.camera.eye = frame.camera.eye + shift;
  frame.camera.target = frame.camera.target + shift;
  EXPECT_LT(compare(here, renderer.draw(frame)).mean, 0.5);  // floats are 0.1 mm apart there
}

TEST(Smoke, SmokeThatFitsNoLatticeIsRefused) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = ball_of_smoke();
  const Smoke good = frame.smoke;
  frame.smoke.density.edit().pop_back();
  EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
  frame.smoke = good;
  frame.smoke.value = {1, 2};
  EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
  frame.smoke = good;
  for (const int samples : {-1, 5}) {
    frame.smoke.samples_per_ray = samples;
    EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
  }
  frame.smoke = good;
  auto flat = std::make_shared<NodeLattice>(*good.nodes);
  flat->spacing = 0;
  frame.smoke.nodes = flat;
  EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
}

double total(const render::light::SmokeGrid& grid) {
  double sum = 0;
  for (const float opacity : grid.opacity) sum += double{opacity};
  return sum * std::pow(double{grid.spacing}, 3);
}

TEST(SmokeGrid, TexelsLieOnNodesAndTheOutermostAreEmpty) {
  const render::light::SmokeGrid grid =
      render::light::make_smoke_grid(smoke_ball({0.3f, 0, 0}, 0.2f, 0.02f), nullptr);
  EXPECT_EQ(grid.spacing, 0.02f);
  for (int z = 0; z < grid.size.z; ++z) {
    for (int y = 0; y < grid.size.y; ++y) {
      for (int x = 0; x < grid.size.x; ++x) {
        const bool is_outermost = x == 0 || y == 0 || z == 0 || x == grid.size.x - 1 ||
                                  y == grid.size.y - 1 || z == grid.size.z - 1;
        if (!is_outermost) continue;
        EXPECT_EQ(grid.opacity[grid.index(x, y, z)], 0);
      }
    }
  }
  const Vec3f middle = (Vec3f{0.3f, 0, 0} - grid.origin) / grid.spacing;
  EXPECT_NEAR(middle.x, std::round(middle.x), 1e-3);
  EXPECT_EQ(grid.opacity[grid.index(static_cast<int>(std::lround(middle.x)),
                                    static_cast<int>(std::lround(middle.y)),
                                    static_cast<int>(std::lround(middle.z)))],
            1);
}

/// One block of packed snow at each place.
Smoke blocks_at(const std::vector<Vec3i>& places) {
  Smoke smoke;
  auto nodes = std::make_shared<NodeLattice>();
  nodes->spacing = 0.01f;
  nodes->block = places;
  smoke.density.edit().assign(64 * places.size(), smoke.full_density);
  smoke.nodes = nodes;
  return smoke;
}

TEST(SmokeGrid, StraysNeitherEnlargeNorCoarsenIt) {
  std::vector<Vec3i> places = {{-500'000'000, 0, 0}};
  for (int i = 0; i < 1000; ++i) places.push_back({i / 100, i / 10 % 10, i % 10});
  places.push_back({400'000'000, 300'000'000, -7});
  const render::light::SmokeGrid grid = render::light::make_smoke_grid(blocks_at(places), nullptr);
  EXPECT_EQ(grid.spacing, 0.01f);
  EXPECT_LE(grid.size.x, 90);
  EXPECT_NEAR(total(grid), 64'000e-6, 1e-6);
  EXPECT_EQ(render::light::strays_of(blocks_at(places)), 2u);
}

/// A crumb at some distance is coarser, and still there; so it is beside a stray beyond all sizes.
TEST(SmokeGrid, ACrumbFarFromTheRestIsDrawnCoarser) {
  std::vector<Vec3i> places;
  for (int i = 0; i < 1000; ++i) places.push_back({i / 100, i / 10 % 10, i % 10});
  places.push_back({180, 0, 0});
  const render::light::SmokeGrid grid = render::light::make_smoke_grid(blocks_at(places), nullptr);
  EXPECT_FLOAT_EQ(grid.spacing, 0.04f);
  EXPECT_NEAR(total(grid), 1001 * 64e-6, 1e-6);
  EXPECT_EQ(render::light::strays_of(blocks_at(places)), 0u);
  places.push_back({400'000'000, 0, 0});
  EXPECT_NEAR(total(render::light::make_smoke_grid(blocks_at(places), nullptr)), 1001 * 64e-6,
              1e-6);
  EXPECT_EQ(render::light::strays_of(blocks_at(places)), 1u);
}

TEST(SmokeGrid, WideSmokeLosesResolutionButNotItsSum) {
  std::vector<Vec3i> places;
  for (int i = 0; i < 300; ++i) places.push_back({i, i / 7, i % 5});
  const render::light::SmokeGrid grid = render::light::make_smoke_grid(blocks_at(places), nullptr);
  EXPECT_GT(grid.spacing, 0.03f);
  for (int axis = 0; axis < 3; ++axis) EXPECT_LE(grid.size[axis], render::light::max_smoke_side);
  EXPECT_NEAR(total(grid), 300 * 64e-6, 1e-6);
}

TEST(SmokeSpans, SpansCoverTheSmokeAlongRaysAndLittleElse) {
  const Frame frame = ball_of_smoke();
  const render::light::SmokeGrid grid = render::light::make_smoke_grid(frame.smoke, nullptr);
  const render::light::SmokeVolume volume = render::light::make_smoke_volume(
      grid, render::light::make_light_volume(frame, grid, nullptr), {0, 1, 0}, nullptr);
  const View view = make_view(frame.camera, 160, 120);
  const render::light::SmokeSpans spans = render::light::make_smoke_spans(grid, volume, view, 8);
  ASSERT_EQ(spans.columns, 20);
  const auto span = [&](int x, int y) {
    return spans.near_far.data() + 2 * ((y / 8) * spans.columns + x / 8);
  };
  EXPECT_LT(span(80, 60)[0], 2 - 0.25f);
  EXPECT_GT(span(80, 60)[1], 2 + 0.25f);
  EXPECT_GT(span(80, 60)[0], 1.6f);
  EXPECT_GT(span(4, 4)[0], span(4, 4)[1]);  // nothing in the corner
}

}  // namespace
}  // namespace neve::render
