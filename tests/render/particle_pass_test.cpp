#include <algorithm>
#include <cmath>

#include "both_ways.h"
#include "render/frame/colormap.h"
#include "render/frame/point_list.h"
#include "render/frame/view.h"

namespace neve::render {
namespace {

/// Everything here holds whatever draws the particles.
class ParticlePass : public testing::TestWithParam<ParticlePath> {};
INSTANTIATE_TEST_SUITE_P(Paths, ParticlePass, testing::Values(ParticlePath::gl, ParticlePath::cpu),
                         [](const auto& path) {
                           return path.param == ParticlePath::gl ? "Gl" : "Cpu";
                         });

/// Bounding box and area of what differs from a picture without points.
struct Silhouette {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1, area = 0;
};

Silhouette silhouette(Renderer& renderer, const Frame& frame) {
  Frame empty = frame;
  empty.points = {};
  const Image with = renderer.draw(frame), without = renderer.draw(empty);
  Silhouette s;
  for (int y = 0; y < with.height; ++y) {
    for (int x = 0; x < with.width; ++x) {
      const Pixel a = pixel(with, x, y), b = pixel(without, x, y);
      if (std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) < 8) continue;
      s.left = std::min(s.left, x);
      s.right = std::max(s.right, x);
      s.top = std::min(s.top, y);
      s.bottom = std::max(s.bottom, y);
      ++s.area;
    }
  }
  return s;
}

/// Radius in pixels of a sphere seen head on: the rays that graze it make a cone.
float radius_on_picture(const Frame& frame, float distance) {
  const View view = make_view(frame.camera, frame.width, frame.height);
  const float r = frame.points.radius;
  return view.pixels_per_slope * r / std::sqrt(distance * distance - r * r);
}

TEST_P(ParticlePass, SphereIsADiscOfItsRadiusInItsPlace) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, GetParam());
  for (const float radius : {0.05f, 0.3f}) {  // drawn as a point and as a quad
    Frame frame = small_frame();
    frame.points.radius = radius;
    add_point(frame, {0.1f, 0.05f, 0});
    const Silhouette s = silhouette(renderer, frame);
    const float r = radius_on_picture(frame, 2);
    const Vec3f center = make_view(frame.camera, 120, 90).project({0.1f, 0.05f, 0});
    EXPECT_NEAR(0.5f * static_cast<float>(s.left + s.right + 1), center.x, 1) << radius;
    EXPECT_NEAR(0.5f * static_cast<float>(s.top + s.bottom + 1), 90 - center.y, 1) << radius;
    EXPECT_NEAR(0.5f * static_cast<float>(s.right + 1 - s.left), r, 1) << radius;
    EXPECT_NEAR(0.5f * static_cast<float>(s.bottom + 1 - s.top), r, 1) << radius;
    EXPECT_NEAR(s.area, 3.1416f * r * r, 0.04f * 3.1416f * r * r + 8) << radius;
  }
}

TEST_P(ParticlePass, SphereWhoseCentreIsOutsideThePictureStillReachesIn) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, GetParam());
  Frame frame = small_frame();
  frame.points.radius = 0.04f;
  add_point(frame, {0.69f, 0, 0});  // the right edge is at 0.667
  const Silhouette s = silhouette(renderer, frame);
  EXPECT_EQ(s.right, 119);
  EXPECT_GE(s.area, 2);
}

TEST_P(ParticlePass, NearerSphereHidesTheFartherWhateverTheOrder) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, GetParam());
  for (const bool near_first : {true, false}) {
    Frame frame = small_frame();
    frame.points.radius = 0.2f;
    const Vec3f near_point{0, 0, 0.3f}, far_point{0, 0, -0.3f};
    add_point(frame, near_first ? near_point : far_point);
    add_point(frame, near_first ? far_point : near_point);
    frame.points.value = near_first ? std::vector<float>{1, 0} : std::vector<float>{0, 1};
    frame.points.colormap = ColorMap::coolwarm;
    const Pixel p = pixel(renderer.draw(frame), 60, 45);
    EXPECT_GT(p.r, p.b + 40) << near_first;  // 1 is red
  }
}

