/// Bodies without snow: free motion and contact against closed formulas.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/bodies.h"
#include "tests/support/height_files.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(RigidBodies, FallsAndSpinsFreely) {
  shapes::Collider ball = ball_of(700, {0, 1, 0}, 0.1, {1, 2, 0});
  ball.angular_velocity = {0, 3, 0};
  BodiesAlone world({ball});
  world.run(0.5, 1e-4);
  // Symplectic Euler is late by half a step: g t dt / 2.
  EXPECT_LE((world.pose(0).point - Vec3d(0.5, 1 + 1 - 9.81 * 0.125, 0)).norm(), 3e-4);
  EXPECT_LE((world.pose(0).velocity - Vec3d(1, 2 - 9.81 * 0.5, 0)).norm(), 1e-9);
  const Mat3d turned = rotation_from_vector(Vec3d(0, 1.5, 0));
  EXPECT_LE((world.pose(0).rotation - turned).norm(), 1e-9);
}

/// An uneven body that turns about no principal axis keeps its angular momentum and its energy:
/// the first to rounding, the second to (w dt)^2, here 3e-5, without drift.
TEST(RigidBodies, ATumblingBodyKeepsItsAngularMomentum) {
  for (const Vec3d& spin : {Vec3d(2, 3, 1), Vec3d(0.3, 12, 0.1)}) {
    shapes::Collider brick = box_of(700, {0, 0, 0}, {0.1, 0.2, 0.4}, {10, 20, 30});
    brick.angular_velocity = spin;
    BodiesAlone world({brick}, Vec3d::Zero());
    const BodyMomentum before = momentum_of(world.list[0], 0);
    double turned = 0;
    for (int part = 0; part < 10; ++part) {
      world.run(1, 1e-3);
      const BodyMomentum after = momentum_of(world.list[0], world.time);
      EXPECT_LE((after.angular - before.angular).norm(), 1e-11 * before.angular.norm());
      EXPECT_NEAR(after.kinetic / before.kinetic, 1, 3e-5);
      turned = std::max(turned, (world.pose(0).angular_velocity - spin).norm());
    }
    EXPECT_GT(turned, 0.1 * spin.norm()) << "it does not tumble";
  }
}

/// The free turn of a body whose inertia has an axis of symmetry is known: its spin goes around the
/// axis at the rate (1 - I3 / I1) w3, and both around the momentum at L / I1.
TEST(RigidBodies, ASpinningPlateWobblesAtItsRate) {
  shapes::Collider plate = box_of(700, {0, 0, 0}, {0.4, 0.05, 0.4});
  plate.angular_velocity = {1, 8, 0};
  const Mat3d inertia = rigid::mass_properties(plate).inertia;
  const Vec3d momentum = inertia * plate.angular_velocity;
  const double rate = momentum.norm() / inertia(0, 0);
  BodiesAlone world({plate}, Vec3d::Zero());
  const double period = 2 * std::numbers::pi / rate;
  // After five rounds its axis is where it was; one part in 600 of a round is a step.
  world.run(5 * period, period / 600);
  EXPECT_NEAR((world.pose(0).rotation.col(1) - Vec3d::UnitY()).norm(), 0, 2e-4);
  world.run(0.5 * period, period / 600);
  const Vec3d along = momentum.normalized();
  const Vec3d opposite = 2 * along.y() * along - Vec3d::UnitY();
  EXPECT_NEAR((world.pose(0).rotation.col(1) - opposite).norm(), 0, 2e-4);
}

/// Two balls of one size that do not bounce move on together: Bullet's own case.
TEST(RigidBodies, BallsThatMeetGoOnTogether) {
  BodiesAlone world({ball_of(700, {-0.3, 0, 0}, 0.1, {2, 0, 0}), ball_of(2100, {0, 0, 0}, 0.1)},
                    Vec3d::Zero());
  world.run(0.3, 1e-4);
  EXPECT_NEAR(world.pose(0).velocity.x(), 0.5, 1e-6);
  EXPECT_NEAR(world.pose(1).velocity.x(), 0.5, 1e-6);
  EXPECT_NEAR((world.pose(1).point - world.pose(0).point).norm(), 0.2, 2e-4);
}

