/// The CPU splatter: the picture of OpenGL, whatever the threads and the instruction set.

#include "render/cpu/splat.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "both_ways.h"
#include "gl_test.h"
#include "render/light/light_fields.h"
#include "render/shapes/mesh_shapes.h"

namespace neve::render {
namespace {

void add_values(Frame& frame) {
  for (const Vec3f& p : frame.points.position) frame.points.value.edit().push_back(p.y + 0.4f);
}

TEST(Splat, SplattingDrawsThePictureOfOpenGl) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = rough_ball(320, 200);
  expect_same_picture(*context, frame, "snow");
  frame.supersampling = 2;
  expect_same_picture(*context, frame, "2x2 samples");
  frame.supersampling = 1;
  frame.meshes.push_back(render::shapes::box_mesh({0.3f, 0, 0.3f}, {0.2f, 0.3f, 0.2f}));
  add_values(frame);
  expect_same_picture(*context, frame, "attributes behind and before a mesh");
  frame.camera.target = {-0.7f, 0.5f, 0.3f};
  frame.camera.fov = 75;
  expect_same_picture(*context, frame, "off the axis");
}

TEST(Splat, SplattingDrawsThePictureOfOpenGlNearAndFar) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = rough_ball(320, 200);
  frame.camera = {.eye = {0, 0, 0.45f}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 60};
  expect_same_picture(*context, frame, "the eye at the surface");
  frame.camera.eye = {0.05f, 0.02f, 0.1f};  // spheres all around, some across the plane of the eye
  expect_same_picture(*context, frame, "the eye among the spheres");
  frame.camera.eye = {30, 10, 40};
  frame.camera.fov = 3;
  expect_same_picture(*context, frame, "small");
  frame.camera.eye = {60, 20, 80};
  frame.camera.fov = 6;
  expect_same_picture(*context, frame, "smaller than a sample");
}

TEST(Splat, SphereThatFillsThePictureIsTheSame) {
  OPEN_OR_SKIP(context, "auto");
  // The spheres are in front, so near that they fill the picture, and beside, across the eye's
  // plane.
  for (const Vec3f center :
       {Vec3f{0.1f, 0.2f, 0.8f}, Vec3f{0.1f, 0.2f, 0.95f}, Vec3f{1, 0.2f, 1.9f}}) {
    Frame frame = small_frame(160, 100);
    frame.points.radius = 0.9f;
    frame.camera.fov = 100;
    add_point(frame, center);
    expect_same_picture(*context, frame, "at z = " + std::to_string(center.z));
  }
}

/// Result of a splat, row by row.
struct Samples {
  std::vector<float> inverse;
  std::vector<Vec3f> normal;
  std::vector<int> kind;
  std::vector<std::uint32_t> albedo;
  friend bool operator==(const Samples&, const Samples&) = default;
};

Samples splat(const Frame& frame, const render::cpu::DrawKernels& kernels, ThreadPool* pool) {
  Samples all;
  render::cpu::Splatter splatter(kernels);
  splatter.prepare(frame.points, make_view(frame.camera, frame.width, frame.height), pool);
  const auto tiles = static_cast<std::size_t>(splatter.columns() * splatter.rows());
  std::vector<render::light::GBufferTile> drawn(tiles);
  render::light::for_each_task(static_cast<int>(tiles), pool, [&](int tile) {
    splatter.draw_tile(tile, drawn[static_cast<std::size_t>(tile)]);
  });
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const render::light::GBufferTile& tile = drawn[static_cast<std::size_t>(
          y / render::light::tile_height * splatter.columns() + x / render::light::tile_width)];
      const int at = y % render::light::tile_height * render::light::tile_width +
                     x % render::light::tile_width;
      const bool is_there = tile.kind[at] != render::light::kind_nothing;
      EXPECT_EQ(is_there, tile.inverse[at] > 0);
      all.inverse.push_back(tile.inverse[at]);
      all.kind.push_back(tile.kind[at]);
      all.albedo.push_back(is_there ? tile.albedo[at] : 0);
      all.normal.push_back(is_there ? Vec3f{tile.normal_x[at], tile.normal_y[at], tile.normal_z[at]}
                                    : Vec3f{});
    }
  }
  return all;
}

TEST(Splat, SplattingDependsNeitherOnThreadsNorOnTheInstructionSet) {
  for (const float fov : {2.0f, 40.0f, 120.0f}) {
    Frame frame = rough_ball(300, 170);  // no whole tiles
    frame.camera.fov = fov;
    const Samples plain = splat(frame, render::cpu::draw_baseline, nullptr);
    for (const int threads : {2, 3, 7}) {
      ThreadPool pool(threads);
      EXPECT_TRUE(splat(frame, render::cpu::draw_baseline, &pool) == plain)
          << threads << " threads";
    }
    EXPECT_TRUE(splat(frame, render::cpu::chosen_draw_kernels(), nullptr) == plain)
        << render::cpu::chosen_draw_kernels().simd;
  }
}