TEST_P(ParticlePass, SpheresIntersectWhereTheirSurfacesDo) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, GetParam());
  Frame frame = small_frame();
  frame.points.radius = 0.2f;
  // Side by side and overlapping: flat discs would let the nearer one win across the overlap.
  add_point(frame, {-0.1f, 0, 0.02f});
  add_point(frame, {0.1f, 0, 0});
  frame.points.value = {0, 1};
  frame.points.colormap = ColorMap::coolwarm;
  const Image image = renderer.draw(frame);
  const Pixel left = pixel(image, 55, 45), right = pixel(image, 66, 45);
  EXPECT_GT(left.b, left.r + 40);
  EXPECT_GT(right.r, right.b + 40);
}

TEST_P(ParticlePass, PictureDoesNotDependOnTheOrderOfPoints) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, GetParam());
  Frame frame = small_frame();
  add_ball(frame, {0, 0, 0}, 0.3f, 0.05f);
  // Two in the same place, told apart only by their id and colour.
  add_point(frame, frame.points.position.front());
  for (const std::uint32_t id : frame.points.id)
    frame.points.value.edit().push_back(static_cast<float>(id % 7) / 7);
  Frame reversed = frame;
  std::ranges::reverse(reversed.points.position.edit());
  std::ranges::reverse(reversed.points.id.edit());
  std::ranges::reverse(reversed.points.value.edit());
  EXPECT_EQ(renderer.draw(frame).pixels, renderer.draw(reversed).pixels);
  // The test can see a change of colour.
  Frame other = frame;
  other.points.value.edit().front() += 0.5f;
  EXPECT_NE(renderer.draw(frame).pixels, renderer.draw(other).pixels);
}

TEST(PointList, LeavingOutHiddenSpheresDoesNotChangeThePicture) {
  OPEN_OR_SKIP(context, "auto");
  context->is_software = true;  // leaves them out
  Renderer some(*context, {}, nullptr, ParticlePath::gl);
  context->is_software = false;
  Renderer all(*context, {}, nullptr, ParticlePath::gl);
  Frame frame = small_frame(320, 240);
  add_ball(frame, {0.2f, 0.1f, 0}, 0.4f, 0.04f);
  for (std::size_t i = 0; i < frame.points.position.size(); ++i) {
    const float x = static_cast<float>(i);  // off the lattice
    frame.points.position.edit()[i] =
        frame.points.position[i] + 0.015f * Vec3f{std::sin(x), std::sin(2.3f * x), std::sin(5 * x)};
    frame.points.value.edit().push_back(static_cast<float>(i % 11) / 10);
  }
  for (const float fov : {10.0f, 30.0f, 100.0f}) {
    for (const float radius : {0.004f, 0.03f, 0.05f}) {
      frame.camera.fov = fov;
      frame.points.radius = radius;
      EXPECT_EQ(some.draw(frame).pixels, all.draw(frame).pixels) << fov << " " << radius;
    }
  }
  const View view = make_view(frame.camera, 320, 240);
  EXPECT_LT(list_points(frame.points, view, 64, true, nullptr).small.size(),
            list_points(frame.points, view, 64, false, nullptr).small.size() / 2);
}

