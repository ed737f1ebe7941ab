/// The view snow: particles as a surface with grain.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "render/snow/layer.h"
#include "snow_support.h"

namespace neve::render {
namespace {

using snow::Body;

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
  for (Vec3f& p : moved.points.position.edit()) p.x += way;
  for (GroundPlane& ground : moved.grounds) ground.point.x += way;
  moved.camera.eye.x += way;
  moved.camera.target.x += way;
  still.grounds.clear();
  moved.grounds.clear();
  for (std::uint32_t& id : moved.points.id.edit()) id += first_id;
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

/// Turns by a quarter about y, which takes the field's lattice to itself.
Vec3f quarter(Vec3f v) {
  return {v.z, v.y, -v.x};
}

/// Mean difference of a picture of snow and one of it, its light and its camera, all turned.
double difference_after_turn(render::gl::Context& context, const PackedTurn& turn) {
  Frame still = snow_ball(320, 200);
  still.grounds.clear();
  Frame turned = still;
  for (Vec3f& p : turned.points.position.edit()) p = quarter(p);
  turned.points.turn.edit().assign(turned.points.position.size(), turn);
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
    frame.points.value.edit().assign(frame.points.position.size(), value);
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
  frame.points.position.edit()[3].x = nan;
  frame.points.position.edit()[4].y = std::numeric_limits<float>::infinity();
  frame.points.position.edit()[5].z = 1e30f;
  frame.points.volume.edit().assign(frame.points.position.size(), 1e-5f);
  frame.points.volume.edit()[6] = nan;
  frame.points.volume.edit()[7] = -1;
  frame.points.volume.edit()[8] = 1e30f;
  const Image bad = renderer.draw(frame);
  frame.points.volume.edit().clear();
  frame.camera.eye = {0.01f, 0, 0};  // inside
  renderer.draw(frame);
  for (const std::size_t count : {std::size_t{1}, std::size_t{0}}) {
    frame.points.position.edit().resize(count);
    frame.points.id.edit().resize(count);
    renderer.draw(frame);
  }
  Frame nothing = torn_snow(96, 64);
  nothing.points = {};
  EXPECT_GT(compare(bad, renderer.draw(nothing)).mean, 1);
}

}  // namespace
}  // namespace neve::render
