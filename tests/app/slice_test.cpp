/// Slices: the shape of the snow on a plane, streamlines, the scale bar.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/picture/scale_bar.h"
#include "app/picture/slice_parts.h"
#include "app/picture/slice_shape.h"
#include "app/picture/streamlines.h"
#include "render/frame/view.h"

namespace neve::app::picture {
namespace {

using Eigen::Vector2d;
using sim::Vec3d;

constexpr double spacing = 0.01, density = 400;

/// Particles in rest, on a lattice, where `is_inside` says so.
template <class Inside>
sim::ParticleArrays lattice(const Inside& is_inside) {
  sim::ParticleArrays particles;
  for (int i = -40; i < 40; ++i)
    for (int j = -40; j < 40; ++j)
      for (int k = -4; k < 4; ++k) {
        const Vec3d x = spacing * Vec3d(i + 0.5, j + 0.5, k + 0.5);
        if (!is_inside(x)) continue;
        particles.x.push_back(x);
        particles.V0.push_back(spacing * spacing * spacing);
        particles.F_E.push_back(sim::Mat3d::Identity());
        particles.J_P.push_back(1);
        particles.material.push_back(0);
        particles.m.push_back(density * spacing * spacing * spacing);
      }
  return particles;
}

scene::Scene scene_of_snow() {
  scene::Scene scene;
  scene.solver.cell_size = 2 * spacing;
  scene.materials.resize(1);
  scene.materials[0].density = density;
  return scene;
}

SlicePlane front(double z = 0) {
  return {Vec3d(0, 0, z), Vec3d(0, 0, 1), Vec3d(1, 0, 0), Vec3d(0, 1, 0)};
}

double area(const SliceShape& shape) {
  double count = 0;
  for (int row = 0; row < shape.rows(); ++row)
    for (int column = 0; column < shape.columns(); ++column)
      count += shape.cover(column, row) >= 0.5f;
  return count * shape.rectangle().width() / shape.columns() * shape.rectangle().height() /
         shape.rows();
}

TEST(SliceShape, IsAsLargeAsTheSnowThatItCuts) {
  const double radius = 0.2;
  const SliceShape ball(scene_of_snow(),
                        lattice([&](const Vec3d& x) { return x.head<2>().norm() < radius; }),
                        spacing, front());
  // The cubes around the particles inside are 0.8 % larger than the disc that they fill.
  EXPECT_NEAR(area(ball), std::numbers::pi * radius * radius, 0.04 * radius * radius);
}

TEST(SliceShape, ASheetThinnerThanACellIsDrawn) {
  // One particle thick, half of a cell: the nodes around it carry its mass over four cells.
  const SliceShape sheet(scene_of_snow(),
                         lattice([](const Vec3d& x) { return x.y() > 0 && x.y() < spacing; }),
                         spacing, front());
  const double thickness = area(sheet) / (80 * spacing);
  EXPECT_GT(thickness, 0.6 * spacing);
  EXPECT_LT(thickness, 1.5 * spacing);
}

TEST(SliceShape, IsEmptyBesideTheSnow) {
  const auto all = [](const Vec3d&) { return true; };
  EXPECT_TRUE(SliceShape(scene_of_snow(), lattice(all), spacing, front(0.08)).is_empty());
  EXPECT_TRUE(SliceShape(scene_of_snow(), {}, spacing, front()).is_empty());
}

/// Nodes of a plane with velocity along x, mass everywhere.
FieldSamples field_of_wind(double h, int blocks) {
  auto lattice = std::make_shared<render::NodeLattice>();
  lattice->spacing = static_cast<float>(h);
  for (int i = -blocks; i < blocks; ++i)
    for (int j = -blocks; j < blocks; ++j)
      for (int k = -1; k < 1; ++k) lattice->block.push_back({i, j, k});
  FieldSamples fields;
  fields.density.assign(64 * lattice->block.size(), 400.0f);
  fields.vectors[scene::VectorField::velocity].assign(64 * lattice->block.size(), {1, 0, 0});
  fields.lattice = lattice;
  return fields;
}

TEST(SliceArrows, NodesNearAPointHaveAnArrowEach) {
  const double h = 2 * spacing;
  const SliceShape shape(scene_of_snow(), lattice([](const Vec3d&) { return true; }), spacing,
                         front());
  const FieldSamples fields = field_of_wind(h, 6);
  scene::View view;
  view.slice.every = 4;
  view.slice.range = scene::Range{0, 100};  // all arrows are below what is shown elsewhere
  const SlicePlane plane = front();
  const SliceMoment slice{view, fields, plane, shape, 100, 720};
  render::Frame frame;
  EXPECT_EQ(add_arrows(slice, frame).every, 4);
  ASSERT_EQ(frame.arrows.size(), 1u);
  EXPECT_EQ(frame.arrows[0].position.size(), 0u) << "one in a hundred of the longest is a dot";
  // The point may lie before the plane.
  view.slice.dense_near = Vec3d(0.1, 0.05, 0.3);
  frame.arrows.clear();
  EXPECT_EQ(add_arrows(slice, frame).longest_near, 1);
  ASSERT_EQ(frame.arrows.size(), 2u);
  EXPECT_NEAR(frame.arrows[1].length_per_value, frame.arrows[1].max_length, 1e-6f) << "1 m/s";
  // Nodes of a disc of four cells.
  EXPECT_NEAR(double(frame.arrows[1].position.size()), std::numbers::pi * 16, 6);
  EXPECT_LE(frame.arrows[1].max_length, float(h));
  for (std::size_t k = 0; k < frame.arrows[1].position.size(); ++k) {
    const Vec3f at = frame.arrows[1].position[k];
    EXPECT_LT(std::hypot(at.x - 0.1f, at.y - 0.05f), 4 * float(h));
    EXPECT_EQ(at.z, 0);
  }
}

StreamlineStyle unit_square(double distance) {
  StreamlineStyle style;
  style.distance = distance;
  style.step = 0.1 * distance;
  style.shortest = distance;
  style.low = {-1, -1};
  style.high = {1, 1};
  return style;
}

double closest(const std::vector<Streamline>& lines) {
  double least = 1e300;
  for (std::size_t a = 0; a < lines.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (const Vector2d& x : lines[a])
        for (const Vector2d& y : lines[b]) least = std::min(least, (x - y).norm());
  return least;
}

TEST(Streamlines, FollowTheFieldAndKeepTheirDistance) {
  const PlaneField whirl = [](const Vector2d& x) -> std::optional<Vector2d> {
    return x.norm() < 0.9 ? std::optional(Vector2d(-x.y(), x.x())) : std::nullopt;
  };
  const std::vector<Streamline> lines = streamlines(whirl, unit_square(0.1));
  ASSERT_GT(lines.size(), 4u);
  for (const Streamline& line : lines)
    // The midpoint rule loses (step/r)^3/8 of the radius a step; a turn has 2 pi r / step of them.
    for (const Vector2d& x : line) EXPECT_NEAR(x.norm(), line.front().norm(), 0.002);
  EXPECT_GE(closest(lines), 0.5 * 0.1 * 0.999);
}

TEST(Streamlines, FillTheRegion) {
  const PlaneField wind = [](const Vector2d&) { return std::optional(Vector2d(3, 1)); };
  const std::vector<Streamline> lines = streamlines(wind, unit_square(0.1));
  for (double x = -0.8; x < 0.81; x += 0.1)
    for (double y = -0.8; y < 0.81; y += 0.1) {
      double least = 1e300;
      for (const Streamline& line : lines)
        for (const Vector2d& at : line) least = std::min(least, (at - Vector2d(x, y)).norm());
      // No place is farther from a line than the distance from line to line.
      EXPECT_LT(least, 0.1) << x << " " << y;
    }
}

TEST(Streamlines, AreNoneWhereTheFieldIsNone) {
  const PlaneField none = [](const Vector2d&) { return std::optional<Vector2d>(); };
  EXPECT_TRUE(streamlines(none, unit_square(0.1)).empty());
  const PlaneField rest = [](const Vector2d&) { return std::optional(Vector2d(0, 0)); };
  EXPECT_TRUE(streamlines(rest, unit_square(0.1)).empty());
  const PlaneField broken = [](const Vector2d&) {
    return std::optional(Vector2d(std::nan(""), 1));
  };
  EXPECT_TRUE(streamlines(broken, unit_square(0.1)).empty());
}

TEST(ScaleBar, IsAsLongAsItSaysInThePicture) {
  scene::View view;
  view.layers = {scene::Layer::heatmap, scene::Layer::scale};
  render::Frame frame;
  frame.camera = {{0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 30};
  add_scale_bar(view, {}, front(0.5), frame);
  ASSERT_TRUE(frame.scale_bar);
  EXPECT_EQ(frame.scale_bar->text, "20 cm");
  const render::View seen = render::make_view(frame.camera, frame.width, frame.height);
  const float length = seen.project({0.2f, 0, 0.5f}).x - seen.project({0, 0, 0.5f}).x;
  EXPECT_NEAR(frame.scale_bar->pixels, length, 0.01f);
}

TEST(ScaleBar, SaysWhereItHoldsAndIsNoneBehindTheEye) {
  scene::View view;
  Snapshot snapshot;
  snapshot.particles = lattice([](const Vec3d&) { return true; });
  render::Frame frame;
  frame.camera = {{0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 30};
  add_scale_bar(view, snapshot, front(), frame);
  ASSERT_TRUE(frame.scale_bar);
  EXPECT_NE(frame.scale_bar->text.find("at the middle of the snow"), std::string::npos);
  render::Frame behind;
  behind.camera = {{0, 0, -3}, {0, 0, -4}, {0, 1, 0}, 30};
  add_scale_bar(view, snapshot, front(), behind);
  EXPECT_FALSE(behind.scale_bar);
  render::Frame empty;
  empty.camera = frame.camera;
  add_scale_bar(view, {}, front(), empty);
  EXPECT_FALSE(empty.scale_bar) << "there is no snow whose middle it could be at";
}

}  // namespace
}  // namespace neve::app::picture