TEST(PointList, IsTheSameOnAnyNumberOfThreads) {
  Frame frame = small_frame(320, 240);
  add_ball(frame, {0.2f, 0.1f, 0}, 0.4f, 0.008f);
  frame.points.radius = 0.004f;
  const std::size_t count = frame.points.position.size();
  ASSERT_GT(count, 3 * 4096u);  // several parts
  frame.points.position.edit()[7] = {0, 0, NAN};
  frame.camera.target = {0.5f, 0.1f, 0};  // some outside
  for (std::size_t i = 0; i < count; ++i)
    frame.points.id.edit().push_back(static_cast<std::uint32_t>((i * 7919) % count));
  const View view = make_view(frame.camera, 320, 240);
  ThreadPool three(3);
  for (const float max_point_size : {64.0f, 2.5f}) {
    const PointList alone = list_points(frame.points, view, max_point_size, false, nullptr);
    const PointList many = list_points(frame.points, view, max_point_size, false, &three);
    EXPECT_GT(alone.small.size() + alone.large.size(), count / 4);
    EXPECT_LT(alone.small.size() + alone.large.size(), count);
    const auto same = [](const PointVertex& a, const PointVertex& b) {
      return a.center == b.center && std::ranges::equal(a.color, b.color);
    };
    EXPECT_TRUE(std::ranges::equal(alone.small, many.small, same));
    EXPECT_TRUE(std::ranges::equal(alone.large, many.large, same));
  }
}

TEST_P(ParticlePass, ValuesAreShownInTheColoursOfTheMap) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, GetParam());
  for (const ColorMap map :
       {ColorMap::viridis, ColorMap::magma, ColorMap::turbo, ColorMap::coolwarm}) {
    for (const float value : {0.35f, 0.6f, 0.9f}) {
      Frame frame = small_frame();
      frame.points.radius = 0.2f;
      add_point(frame, {0, 0, 0});
      frame.points.value = {10 + value * 5};
      frame.points.range_min = 10;
      frame.points.range_max = 15;
      frame.points.colormap = map;
      const Pixel p = pixel(renderer.draw(frame), 60, 45);
      const Rgb8 c = map_color(map, value);
      // Light changes brightness, not hue: compare directions, and brightness loosely.
      const float dot = static_cast<float>(p.r * c.r + p.g * c.g + p.b * c.b);
      const float size = std::sqrt(static_cast<float>(p.r * p.r + p.g * p.g + p.b * p.b)) *
                         std::sqrt(static_cast<float>(c.r * c.r + c.g * c.g + c.b * c.b));
      EXPECT_GT(dot / size, 0.985f) << static_cast<int>(map) << " at " << value;
      EXPECT_NEAR(p.brightness(), (c.r + c.g + c.b) / 3, 45)
          << static_cast<int>(map) << " " << value;
    }
  }
}

TEST_P(ParticlePass, StraysAreLitByTheirOwnSurface) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, GetParam());
  Frame frame = small_frame(240, 180);
  frame.light.direction = {0, 1, 0.3f};
  add_ball(frame, {-0.3f, 0, 0}, 0.2f, 0.05f);
  add_point(frame, {0.4f, 0, 0});
  const Vec3f p = make_view(frame.camera, 240, 180).project({0.4f, 0, 0});
  const Image image = renderer.draw(frame);
  const int x = static_cast<int>(p.x), r = static_cast<int>(radius_on_picture(frame, 2)) - 2;
  EXPECT_GT(pixel(image, x, 90 - r).brightness(), 200);
  EXPECT_LT(pixel(image, x, 90 + r).brightness(), pixel(image, x, 90 - r).brightness() - 60);
}

TEST_P(ParticlePass, SnowIsBrightWithoutBeingClipped) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, GetParam());
  Frame frame = small_frame();
  frame.light.direction = {-0.6f, 0.6f, 0.5f};
  add_ball(frame, {0, 0, 0}, 0.35f, 0.03f);
  const Image image = renderer.draw(frame);
  const int peak = *std::max_element(image.pixels.begin(), image.pixels.end());
  EXPECT_GE(peak, 230);
  EXPECT_LE(peak, 252);
}

TEST_P(ParticlePass, UnusablePositionsAreLeftOut) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, GetParam());
  Frame frame = small_frame();
  const Image nothing = renderer.draw(frame);
  for (const Vec3f p : {Vec3f{NAN, 0, 0}, Vec3f{0, INFINITY, 0}, Vec3f{0, 0, 5}, Vec3f{0, 0, 2}})
    add_point(frame, p);
  EXPECT_EQ(renderer.draw(frame).pixels, nothing.pixels);
}

}  // namespace
}  // namespace neve::render