/// The height to which a ball rises again that falls from `height`, of its lowest point.
double rebound(double restitution, double height) {
  shapes::Collider ball = ball_of(700, {0, 0.1 + height, 0}, 0.1);
  ball.body.restitution = restitution;
  BodiesAlone world({plane({0, 0, 0}, {0, 1, 0}, 0.5), ball});
  bool has_met = false;
  double highest = 0;
  while (world.time < 2) {
    world.step(1e-4);
    const double y = world.pose(1).point.y() - 0.1, v = world.pose(1).velocity.y();
    has_met = has_met || y < 1e-3;
    if (has_met) highest = std::max(highest, y);
    if (has_met && y > 1e-3 && v < 0) break;
  }
  return highest;
}

TEST(RigidBodies, ABallReboundsByTheSquareOfItsRestitution) {
  const double height = 0.5;
  // It bounces up to one step early or late: v dt = 3e-4 m.
  for (const double e : {0.0, 0.3, 0.5, 0.8, 1.0})
    EXPECT_NEAR(rebound(e, height), e * e * height, 1e-3 * height + 3e-4) << e;
}

/// The larger restitution of two counts; momentum stays.
/// It rose by half a per cent more at each bounce, of ten.
TEST(RigidBodies, ABallThatLosesNothingKeepsItsHeight) {
  shapes::Collider ball = ball_of(700, {0, 1.1, 0}, 0.1);
  ball.body.restitution = 1;
  BodiesAlone world({plane({0, 0, 0}, {0, 1, 0}, 0.5), ball});
  double highest = 0;
  for (int step = 0; step < 9500; ++step) {
    world.step(1e-3);
    if (step > 8600) highest = std::max(highest, world.pose(1).point.y() - 0.1);
  }
  // The error is of second order in the step: g dt^2 / 2 a bounce, and the top between two steps.
  EXPECT_NEAR(highest, 1, 1e-3);
}

TEST(RigidBodies, BallsBounceOffEachOtherWithTheirRestitution) {
  shapes::Collider quick = ball_of(700, {-0.3, 0, 0}, 0.1, {2, 0, 0});
  quick.body.restitution = 0.8;
  BodiesAlone world({quick, ball_of(2100, {0, 0, 0}, 0.1)}, Vec3d::Zero());
  world.run(0.3, 1e-4);
  // v1 = (m1 - e m2) / (m1 + m2) v, v2 = (1 + e) m1 / (m1 + m2) v.
  EXPECT_NEAR(world.pose(0).velocity.x(), (1 - 0.8 * 3) / 4 * 2, 1e-6);
  EXPECT_NEAR(world.pose(1).velocity.x(), 1.8 / 4 * 2, 1e-6);
}

/// It bounces less and less, and then lies.
TEST(RigidBodies, ABoxThatBouncesComesToRest) {
  shapes::Collider box = box_of(700, {0, 0.3, 0}, {0.2, 0.2, 0.2});
  box.body.restitution = 0.5;
  BodiesAlone world({plane({0, 0, 0}, {0, 1, 0}, 0.5), box});
  world.run(2, 1e-3);
  EXPECT_NEAR(world.pose(1).point.y(), 0.1, 2e-3);
  EXPECT_LE(world.pose(1).velocity.norm(), 0.03);
}

/// A ring of square section about z, as a mesh.
std::string ring_file(const std::filesystem::path& folder, double inner, double outer,
                      double depth) {
  constexpr int pieces = 24;
  const std::string file = (folder / "ring.obj").string();
  std::ofstream out(file);
  for (int k = 0; k < pieces; ++k)
    for (const double radius : {inner, outer})
      for (const double z : {-0.5 * depth, 0.5 * depth}) {
        const double angle = 2 * std::numbers::pi * k / pieces;
        out << "v " << radius * std::cos(angle) << ' ' << radius * std::sin(angle) << ' ' << z
            << '\n';
      }
  for (int k = 0; k < pieces; ++k) {
    const int a = 4 * k + 1, b = 4 * ((k + 1) % pieces) + 1;
    const auto face = [&](int p, int q, int r, int s) {
      out << "f " << p << ' ' << q << ' ' << r << ' ' << s << '\n';
    };
    face(a, a + 1, b + 1, b);          // inside
    face(a + 2, b + 2, b + 3, a + 3);  // outside
    face(a, b, b + 2, a + 2);          // below
    face(a + 1, a + 3, b + 3, b + 1);  // above
  }
  return file;
}