TEST(Splat, OrderOfPointsDoesNotMatterAndEqualsGoByTheirId) {
  Frame frame = rough_ball(200, 150);
  add_values(frame);
  const std::vector<Vec3f>& p = frame.points.position;
  const Vec3f nearest = *std::min_element(p.begin(), p.end(), [&](Vec3f a, Vec3f b) {
    return length(a - frame.camera.eye) < length(b - frame.camera.eye);
  });
  add_point(frame, nearest);  // in the same place, another colour
  frame.points.value.edit().push_back(1);
  const Samples one = splat(frame, render::cpu::chosen_draw_kernels(), nullptr);
  std::ranges::reverse(frame.points.position.edit());
  std::ranges::reverse(frame.points.id.edit());
  std::ranges::reverse(frame.points.value.edit());
  EXPECT_TRUE(splat(frame, render::cpu::chosen_draw_kernels(), nullptr) == one);
  std::ranges::reverse(frame.points.id.edit());
  EXPECT_FALSE(splat(frame, render::cpu::chosen_draw_kernels(), nullptr) == one) << "ids of others";
}

TEST(Splat, HidingChangesNothing) {
  // Hiding omits what lies behind: the front half without it is the same.
  Frame frame = rough_ball(300, 200);
  const Samples all = splat(frame, render::cpu::chosen_draw_kernels(), nullptr);
  const Vec3f toward_eye = normalized(frame.camera.eye);
  Points shell = frame.points;
  shell.position.edit().clear();
  shell.id.edit().clear();
  for (std::size_t i = 0; i < frame.points.position.size(); ++i) {
    const Vec3f p = frame.points.position[i];
    if (length(p) < 0.25f || dot(p, toward_eye) < -0.25f) continue;
    shell.position.edit().push_back(p);
    shell.id.edit().push_back(frame.points.id[i]);
  }
  ASSERT_LT(shell.position.size(), frame.points.position.size() * 4 / 5);
  frame.points = shell;
  EXPECT_TRUE(splat(frame, render::cpu::chosen_draw_kernels(), nullptr) == all);
}

/// The expected depth is that of the quadratic equation of the ray and the sphere, in double.
TEST(Splat, DepthAndNormalAreThoseOfTheSphere) {
  for (const Vec3f center :
       {Vec3f{0.1f, -0.2f, 0}, Vec3f{0.5f, 0.4f, -3}, Vec3f{0.3f, 0.3f, 1.6f}}) {
    Frame frame = small_frame(160, 120);
    frame.camera.fov = 70;
    frame.points.radius = 0.2f;
    add_point(frame, center);
    const Samples drawn = splat(frame, render::cpu::chosen_draw_kernels(), nullptr);
    const View view = make_view(frame.camera, 160, 120);
    int hits = 0;
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        const double sx = (x + 0.5 - 80) / view.pixels_per_slope;
        const double sy = (y + 0.5 - 60) / view.pixels_per_slope;
        // The camera looks along -z, so the axes of the view are x, y and -z.
        const double c[3] = {center.x, center.y, 2.0 - center.z}, ray[3] = {sx, sy, 1};
        double rr = 0, rc = 0, cc = -0.2 * 0.2;
        for (int k = 0; k < 3; ++k) rr += ray[k] * ray[k], rc += ray[k] * c[k], cc += c[k] * c[k];
        const double D = rc * rc - rr * cc;
        const auto at = static_cast<std::size_t>(y * 160 + x);
        if (std::abs(D) < 1e-5) continue;  // rounding decides on the outline
        ASSERT_EQ(drawn.inverse[at] > 0, D > 0) << x << " " << y;
        if (D < 0) continue;
        ++hits;
        const double z = (rc - std::sqrt(D)) / rr;
        // Some ten roundings of 6e-8, and near the outline the root makes them larger.
        EXPECT_NEAR(static_cast<double>(drawn.inverse[at]) * z, 1, 4e-6);
        const double n[3] = {(z * sx - c[0]) / 0.2, (z * sy - c[1]) / 0.2, (c[2] - z) / 0.2};
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(static_cast<double>(drawn.normal[at][k]), n[k], 1e-4) << x << " " << y;
        EXPECT_EQ(drawn.kind[at], render::light::kind_snow);
      }
    }
    EXPECT_GT(hits, 30);
  }
}

TEST(Splat, EnvironmentChoosesThePathAndErrorsListTheChoices) {
  OPEN_OR_SKIP(context, "auto");
  const char* before = std::getenv("NEVE_PARTICLES");
  const std::string kept = before ? before : "";
  ::setenv("NEVE_PARTICLES", "gl", 1);
  EXPECT_EQ(Renderer(*context).particle_path(), ParticlePath::gl);
  ::setenv("NEVE_PARTICLES", "cpu", 1);
  EXPECT_EQ(Renderer(*context).particle_path(), ParticlePath::cpu);
  EXPECT_EQ(Renderer(*context, {}, nullptr, ParticlePath::gl).particle_path(), ParticlePath::gl);
  ::setenv("NEVE_PARTICLES", "gpu", 1);
  EXPECT_THROW(Renderer{*context}, ParticlePathError);
  ::setenv("NEVE_PARTICLES", "", 1);
  EXPECT_EQ(Renderer(*context).particle_path(),
            context->is_software ? ParticlePath::cpu : ParticlePath::gl);
  before ? ::setenv("NEVE_PARTICLES", kept.c_str(), 1) : ::unsetenv("NEVE_PARTICLES");
}

}  // namespace
}  // namespace neve::render
