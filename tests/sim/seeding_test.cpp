#include "sim/seeding/seeding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "sim/seeding/sampling.h"
#include "sim/shapes/solid.h"
#include "tests/support/temporary_folder.h"

namespace neve::sim {
namespace {

constexpr sim::seeding::Sampling samplings[] = {sim::seeding::Sampling::jittered,
                                                sim::seeding::Sampling::poisson,
                                                sim::seeding::Sampling::lattice};

sim::seeding::Body body_of(const sim::shapes::Shape& shape, sim::seeding::Sampling sampling,
                           double particles_per_cell = 8) {
  sim::seeding::Body body;
  body.shape = shape;
  body.sampling = sampling;
  body.particles_per_cell = particles_per_cell;
  return body;
}

std::vector<sim::shapes::Shape> shapes() {
  const Vec3d c(0.25, 1, -0.5), turn(20, 30, 40);
  return {{sim::shapes::Sphere{c, 0.3}, turn},
          {sim::shapes::Box{c, {0.4, 0.5, 0.6}}, turn},
          {sim::shapes::Capsule{c, {0.5, 1.5, 0}, 0.2}, turn},
          {sim::shapes::Cylinder{c, 0.2, 0.7}, turn},
          {sim::shapes::Cone{c, 0.4, 0.8}, turn},
          {sim::shapes::Torus{c, 0.4, 0.15}, turn},
          {sim::shapes::Mesh{NEVE_SOURCE_DIR "/scenes/meshes/rabbit.obj", 0.8, c}, turn}};
}

std::set<std::array<double, 3>> as_set(const std::vector<Vec3d>& points) {
  std::set<std::array<double, 3>> set;
  for (const Vec3d& x : points) set.insert({x.x(), x.y(), x.z()});
  return set;
}

double smallest_distance(std::vector<Vec3d> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec3d& a, const Vec3d& b) { return a.x() < b.x(); });
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < points.size(); ++p)
    for (std::size_t q = p + 1; q < points.size() && points[q].x() - points[p].x() < smallest; ++q)
      smallest = std::min(smallest, (points[p] - points[q]).norm());
  return smallest;
}

TEST(Seeding, ParticlesLieInsideTheirShapeAndFillIt) {
  for (const sim::shapes::Shape& shape : shapes())
    for (const sim::seeding::Sampling sampling : samplings) {
      const sim::seeding::SeededBody seeded =
          sim::seeding::seed_body(body_of(shape, sampling), 0, 1, 0.04);
      const sim::shapes::Solid solid(shape);
      sim::shapes::Bounds seen{seeded.x[0], seeded.x[0]};
      for (const Vec3d& x : seeded.x) {
        // A place on the surface may round outside, there and back through the rotation.
        const Vec3d inward = x + 1e-12 * (solid.center() - x);
        EXPECT_TRUE(solid.contains(x) || solid.contains(inward));
        seen.min = seen.min.cwiseMin(x);
        seen.max = seen.max.cwiseMax(x);
      }
      const sim::shapes::Bounds b = sim::shapes::bounds(shape);
      EXPECT_TRUE((seen.min.array() >= b.min.array() - 1e-12).all());
      EXPECT_TRUE((seen.max.array() <= b.max.array() + 1e-12).all());
      // The last particles before a corner may be a few spacings of 0.02 away.
      EXPECT_LT((seen.min - b.min).maxCoeff(), 0.08) << shape.form.index();
      EXPECT_LT((b.max - seen.max).maxCoeff(), 0.08) << shape.form.index();
    }
}

TEST(Seeding, CountFollowsVolumeAndParticlesPerCell) {
  for (const double per_cell : {0.5, 1.0, 8.0, 10.0})
    for (const sim::shapes::Shape& shape : shapes())
      for (const sim::seeding::Sampling sampling : samplings) {
        const double h = std::cbrt(sim::shapes::volume(shape) * per_cell / 5000);
        const sim::seeding::Body body = body_of(shape, sampling, per_cell);
        const auto count = static_cast<double>(sim::seeding::seed_body(body, 0, 1, h).x.size());
        const bool is_lattice =
            sampling == sim::seeding::Sampling::lattice;  // layers fit or do not
        EXPECT_NEAR(count / 5000, 1, is_lattice ? 0.1 : 0.03)
            << shape.form.index() << " by sampling " << static_cast<int>(sampling);
        const sim::seeding::SeedingPlan plan = sim::seeding::plan_seeding(body, h);
        EXPECT_NEAR(static_cast<double>(plan.particle_count) / count, 1, is_lattice ? 0.1 : 0.03);
        EXPECT_EQ(plan.volume, sim::shapes::volume(shape));
      }
}

