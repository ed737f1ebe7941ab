/// The CPU splatter: the picture of OpenGL, whatever the threads and the instruction set.

#include "render/splat.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gl_test.h"
#include "render/mesh_shapes.h"

namespace neve::render {
namespace {

/// A ball off the lattice, so that no two spheres are alike.
Frame rough_ball(int width, int height) {
  Frame frame = small_frame(width, height);
  frame.camera = {.eye = {0.9f, 0.6f, 1.4f}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 40};
  frame.light.direction = {-0.6f, 0.6f, 0.5f};
  frame.grounds.push_back({.point = {0, -0.42f, 0}});
  add_ball(frame, {0, 0, 0}, 0.4f, 0.025f);
  for (std::size_t i = 0; i < frame.points.position.size(); ++i) {
    const float x = static_cast<float>(i);
    frame.points.position[i] =
        frame.points.position[i] + 0.01f * Vec3f{std::sin(x), std::sin(2.3f * x), std::sin(5 * x)};
  }
  return frame;
}

void add_values(Frame& frame) {
  for (const Vec3f& p : frame.points.position) frame.points.value.push_back(p.y + 0.4f);
}

/// Draws a frame both ways. Where both agree on which sphere a sample shows, its colour differs by
/// what 8-bit albedo, half normals and rounding of the depth leave: 1 or 2 of 255. On the edge of a
/// sphere, and where two meet, rounding decides which one a sample shows, and a pixel may differ by
/// anything; those may be one in two thousand.
void expect_same_picture(Context& context, const Frame& frame, const std::string& what) {
  Renderer gl(context, {}, nullptr, ParticlePath::gl), cpu(context, {}, nullptr, ParticlePath::cpu);
  const Image a = gl.draw(frame), b = cpu.draw(frame);
  int other = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 3) {
    int largest = 0;
    for (std::size_t c = 0; c < 3; ++c)
      largest = std::max(largest, std::abs(int{a.pixels[i + c]} - int{b.pixels[i + c]}));
    if (largest > 2) ++other;
  }
  EXPECT_LE(other, frame.width * frame.height / 2000) << what;
  EXPECT_LE(compare(a, b).mean, 0.02) << what;
  Frame nothing = frame;
  nothing.points = {};
  EXPECT_GT(compare(a, gl.draw(nothing)).mean, 0.1) << what << ": nothing is there to compare";
}

TEST(Splat, DrawsThePictureOfOpenGl) {
  OPEN_OR_SKIP(context, "auto");
  Frame frame = rough_ball(320, 200);
  expect_same_picture(*context, frame, "snow");
  frame.supersampling = 2;
  expect_same_picture(*context, frame, "2x2 samples");
  frame.supersampling = 1;
  frame.meshes.push_back(box_mesh({0.3f, 0, 0.3f}, {0.2f, 0.3f, 0.2f}));
  add_values(frame);
  expect_same_picture(*context, frame, "attributes behind and before a mesh");
  frame.camera.target = {-0.7f, 0.5f, 0.3f};
  frame.camera.fov = 75;
  expect_same_picture(*context, frame, "off the axis");
}

TEST(Splat, DrawsThePictureOfOpenGlNearAndFar) {
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
  // In front, so near that it fills the picture, and beside the eye, reaching across its plane.
  for (const Vec3f center :
       {Vec3f{0.1f, 0.2f, 0.8f}, Vec3f{0.1f, 0.2f, 0.95f}, Vec3f{1, 0.2f, 1.9f}}) {
    Frame frame = small_frame(160, 100);
    frame.points.radius = 0.9f;
    frame.camera.fov = 100;
    add_point(frame, center);
    expect_same_picture(*context, frame, "at z = " + std::to_string(center.z));
  }
}

/// All bands of a splat put together.
struct Samples {
  int width = 0, height = 0;
  std::vector<float> depth;
  std::vector<std::uint16_t> normal_kind;
  std::vector<std::uint32_t> albedo;
  friend bool operator==(const Samples&, const Samples&) = default;
};

Samples splat(const Frame& frame, const SplatKernels& kernels, ThreadPool* pool) {
  Samples all;
  all.width = frame.width;
  all.height = frame.height;
  const auto count = static_cast<std::size_t>(all.width * all.height);
  all.depth.resize(count, 1);
  all.normal_kind.resize(4 * count);
  all.albedo.resize(count);
  Splatter splatter(kernels);
  splatter.draw(frame.points, make_view(frame.camera, frame.width, frame.height), pool,
                [&](const SplatBand& band) {
                  for (int y = 0; y < band.height; ++y) {
                    const std::ptrdiff_t to = (band.y + y) * std::ptrdiff_t{all.width} + band.x;
                    const std::ptrdiff_t from = y * std::ptrdiff_t{band.pitch};
                    std::copy_n(band.depth + from, band.width, all.depth.begin() + to);
                    std::copy_n(band.albedo + from, band.width, all.albedo.begin() + to);
                    std::copy_n(band.normal_kind + 4 * from, 4 * band.width,
                                all.normal_kind.begin() + 4 * to);
                  }
                });
  return all;
}

TEST(Splat, DependsNeitherOnThreadsNorOnTheInstructionSet) {
  for (const float fov : {2.0f, 40.0f, 120.0f}) {
    Frame frame = rough_ball(300, 170);  // no whole tiles
    frame.camera.fov = fov;
    const Samples plain = splat(frame, splat_baseline, nullptr);
    for (const int threads : {2, 3, 7}) {
      ThreadPool pool(threads);
      EXPECT_TRUE(splat(frame, splat_baseline, &pool) == plain) << threads << " threads";
    }
    EXPECT_TRUE(splat(frame, chosen_splat_kernels(), nullptr) == plain)
        << chosen_splat_kernels().simd;
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
  frame.points.value.push_back(1);
  const Samples one = splat(frame, chosen_splat_kernels(), nullptr);
  std::reverse(frame.points.position.begin(), frame.points.position.end());
  std::reverse(frame.points.id.begin(), frame.points.id.end());
  std::reverse(frame.points.value.begin(), frame.points.value.end());
  EXPECT_TRUE(splat(frame, chosen_splat_kernels(), nullptr) == one);
  std::reverse(frame.points.id.begin(), frame.points.id.end());
  EXPECT_FALSE(splat(frame, chosen_splat_kernels(), nullptr) == one) << "ids of others";
}

TEST(Splat, HidingChangesNothing) {
  // Without what lies behind, which is what hiding leaves out, the front half is the same.
  Frame frame = rough_ball(300, 200);
  const Samples all = splat(frame, chosen_splat_kernels(), nullptr);
  const Vec3f toward_eye = normalized(frame.camera.eye);
  Points shell = frame.points;
  shell.position.clear();
  shell.id.clear();
  for (std::size_t i = 0; i < frame.points.position.size(); ++i) {
    const Vec3f p = frame.points.position[i];
    if (length(p) < 0.25f || dot(p, toward_eye) < -0.25f) continue;
    shell.position.push_back(p);
    shell.id.push_back(frame.points.id[i]);
  }
  ASSERT_LT(shell.position.size(), frame.points.position.size() * 4 / 5);
  frame.points = shell;
  EXPECT_TRUE(splat(frame, chosen_splat_kernels(), nullptr) == all);
}

float half_to_float(std::uint16_t h) {
  const float magnitude =
      std::ldexp(static_cast<float>((h & 0x3ffu) | 0x400u), static_cast<int>(h >> 10 & 0x1fu) - 25);
  return (h & 0x7fffu) == 0 ? 0 : (h & 0x8000u) ? -magnitude : magnitude;
}

/// In double, from the quadratic equation of the ray and the sphere.
TEST(Splat, DepthAndNormalAreThoseOfTheSphere) {
  for (const Vec3f center :
       {Vec3f{0.1f, -0.2f, 0}, Vec3f{0.5f, 0.4f, -3}, Vec3f{0.3f, 0.3f, 1.6f}}) {
    Frame frame = small_frame(160, 120);
    frame.camera.fov = 70;
    frame.points.radius = 0.2f;
    add_point(frame, center);
    const Samples drawn = splat(frame, chosen_splat_kernels(), nullptr);
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
        ASSERT_EQ(drawn.depth[at]<1, D> 0) << x << " " << y;
        if (D < 0) continue;
        ++hits;
        const double z = (rc - std::sqrt(D)) / rr;
        // One step of a float at 1 is 6e-8; a handful of operations.
        EXPECT_NEAR(drawn.depth[at], 1 - static_cast<double>(view.near_distance) / z, 5e-7);
        const double n[3] = {(z * sx - c[0]) / 0.2, (z * sy - c[1]) / 0.2, (c[2] - z) / 0.2};
        // Halves below 1 have steps of up to 5e-4; near the outline the root doubles the error.
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(half_to_float(drawn.normal_kind[4 * at + k]), n[k], 1e-3) << x << " " << y;
        EXPECT_EQ(half_to_float(drawn.normal_kind[4 * at + 3]), 3);
      }
    }
    EXPECT_GT(hits, 30);
  }
}

TEST(Splat, EnvironmentChoosesThePathAndErrorsSayWhatThereIs) {
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
