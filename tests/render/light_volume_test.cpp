#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gl_test.h"
#include "render/light/light_fields.h"
#include "render/light/lighting.h"
#include "render/shapes/mesh_shapes.h"

namespace neve::render {
namespace {

struct Sample {
  Vec3f body;
  float key, sky;
};

/// The cell that a place lies in.
Sample sample(const render::light::LightVolume& volume, Vec3f place) {
  const Vec3f x = (place - volume.grid.origin) / volume.grid.cell;
  const auto index = [&](float v, int n) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(v), 0, n - 1));
  };
  const Vec3i n = volume.grid.size;
  const std::size_t i = (index(x.z, n.z) * static_cast<std::size_t>(n.y) + index(x.y, n.y)) *
                            static_cast<std::size_t>(n.x) +
                        index(x.x, n.x);
  const auto body = [&](std::size_t c) { return static_cast<float>(volume.body[4 * i + c]) / 127; };
  return {{body(0), body(1), body(2)},
          static_cast<float>(volume.light[2 * i]) / 65535,
          static_cast<float>(volume.light[2 * i + 1]) / 65535};
}

Frame ball() {
  Frame frame;
  frame.light.direction = {0, 1, 0};
  add_ball(frame, {0, 0, 0}, 0.3f, 0.02f);
  return frame;
}

TEST(LightVolume, LightComesFromTheLightAndNotThroughTheBody) {
  for (const Vec3f direction : {Vec3f{0, 1, 0}, Vec3f{-1, 0, 0}, Vec3f{0.1f, 0.2f, 1},
                                Vec3f{-0.6f, 0.6f, 0.5f}, Vec3f{0.3f, -1, 0.2f}}) {
    Frame frame = ball();
    frame.light.direction = direction;
    const render::light::LightVolume volume = render::light::make_light_volume(frame, {}, nullptr);
    const Vec3f l = normalized(direction);
    EXPECT_GT(sample(volume, 0.34f * l).key, 0.9f);
    EXPECT_LT(sample(volume, -0.34f * l).key, 0.1f);
    EXPECT_LT(sample(volume, {0, 0, 0}).key, 0.2f);
  }
}

TEST(LightVolume, SkyIsOpenAboveAndClosedBelow) {
  const render::light::LightVolume volume = render::light::make_light_volume(ball(), {}, nullptr);
  EXPECT_GT(sample(volume, {0, 0.34f, 0}).sky, 0.9f);
  EXPECT_LT(sample(volume, {0, -0.33f, 0}).sky, 0.4f);
}

TEST(LightVolume, BodyNormalPointsOutward) {
  const render::light::LightVolume volume = render::light::make_light_volume(ball(), {}, nullptr);
  for (const Vec3f n : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, -1}, Vec3f{0.6f, -0.8f, 0}}) {
    const Vec3f body = sample(volume, 0.3f * n).body;
    EXPECT_GT(length(body), 0.5f);
    EXPECT_GT(dot(normalized(body), n), 0.95f);
  }
}

TEST(LightVolume, StrayHasHardlyABody) {
  Frame frame = ball();
  add_point(frame, {0.5f, 0.2f, 0});
  const render::light::LightVolume volume = render::light::make_light_volume(frame, {}, nullptr);
  EXPECT_LT(length(sample(volume, {0.5f, 0.2f, 0}).body), 0.3f);
  EXPECT_GT(sample(volume, {0.5f, 0.25f, 0}).key, 0.9f);
}

TEST(LightVolume, LightVolumeDependsNeitherOnOrderNorOnThreads) {
  Frame frame = ball();
  for (int i = 0; i < 4; ++i)  // enough for several parts
    frame.points.position.edit().insert(frame.points.position.end(), frame.points.position.begin(),
                                        frame.points.position.begin() + 10000);
  ASSERT_GT(frame.points.position.size(), 40000u);
  const render::light::LightVolume one = render::light::make_light_volume(frame, {}, nullptr);
  for (const int threads : {2, 3, 5}) {
    ThreadPool pool(threads);
    std::ranges::reverse(frame.points.position.edit());
    const render::light::LightVolume many = render::light::make_light_volume(frame, {}, &pool);
    EXPECT_EQ(one.body, many.body);
    EXPECT_EQ(one.light, many.light);
  }
}