/// The peg is in the hole: a ring by its convex hull would be thrown off it.
TEST(RigidBodies, ARingThatIsAMeshHangsOnItsPeg) {
  const TemporaryFolder folder;
  shapes::Collider peg, ring;
  peg.name = "peg";
  peg.shape.form = shapes::Box{{0, 0, 0}, {0.1, 0.1, 1}};
  ring.name = "ring";
  ring.shape.form = shapes::Mesh{ring_file(folder.path(), 0.2, 0.3, 0.1), 1, {0, -0.13, 0}};
  ring.body.density = 700;
  BodiesAlone world({peg, ring});
  world.run(4, 1e-3);
  const shapes::Pose pose = world.pose(1);
  // The corners of the peg are 0.05 to the sides of its middle; the ring is a polygon, 2 mm inside
  // of its circle.
  const double rests = 0.05 - std::sqrt(0.2 * 0.2 - 0.05 * 0.05);
  EXPECT_NEAR(pose.point.y(), rests, 3e-3);
  EXPECT_NEAR(pose.point.x(), 0, 5e-3);
  EXPECT_NEAR(pose.point.z(), 0, 5e-3);
  // It swings on the edges of the peg, and stops.
  EXPECT_LE(pose.velocity.norm(), 0.02);
}

/// Each of its faces is a shape of its own.
TEST(RigidBodies, AHollowMeshOfManyFacesIsRefused) {
  const TemporaryFolder folder;
  shapes::Collider sheet;
  sheet.name = "sheet";
  sheet.body.density = 300;
  const auto file = [&](const std::string& name, int parts, double bend) {
    const auto way = [&](double x) { return Vec3d(0, bend * x * x, 0); };
    return folder.write(name, plate_obj(Vec3d(1, 0.1, 1), parts, way)).string();
  };
  const std::string hollow = file("hollow.obj", 1300, 0.2), flat = file("flat.obj", 1300, 0);
  sheet.shape.form = shapes::Mesh{hollow};
  try {
    BodiesAlone world({sheet});
    FAIL() << "10 404 faces are taken";
  } catch (const ShapeError& error) {
    EXPECT_NE(
        std::string(error.what()).find("collider sheet: " + hollow + ": has hollows and 10404"),
        std::string::npos)
        << error.what();
  }
  sheet.shape.form = shapes::Mesh{flat};
  EXPECT_NO_THROW(BodiesAlone({sheet}));
}

/// Three boxes on each other, on every kind of ground that there is: they stay.
TEST(RigidBodies, AStackStands) {
  shapes::Collider floor = plane({0, 0, 0}, {0, 1, 0}, 0.5), block = floor;
  block.name = "block";
  block.shape.form = shapes::Box{{0, -0.5, 0}, {2, 1, 2}};
  for (const shapes::Collider& ground : {floor, block}) {
    std::vector<shapes::Collider> list{ground};
    for (int k = 0; k < 3; ++k) {
      list.push_back(box_of(700, {0.01 * k, 0.1 + 0.2 * k, 0}, {0.2, 0.2, 0.2}));
      list.back().name += std::to_string(k);
    }
    BodiesAlone world(list);
    world.run(1, 1e-3);
    for (int k = 0; k < 3; ++k) {
      const shapes::Pose pose = world.pose(static_cast<std::size_t>(k) + 1);
      EXPECT_LE((pose.point - Vec3d(0.01 * k, 0.1 + 0.2 * k, 0)).norm(), 2e-3) << k;
      EXPECT_LE((pose.rotation - Mat3d::Identity()).norm(), 0.01) << k;
    }
  }
}