TEST(Seeding, LatticeOfABoxThatFitsIsExact) {
  const sim::seeding::Body body =
      body_of({sim::shapes::Box{{0.1, 0.2, 0.3}, {0.4, 0.2, 0.6}}, {0, 0, 0}},
              sim::seeding::Sampling::lattice);
  const sim::seeding::SeededBody seeded = sim::seeding::seed_body(body, 0, 1, 0.1);
  EXPECT_EQ(seeded.x.size(), 8u * 4u * 12u);
  EXPECT_EQ(sim::seeding::plan_seeding(body, 0.1).particle_count, 384u);
  Vec3d mean = Vec3d::Zero();
  for (const Vec3d& x : seeded.x) mean += x / 384;
  EXPECT_LT((mean - Vec3d(0.1, 0.2, 0.3)).norm(), 1e-14);
  EXPECT_NEAR(smallest_distance(seeded.x), 0.05, 1e-14);
}

TEST(Seeding, PlanCountsTheLayerOfASheetThinnerThanTheSpacing) {
  const sim::seeding::Body sheet = body_of({sim::shapes::Box{{0, 0, 0}, {2, 0.001, 2}}, {0, 0, 0}},
                                           sim::seeding::Sampling::lattice);
  EXPECT_EQ(sim::seeding::seed_body(sheet, 0, 1, 0.1).x.size(), 1600u);
  EXPECT_EQ(sim::seeding::plan_seeding(sheet, 0.1).particle_count, 1600u);
}

TEST(Seeding, MovingABodyMovesItsParticlesWithIt) {
  // Values of few bits, so that adding the offset is exact: the same bits, moved.
  const Vec3d dyadic(1024.0, -0.25, 3.5), decimal(0.0317, 12.21, -7.7);
  for (const sim::seeding::Sampling sampling : samplings) {
    const auto seeded_at = [&](const Vec3d& center) {
      return sim::seeding::seed_body(
                 body_of({sim::shapes::Sphere{center, 0.25}, {0, 0, 0}}, sampling), 2, 7, 0.0625)
          .x;
    };
    const std::vector<Vec3d> origin = seeded_at({0, 0, 0}), moved = seeded_at(dyadic),
                             shifted = seeded_at(decimal);
    ASSERT_EQ(origin.size(), moved.size());
    ASSERT_EQ(origin.size(), shifted.size());
    for (std::size_t p = 0; p < origin.size(); ++p) {
      EXPECT_EQ(Vec3d(origin[p] + dyadic), moved[p]);
      EXPECT_LT((origin[p] + decimal - shifted[p]).norm(), 1e-12);
    }
  }
}

TEST(Seeding, RotatingABodyRotatesItsParticles) {
  const Vec3d c(1, 2, 3), turn(30, 60, -20);
  for (const sim::seeding::Sampling sampling : samplings) {
    const auto upright =
        sim::seeding::seed_body(body_of({sim::shapes::Cone{c, 0.2, 0.5}, {0, 0, 0}}, sampling), 0,
                                1, 0.05)
            .x;
    const auto turned = sim::seeding::seed_body(
                            body_of({sim::shapes::Cone{c, 0.2, 0.5}, turn}, sampling), 0, 1, 0.05)
                            .x;
    ASSERT_EQ(upright.size(), turned.size());
    for (std::size_t p = 0; p < upright.size(); ++p)
      EXPECT_LT((c + rotation_from_degrees(turn) * (upright[p] - c) - turned[p]).norm(), 1e-13);
  }
}

TEST(Seeding, SeedAndBodyIndexKeyThePlacement) {
  for (const sim::seeding::Sampling sampling :
       {sim::seeding::Sampling::jittered, sim::seeding::Sampling::poisson}) {
    const sim::seeding::Body body =
        body_of({sim::shapes::Sphere{{0, 0, 0}, 0.3}, {0, 0, 0}}, sampling);
    const auto first = as_set(sim::seeding::seed_body(body, 0, 1, 0.05).x);
    EXPECT_EQ(first, as_set(sim::seeding::seed_body(body, 0, 1, 0.05).x));
    for (const auto& [index, seed] : {std::pair{0u, 2u}, {1u, 1u}, {1u, 0u}}) {
      const auto other = as_set(sim::seeding::seed_body(body, index, seed, 0.05).x);
      std::vector<std::array<double, 3>> shared;
      std::set_intersection(first.begin(), first.end(), other.begin(), other.end(),
                            std::back_inserter(shared));
      EXPECT_TRUE(shared.empty()) << index << " " << seed;
    }
  }
}