TEST(Lighting, LightingComputesAVolumeOnlyAfterAChangeOfItsInputs) {
  render::light::Lighting lighting;
  Frame frame = ball();
  frame.meshes.push_back(render::shapes::box_mesh({0, 0.5f, 0}, {0.4f, 0.05f, 0.4f}));
  const std::uint64_t first = lighting.volume(frame, {}, nullptr).serial;
  EXPECT_NE(first, 0u);
  // Another view of the same state.
  frame.camera.eye = {3, 2, 1};
  frame.points.value.edit().assign(frame.points.position.size(), 0.5f);
  frame.width = 33;
  EXPECT_EQ(lighting.volume(frame, {}, nullptr).serial, first);

  std::uint64_t last = first;
  const auto expect_new = [&](const char* what) {
    const render::light::LightVolume& volume = lighting.volume(frame, {}, nullptr);
    EXPECT_NE(volume.serial, last) << what;
    last = volume.serial;
    const render::light::LightVolume fresh = render::light::make_light_volume(frame, {}, nullptr);
    EXPECT_EQ(volume.body, fresh.body) << what;
    EXPECT_EQ(volume.light, fresh.light) << what;
    EXPECT_EQ(volume.grid.origin, fresh.grid.origin) << what;
  };
  frame.points.position.edit().back().x += 1e-3f;
  expect_new("a point");
  frame.points.position.edit().pop_back();
  expect_new("fewer points");
  frame.points.spacing *= 1.5f;
  expect_new("the spacing, and with it a smaller grid in the same memory");
  frame.light.direction.x += 0.5f;
  expect_new("the light");
  frame.meshes[0].position.edit()[0].y += 0.1f;
  expect_new("a vertex");
  std::vector<std::uint32_t>& index = frame.meshes[0].index.edit();
  std::swap(index[0], index[4]);
  expect_new("a face");
  frame.meshes.clear();
  expect_new("no mesh");
}

TEST(LightGrid, FarStrayDoesNotCoarsenIt) {
  Frame frame = ball();
  const render::light::LightGrid without = render::light::fit_light_grid(frame.points, {});
  for (const Vec3f stray : {Vec3f{1e6f, 0, 0}, Vec3f{0, -1e30f, 3}, Vec3f{NAN, INFINITY, 0}})
    add_point(frame, stray);
  const render::light::LightGrid with = render::light::fit_light_grid(frame.points, {});
  EXPECT_LE(with.cell, 1.3f * without.cell);
  const render::light::LightVolume volume = render::light::make_light_volume(frame, {}, nullptr);
  EXPECT_LT(sample(volume, {0, 0, 0}).key, 0.2f);
}

TEST(LightGrid, LightGridStaysWithin96CellsAndAroundThePoints) {
  Frame frame;
  for (const float extent : {1e-5f, 1.0f, 1e5f}) {
    frame.points.position = {{0, 0, 0}, {extent, 0.5f * extent, 0.1f * extent}};
    const render::light::LightGrid grid = render::light::fit_light_grid(frame.points, {});
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(grid.size[axis], 96);
      EXPECT_LT(grid.origin[axis], 0);
      EXPECT_GT(grid.origin[axis] + grid.cell * static_cast<float>(grid.size[axis]),
                frame.points.position[1][axis]);
    }
  }
  frame.points.position.edit().clear();
  EXPECT_EQ(render::light::fit_light_grid(frame.points, {}).count(), 1u);
}

TEST(LightVolume, MeshNearTheSnowThrowsAShadow) {
  Frame frame = ball();
  frame.meshes.push_back(render::shapes::box_mesh({0, 0.5f, 0}, {0.4f, 0.05f, 0.4f}));
  EXPECT_LT(sample(render::light::make_light_volume(frame, {}, nullptr), {0, 0.35f, 0}).key, 0.1f);
}

/// Faces of 20 km leave no hole in a metre of snow, and of a ball of 60 000 of them few are looked
/// at: this took minutes, where each face had half a million samples.
TEST(LightVolume, FacesFarLargerThanTheSnowThrowAWholeShadow) {
  const render::light::LightGrid grid{{-0.5f, -0.5f, -0.5f}, 1.0f / 64, {64, 64, 64}};
  std::vector<Vec3f> places{
      {-1e4f, 0.001f, -1e4f}, {1e4f, 0.001f, -1e4f}, {-1e4f, 0.001f, 1e4f}, {1e4f, 0.001f, 1e4f}};
  std::vector<std::uint32_t> corners{0, 1, 2, 2, 1, 3};
  for (std::size_t corner = 0; corner < 4; ++corner)
    places.push_back(places[corner] + Vec3f{0, 3, 0});
  for (int pair = 0; pair < 30'000; ++pair)
    for (const std::uint32_t corner : {4u, 5u, 6u, 6u, 5u, 7u}) corners.push_back(corner);
  TriangleMesh floor;
  floor.position = places;
  floor.index = corners;
  const std::vector<float> solid = render::light::voxelize({floor}, grid);
  std::size_t marked = 0;
  for (std::size_t cell = 0; cell < solid.size(); ++cell) {
    const bool is_floor = cell / 64 % 64 == 32;
    EXPECT_EQ(solid[cell] != 0, is_floor) << cell;
    marked += solid[cell] != 0;
  }
  EXPECT_EQ(marked, 64u * 64u);
}

TEST(LightGrid, FarOrHugeMeshDoesNotCoarsenIt) {
  const Frame frame = ball();
  const float cell = render::light::fit_light_grid(frame.points, {}).cell;
  EXPECT_EQ(
      render::light::fit_light_grid(frame.points, {render::shapes::box_mesh({50, 0, 0}, {1, 1, 1})})
          .cell,
      cell);
  EXPECT_LE(render::light::fit_light_grid(frame.points,
                                          {render::shapes::box_mesh({0, -20, 0}, {40, 39, 40})})
                .cell,
            3 * cell);
}

}  // namespace
}  // namespace neve::render