/// Round bodies that come down tilted on a floor and lie down.
std::vector<shapes::Collider> round_bodies(double size, const Vec3d& degrees) {
  std::vector<shapes::Collider> bodies(2);
  bodies[0].shape.form = shapes::Cylinder{{0, 0.25 * size, 0}, 0.1 * size, 0.1 * size};
  bodies[1].shape.form = shapes::Cone{{0, 0.25 * size, 0}, 0.1 * size, 0.2 * size};
  for (shapes::Collider& body : bodies) {
    body.name = "round";
    body.friction = 0.4;
    body.shape.rotation = degrees;
    body.body.density = 300;
  }
  return bodies;
}

std::vector<shapes::Collider> floors_for(double size) {
  shapes::Collider floor = plane({0, 0, 0}, {0, 1, 0}, 0.4), block = floor;
  block.shape.form = shapes::Box{{0, -0.5 * size, 0}, {4 * size, size, 4 * size}};
  return {floor, block};
}

/// A round body that falls tilted is its own mirror image in the plane through its axis: it cannot
/// turn about the vertical. Contact in a few points, found one after the other, turns it by half a
/// degree or one; points near to each other turned it by 30 to 90.
TEST(RigidBodies, ARoundBodyThatComesDownOnItsEdgeDoesNotSpinRound) {
  for (const double size : {0.2, 1.0, 5.0})
    for (const shapes::Collider& body : round_bodies(size, {20, 0, 35}))
      for (const shapes::Collider& floor : floors_for(size)) {
        BodiesAlone world({floor, body});
        const Mat3d start = world.pose(1).rotation;
        world.run(std::sqrt(size), 5e-4 * std::sqrt(size));
        const Eigen::AngleAxisd turn(Mat3d(world.pose(1).rotation * start.transpose()));
        SCOPED_TRACE(testing::Message() << "size " << size << ", form " << body.shape.form.index());
        EXPECT_LE(std::abs(turn.angle() * turn.axis().y()), 2 * std::numbers::pi / 180);
        EXPECT_GE((world.pose(1).rotation * shapes::form_axes(body.shape)).col(1).y(), 0.999)
            << "it lies";
      }
}

/// Bodies of any size move alike, at the times that belong to it. All factors are powers of two,
/// but Bullet takes friction along a velocity above some absolute one, and along fixed axes below:
/// a body that has nearly come to rest creeps by some ten thousandths of its size.
TEST(RigidBodies, SmallAndLargeBodiesMoveAlike) {
  for (std::size_t form = 0; form < 2; ++form)
    for (std::size_t ground = 0; ground < 2; ++ground) {
      const auto pose = [&](double time) {
        const double size = time * time;
        BodiesAlone world({floors_for(size)[ground], round_bodies(size, {20, 0, 35})[form]});
        world.run(0.75 * time, time / 1024);
        return std::pair{Vec3d(world.pose(1).point / size), world.pose(1).rotation};
      };
      const auto [place, rotation] = pose(1);
      for (const double time : {0.0625, 0.25, 16.0}) {
        const auto [other_place, other_rotation] = pose(time);
        SCOPED_TRACE(testing::Message()
                     << "form " << form << ", ground " << ground << ", time " << time);
        EXPECT_LE((other_place - place).norm(), 1e-4);
        EXPECT_LE((other_rotation - rotation).norm(), 1e-3);
      }
    }
}