TEST(Seeding, JitteredPutsOneParticleIntoEverySubCell) {
  const sim::seeding::Body body = body_of({sim::shapes::Box{{0, 0, 0}, {1, 1, 1}}, {0, 0, 0}},
                                          sim::seeding::Sampling::jittered);
  std::set<std::array<double, 3>> cells;
  const sim::seeding::SeededBody seeded = sim::seeding::seed_body(body, 0, 1, 0.25);
  for (const Vec3d& x : seeded.x)
    cells.insert({std::floor(x.x() / 0.125), std::floor(x.y() / 0.125), std::floor(x.z() / 0.125)});
  EXPECT_EQ(seeded.x.size(), 512u);
  EXPECT_EQ(cells.size(), 512u);
}

TEST(Seeding, PoissonKeepsItsDistance) {
  for (const sim::shapes::Shape& shape : shapes()) {
    const sim::seeding::Body body = body_of(shape, sim::seeding::Sampling::poisson, 5);
    const double distance =
        sim::seeding::poisson_distance_in_spacings * sim::seeding::particle_spacing(5, 0.05);
    const double smallest = smallest_distance(sim::seeding::seed_body(body, 0, 1, 0.05).x);
    EXPECT_GE(smallest, distance * (1 - 1e-12));
    EXPECT_LT(smallest, 1.02 * distance);  // and uses it up: thousands of pairs come close
  }
}

TEST(Seeding, NeighboursInTheListAreNear) {
  for (const sim::seeding::Sampling sampling : samplings) {
    const auto x =
        sim::seeding::seed_body(
            body_of({sim::shapes::Box{{0, 0, 0}, {1, 1, 1}}, {0, 0, 0}}, sampling), 0, 1, 0.1)
            .x;
    double sum = 0;
    for (std::size_t p = 1; p < x.size(); ++p) sum += (x[p] - x[p - 1]).norm();
    // Random order would be 0.66 on average.
    EXPECT_LT(sum / static_cast<double>(x.size()), 0.2);
  }
}

TEST(Seeding, TinyShapesGetOneParticle) {
  for (const sim::shapes::Shape& shape : shapes())
    for (const sim::seeding::Sampling sampling : samplings) {
      const sim::seeding::SeededBody seeded =
          sim::seeding::seed_body(body_of(shape, sampling), 0, 1, 1000);
      ASSERT_GE(seeded.x.size(), 1u);
      EXPECT_LE(seeded.x.size(), 8u);  // the lattice's cells at the centre may hold one each
      EXPECT_TRUE(sim::shapes::contains(shape, seeded.x[0])) << shape.form.index();
    }
}

TEST(Seeding, AbsurdSizesSaturateThePlanAndAreRefused) {
  sim::seeding::Body body = body_of({sim::shapes::Box{{0, 0, 0}, {1e90, 1e90, 1e90}}, {0, 0, 0}},
                                    sim::seeding::Sampling::jittered);
  EXPECT_EQ(sim::seeding::plan_seeding(body, 1e-3).particle_count,
            std::numeric_limits<std::size_t>::max());
  EXPECT_THROW(sim::seeding::seed_body(body, 0, 1, 1e-3), ShapeError);
  // Few particles, but bounds too large to look through.
  body.shape = {sim::shapes::Torus{{0, 0, 0}, 1e6, 1e-3}, {0, 0, 0}};
  EXPECT_THROW(sim::seeding::seed_body(body, 0, 1, 0.05), ShapeError);
}

TEST(Seeding, MeshesFarFromTheirOriginAreRefused) {
  const neve::test::TemporaryFolder folder;
  const std::string path = (folder / "far.obj").string();
  std::ofstream(path) << "v 1e15 0 0\nv 1000000000000001 0 0\nv 1e15 1 0\nv 1e15 0 1\n"
                         "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const sim::seeding::Body body =
      body_of({sim::shapes::Mesh{path, 1, {0, 0, 0}}, {0, 0, 0}}, sim::seeding::Sampling::jittered);
  EXPECT_THROW(sim::seeding::seed_body(body, 0, 1, 0.02), ShapeError);
}

TEST(Seeding, ShapesTurnAboutTheirCentre) {
  EXPECT_EQ(
      sim::seeding::seed_body(body_of({sim::shapes::Capsule{{0, 0, 0}, {2, 2, 2}, 0.5}, {0, 0, 0}},
                                      sim::seeding::Sampling::jittered),
                              0, 1, 0.5)
          .center,
      Vec3d(1, 1, 1));
}

TEST(Seeding, NeedlesAreGivenUpInsteadOfSearchedForADay) {
  sim::seeding::Body body;
  body.shape.form = sim::shapes::Box{{0, 0, 0}, {1e4, 1e-5, 1e-5}};
  body.sampling = sim::seeding::Sampling::poisson;
  // One particle's worth of snow in 10 km: whatever is placed, it is placed soon.
  EXPECT_GE(sim::seeding::seed_body(body, 0, 1, 0.02).x.size(), 1u);
}

}  // namespace

}  // namespace neve::sim