/// Bodies lie on a plane, a box and a mesh of several triangles. Cylinders that lay on boxes and
/// meshes rolled away by themselves, and a plate sank through a mesh.
TEST(RigidBodies, WhatLiesStillStays) {
  const TemporaryFolder folder;
  const std::string plate =
      folder.write("plate.obj", plate_obj(Vec3d(4, 1, 4), 4, [](double) { return Vec3d(0, 0, 0); }))
          .string();
  for (const double size : {0.02, 1.0}) {
    const Vec3d at = size * Vec3d(0.01, 0, 0.013), up = size * Vec3d::UnitY();
    std::vector<shapes::Collider> bodies(6);
    bodies[0].shape.form = shapes::Cylinder{at + 0.05 * up, 0.1 * size, 0.1 * size};
    bodies[1].shape.form = shapes::Cylinder{at + 0.1 * up, 0.1 * size, 0.3 * size};
    bodies[1].shape.rotation = {90, 0, 0};
    bodies[2].shape.form = shapes::Cone{at + 0.1 * up, 0.1 * size, 0.2 * size};
    bodies[3].shape.form =
        shapes::Capsule{size * Vec3d(-0.1, 0.05, 0), size * Vec3d(0.1, 0.05, 0.03), 0.05 * size};
    bodies[4].shape.form = shapes::Box{at + 0.005 * up, size * Vec3d(0.4, 0.01, 0.4)};
    bodies[5].shape.form = shapes::Torus{at + 0.05 * up, 0.2 * size, 0.05 * size};
    std::vector<shapes::Collider> floors = floors_for(size);
    floors.push_back(floors[0]);
    floors.back().shape.form = shapes::Mesh{plate, size, -0.5 * up};
    for (shapes::Collider& body : bodies) {
      body.name = "body";
      body.friction = 0.4;
      body.body.density = 300;
      for (const shapes::Collider& floor : floors) {
        BodiesAlone world({floor, body});
        const shapes::Pose start = world.pose(1);
        world.run(2 * std::sqrt(size), 1e-3 * std::sqrt(size));
        const shapes::Pose end = world.pose(1);
        SCOPED_TRACE(testing::Message() << "size " << size << ", form " << body.shape.form.index()
                                        << " on form " << floor.shape.form.index());
        // It sinks by what contact takes, and rocks by as much.
        EXPECT_LE((end.point - start.point).norm(), 0.01 * size);
        EXPECT_LE(Eigen::AngleAxisd(Mat3d(end.rotation * start.rotation.transpose())).angle(),
                  0.02);
      }
    }
  }
}

/// A cylinder with one point of contact at its end rocks, and what stands on it sinks a centimetre.
TEST(RigidBodies, WhatStandsOnACylinderStays) {
  std::vector<shapes::Collider> bodies(3);
  const Vec3d low(0.01, 0.05, 0.013), high = low + Vec3d(0, 0.1, 0);
  bodies[0].shape.form = shapes::Box{high, {0.2, 0.1, 0.2}};
  bodies[1].shape.form = shapes::Cylinder{high, 0.1, 0.1};
  bodies[2].shape.form = shapes::Cone{high, 0.1, 0.1};
  shapes::Collider can;
  can.name = "can";
  can.friction = 0.5;
  can.body.density = 300;
  can.shape.form = shapes::Cylinder{low, 0.1, 0.1};
  for (const shapes::Collider& floor : floors_for(1))
    for (shapes::Collider& body : bodies) {
      body.name = "body";
      body.friction = 0.5;
      body.body.density = 300;
      BodiesAlone world({floor, can, body});
      world.run(2, 1e-3);
      SCOPED_TRACE(testing::Message() << "form " << body.shape.form.index() << " on form "
                                      << floor.shape.form.index());
      EXPECT_LE((world.pose(2).point - high).norm(), 6e-3);
      EXPECT_LE(world.pose(2).velocity.norm(), 0.04);
    }
}

/// A block on a slope stays below the friction angle and slides with g (sin - mu cos) above it.
TEST(RigidBodies, ABlockSlidesBeyondTheFrictionAngle) {
  for (const double degrees : {25.0, 35.0}) {
    const double a = degrees * std::numbers::pi / 180, mu = std::tan(30 * std::numbers::pi / 180);
    const Vec3d normal(-std::sin(a), std::cos(a), 0), down(-std::cos(a), -std::sin(a), 0);
    shapes::Collider box = box_of(700, 0.1 * normal, {0.4, 0.2, 0.4}, {0, 0, degrees});
    box.friction = mu;
    BodiesAlone world({plane({0, 0, 0}, normal, mu), box});
    world.run(0.5, 2e-4);
    const double way = (world.pose(1).point - 0.1 * normal).dot(down);
    const double exact = 0.5 * 9.81 * (std::sin(a) - mu * std::cos(a)) * 0.25;
    if (degrees < 30)
      EXPECT_NEAR(way, 0, 2e-3);
    else
      EXPECT_NEAR(way / exact, 1, 0.02);
  }
}

/// A block slides over the faces of a mesh and of a terrain as over a plane. Edges that faces share
/// stopped a box on a slope without friction, and threw it up.
TEST(RigidBodies, ABlockSlidesOverTheFacesOfASurface) {
  const TemporaryFolder folder;
  const auto level = [](double) { return Vec3d(0, 0, 0); };
  const std::string plate = folder.write("plate.obj", plate_obj(Vec3d(8, 1, 8), 8, level)).string(),
                    block = folder.write("block.obj", plate_obj(Vec3d(0.2, 0.1, 0.15), 2, level))
                                .string();
  shapes::Terrain terrain;
  terrain.file =
      folder.write("level.asc", height_grid(9, 9, 1, [](double, double) { return 0.0; })).string();
  for (const double degrees : {15.0, 35.0})
    for (const double mu : {0.0, 0.2}) {
      const double a = degrees * std::numbers::pi / 180;
      const Vec3d normal(std::sin(a), std::cos(a), 0), down(std::cos(a), -std::sin(a), 0);
      std::vector<shapes::Collider> grounds(2), bodies(3);
      grounds[0].shape.form = shapes::Mesh{plate, 1, -0.5 * normal};
      grounds[1].shape.form = terrain;
      bodies[0].shape.form = shapes::Box{0.05 * normal, {0.2, 0.1, 0.15}};
      bodies[1].shape.form = shapes::Mesh{block, 1, 0.05 * normal};
      bodies[2].shape.form = shapes::Cylinder{0.05 * normal, 0.1, 0.1};
      for (shapes::Collider& ground : grounds)
        for (shapes::Collider& body : bodies) {
          ground.name = "ground";
          body.name = "body";
          body.body.density = 700;
          ground.friction = body.friction = mu;
          ground.shape.rotation = body.shape.rotation = {0, 0, -degrees};
          BodiesAlone world({ground, body});
          world.run(0.2, 1e-3);
          const Vec3d before = world.pose(1).velocity;
          world.run(0.4, 1e-3);
          const Vec3d after = world.pose(1).velocity;
          const double exact = 9.81 * (std::sin(a) - mu * std::cos(a));
          SCOPED_TRACE(testing::Message()
                       << degrees << " degrees, mu " << mu << ", form " << body.shape.form.index()
                       << " on form " << ground.shape.form.index());
          const double share = &body == &bodies[2] ? 0.04 : 0.01;
          EXPECT_NEAR((after - before).dot(down) / 0.4, exact, share * 9.81 * std::sin(a));
          EXPECT_LE(std::abs(after.dot(normal)), 0.03) << "it does not hop";
        }
    }
}

/// A can in a hollow of a mesh, and on a terrain; every form of body falls on a floor and stays.
TEST(RigidBodies, EveryFormComesToRestOnTheFloor) {
  std::vector<shapes::Shape> all = {{shapes::Sphere{{0, 0.5, 0}, 0.1}, {}},
                                    {shapes::Box{{0, 0.5, 0}, {0.2, 0.1, 0.3}}, {10, 20, 30}},
                                    {shapes::Capsule{{0, 0.5, 0}, {0.2, 0.6, 0}, 0.05}, {}},
                                    {shapes::Cylinder{{0, 0.5, 0}, 0.1, 0.2}, {20, 0, 0}},
                                    {shapes::Cone{{0, 0.5, 0}, 0.1, 0.2}, {10, 0, 0}},
                                    {shapes::Torus{{0, 0.5, 0}, 0.2, 0.05}, {10, 0, 0}}};
  for (const shapes::Shape& shape : all) {
    SCOPED_TRACE(shape.form.index());
    shapes::Collider body = box_of(700, {0, 0, 0}, {1, 1, 1});
    body.shape = shape;
    BodiesAlone world({plane({0, 0, 0}, {0, 1, 0}, 0.5), body});
    world.run(3, 1e-3);
    const shapes::Pose pose = world.pose(1);
    const shapes::Bounds box = shapes::bounds_at(world.list[1], world.time);
    EXPECT_NEAR(box.min.y(), 0, 1e-3);
    EXPECT_LE(pose.velocity.norm(), 0.05);
  }
}

/// A cone on its base on a floor, and under a box, is as large as its numbers say.
TEST(RigidBodies, AConeIsNoLargerThanItIs) {
  shapes::Collider cone = box_of(500, {0, 0, 0}, {1, 1, 1});
  for (const auto& [radius, height] : {std::pair{0.5, 1.0}, {0.5, 0.1}, {0.1, 1.0}}) {
    SCOPED_TRACE(height / radius);
    cone.shape.form = shapes::Cone{{0, 0.5 * height, 0}, radius, height};
    BodiesAlone world({plane({0, 0, 0}, {0, 1, 0}, 0.5), cone});
    world.run(0.5, 1e-3);
    EXPECT_NEAR(world.pose(1).point.y(), 0.5 * height, 2e-4);
  }
  // Its base is up.
  shapes::Collider table;
  table.name = "table";
  table.shape = {shapes::Cone{{0, -0.5, 0}, 2, 1}, {180, 0, 0}};
  BodiesAlone world({table, box_of(500, {0, 0.1, 0}, {0.2, 0.2, 0.2})});
  world.run(0.5, 1e-3);
  EXPECT_NEAR(world.pose(1).point.y(), 0.1, 5e-4);
  // A ball on its wall, held in its place along the ground: a floor that falls by 1 in 2.
  table.shape = {shapes::Cone{{0, -0.5, 0}, 2, 1}, {0, 0, 0}};
  shapes::Collider ball = ball_of(500, {1, 0, 0}, 0.1);
  ball.body.hold = {shapes::HeldAxis::x, shapes::HeldAxis::z};
  BodiesAlone slope({table, ball});
  slope.run(1, 1e-3);
  EXPECT_NEAR(slope.pose(1).point.y(), -0.5 + 0.1 * std::hypot(1, 0.5), 1e-3);
}

/// The collider goes further in a step than a ball is thick.
TEST(RigidBodies, AFastColliderTakesABodyAtRestAlong) {
  SolverSettings settings;
  settings.gravity.setZero();
  for (const double start : {-1.0, -1.03, -0.97})
    for (const bool is_keyframed : {false, true}) {
      SCOPED_TRACE(testing::Message() << start << " " << is_keyframed);
      shapes::Collider ram;
      ram.name = "ram";
      ram.shape.form = shapes::Box{{start, 0, 0}, {0.04, 0.5, 0.5}};
      ram.velocity = {20, 0, 0};
      if (is_keyframed) {
        ram.velocity.setZero();
        ram.keyframes = {{0, Vec3d(start, 0, 0), {}}, {0.1, Vec3d(start + 2, 0, 0), {}}};
      }
      Simulation simulation(settings, {Material{}}, {ball_of(500, {0, 0, 0}, 0.05), ram}, {});
      for (int k = 0; k < 10; ++k) simulation.step(0.01);
      EXPECT_GE(motion_of(simulation, 0).point.x(), motion_of(simulation, 1).point.x());
      EXPECT_GE(motion_of(simulation, 0).velocity.x(), 19);
    }
}

/// Posts from 0 to 2 m along both sides, 1 m apart, and more around them.
/// @param height  height(column, row)
template <class Height>
shapes::Collider ground_of_posts(const TemporaryFolder& folder, const Height& height,
                                 int around = 0) {
  shapes::Collider ground;
  ground.name = "ground";
  const int count = 3 + 2 * around;
  const auto held = [&](double x) { return std::clamp(x - around, 0.0, 2.0); };
  const auto level = [&](double x, double z) { return height(held(x), held(z)); };
  shapes::Terrain terrain;
  terrain.file =
      folder.write("ground_" + std::to_string(around) + ".asc", height_grid(count, count, 1, level))
          .string();
  terrain.center = Vec3d(-1, 0, -1) * around;
  ground.shape.form = terrain;
  return ground;
}

double terrace(double x, double z) {
  return x > 1.5 && z > 1.5 ? 0.5 : 0.2;
}

/// Bodies rest as snow does: at the sides, at the corners, and far away. They may be 2 % of their
/// size from there: contact is soft, and a box that falls on triangles rocks.
TEST(RigidBodies, BodiesRestOnATerrainBeyondItsPosts) {
  const TemporaryFolder folder;
  struct At {
    double x, z, height;
  };
  for (const double degrees : {0.0, 30.0})
    for (const At at : std::initializer_list<At>{{2.5, 0.5, 0.2},
                                                 {-0.5, 1, 0.2},
                                                 {1, -0.5, 0.2},
                                                 {-3, -4, 0.2},
                                                 {2.5, -1.5, 0.2},
                                                 {3, 3, 0.5},
                                                 {700, 800, 0.5},
                                                 {-2000, 2.3, 0.2}}) {
      SCOPED_TRACE(std::to_string(at.x) + ", " + std::to_string(at.z) + ", turned by " +
                   std::to_string(degrees));
      shapes::Collider ground = ground_of_posts(folder, terrace);
      ground.shape.rotation = {0, degrees, 0};
      const Vec3d place =
          rotation_from_degrees(ground.shape.rotation) * Vec3d(at.x, at.height, at.z);
      const Vec3d up(0, 1, 0);
      for (const shapes::Collider& body : {ball_of(700, place + 0.13 * up, 0.1),
                                           box_of(700, place + 0.13 * up, {0.2, 0.2, 0.2})}) {
        BodiesAlone world({ground, body});
        world.run(1, 1e-3);
        EXPECT_LE((world.pose(1).point - place - 0.1 * up).norm(), 4e-3) << body.name;
        EXPECT_LE(world.pose(1).velocity.norm(), 1e-2) << body.name;
      }
    }
}

/// A body that is a thousand cells across: a million of them in each step would take minutes.
TEST(RigidBodies, ALargeBodyRestsBeyondPostsThatAreCloseToEachOther) {
  const TemporaryFolder folder;
  shapes::Collider ground;
  ground.name = "ground";
  shapes::Terrain terrain;
  terrain.file =
      folder.write("fine.asc", height_grid(3, 3, 0.01, [](double, double) { return 0.2; }))
          .string();
  ground.shape.form = terrain;
  BodiesAlone world({ground, box_of(700, {30, 1.21, 3}, {10, 2, 10})});
  world.run(1, 1e-3);
  // Two hundredths of its height: contact is soft.
  EXPECT_NEAR(world.pose(1).point.y(), 1.2, 0.04);
  EXPECT_LE(world.pose(1).velocity.norm(), 1e-2);
}

/// Over the border, over a corner and beside a slope a body goes as if there were posts.
/// Differences are rounding alone: 3000 steps, and a metre or two.
TEST(RigidBodies, ATerrainGoesOnAsIfThereWerePosts) {
  const TemporaryFolder folder;
  const auto slope = [](double x, double z) { return 0.1 * x * x - 0.2 * z; };
  for (const Vec3d& velocity :
       {Vec3d(2, 0, 0), Vec3d(-2, 0, -1), Vec3d(0.3, 0, -2), Vec3d(2, 0, 2)}) {
    SCOPED_TRACE(velocity.transpose());
    shapes::Collider ball = ball_of(700, {1, 0.3, 0.6}, 0.1, velocity);
    ball.friction = 0;
    BodiesAlone world({ground_of_posts(folder, slope), ball}),
        posts({ground_of_posts(folder, slope, 9), ball});
    for (int tenth = 0; tenth < 30; ++tenth) {
      world.run(0.1, 1e-3);
      posts.run(0.1, 1e-3);
      EXPECT_LE((world.pose(1).point - posts.pose(1).point).norm(), 1e-9);
    }
    const Vec3d end = world.pose(1).point;
    EXPECT_TRUE(end.x() < 0 || end.x() > 2 || end.z() < 0 || end.z() > 2) << "it stayed";
  }
}

}  // namespace
