/// Snow comes to rest on the surface below it, at any place of that surface in the grid.

#include "tests/support/rest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "sim/staged.h"
#include "tests/support/elastic.h"
#include "tests/support/meshes.h"
#include "tests/support/snow.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// A seventh of a cell is less than a third of the particles' spacing: nobody sees it.
constexpr double touching = 0.15;

void verify_rest(const std::string& what, const Rest& rest) {
  verify_near({"rest", what, "gap, cells"}, 0, rest.gap, touching);
  verify_at_most({"rest", what, "spread of the gap, cells"}, touching, rest.spread);
  // The block's own sag is 0.004 cells.
  verify_near({"rest", what, "centre of mass, cells"}, 0, rest.rise, touching);
  verify_near({"rest", what, "lowest cell / next cell - 1"}, 0, rest.torn, 0.2);
  EXPECT_GE(rest.lowest, -0.1) << what;
}

TEST(Rest, SnowRestsOnPlanesAnywhereInACellAndTilted) {
  struct Case {
    double fraction, degrees;
    Method method;
  };
  Method in_double = flip_cubic();
  in_double.precision = Precision::real64;
  const std::vector<Case> cases{{0, 0, flip_cubic()},
                                {0.5, 0, flip_cubic()},
                                {0.95, 0, flip_cubic()},
                                {0.25, 20, flip_cubic()},
                                {0.75, 45, flip_cubic()},
                                {0.05, 0, mls_quadratic()},
                                {0, 30, mls_quadratic()},
                                {0.25, 10, in_double},
                                {0, 0, {Transfer::aflip}},
                                {0.25, 20, {Transfer::aflip}},
                                {0, 0, {Transfer::asflip}},
                                {0.25, 20, {Transfer::asflip}},
                                {0.5, 0, {Transfer::asflip, Kernel::quadratic}}};
  for (const Case& c : cases) {
    const RestingPlace place = tilted_place(c.fraction, c.degrees);
    const std::string what = name(c.method.transfer) + " " + name(c.method.kernel) + ", " +
                             in_digits(c.fraction) + " cells, " + in_digits(c.degrees) + "°" +
                             (c.method.precision == Precision::single ? "" : ", double");
    verify_rest(what, rest_on(plane(place.point, place.normal, 0.5), place, c.method));
  }
}

/// Contact is a part of the solve: springs of contacts bring it to the same place.
TEST(Rest, SnowRestsOnPlanesInSemiImplicitSteps) {
  for (Method method : {flip_cubic(), mls_quadratic(), Method{Transfer::asflip}}) {
    method.beta = 1;
    const std::string transfer = name(method.transfer) + " " + name(method.kernel);
    for (const auto& [fraction, degrees] : {std::pair{0.0, 0.0}, {0.5, 0.0}, {0.25, 20.0}}) {
      const RestingPlace place = tilted_place(fraction, degrees);
      verify_rest(
          transfer + ", beta = 1, " + in_digits(fraction) + " cells, " + in_digits(degrees) + "°",
          rest_on(plane(place.point, place.normal, 0.5), place, method));
    }
  }
}

/// Snow that lay still for long has not crept into the floor either.
TEST(Rest, SnowRestsForSeconds) {
  const RestingPlace place = tilted_place(0.5, 0);
  verify_rest("FLIP cubic, after 3 s",
              rest_on(plane(place.point, place.normal, 0.5), place, flip_cubic(), 3));
}

TEST(Rest, SnowRestsOnBoxesMeshesAndHeldSurfaces) {
  const TemporaryFolder folder;
  const RestingPlace place = tilted_place(0.3, 0);
  const Vec3d middle = place.point - Vec3d(0, 0.2, 0);
  const std::string file = folder.write("box.obj", box_obj({0.6, 0.4, 0.6})).string();
  shapes::Mesh mesh{};
  mesh.file = file;
  mesh.center = middle;
  const std::vector<std::pair<std::string, shapes::Shape>> shapes{
      {"box", {shapes::Box{middle, {0.6, 0.4, 0.6}}}}, {"mesh", {mesh}}};
  for (const auto& [name, shape] : shapes) {
    shapes::Collider c;
    c.shape = shape;
    c.friction = 0.5;
    verify_rest("on a " + name, rest_on(c, place, flip_cubic()));
  }
  for (const shapes::Contact contact : {shapes::Contact::slip, shapes::Contact::sticky})
    verify_rest(contact == shapes::Contact::slip ? "on a slippery plane" : "on a sticky plane",
                rest_on(plane(place.point, place.normal, 0.5, contact), place, flip_cubic()));
}

/// The block lies on the top of a ball: its lowest particles are as near as on a plane.
TEST(Rest, SnowRestsOnABall) {
  shapes::Collider ball;
  const double radius = 20 * rest_cell;
  ball.shape = {shapes::Sphere{{0.003, -radius, 0.004}, radius}};
  ball.friction = 0.5;
  Simulation simulation(rest_settings(flip_cubic()), {Material{}}, {ball},
                        block_at(tilted_place(0, 0), 0.5), 1);
  simulation.advance_to(0.35);
  double nearest = 1;
  for (const Vec3d& x : simulation.particles().x)
    nearest = std::min(nearest, (x - Vec3d(0.003, -radius, 0.004)).norm() - radius);
  verify_near({"rest", "on a ball of 20 cells", "nearest particle, cells"}, 0.125,
              nearest / rest_cell, 0.125);
}

/// A plate that rises carries the block; measured from where the plate is then.
TEST(Rest, SnowRestsOnAPlateThatMoves) {
  RestingPlace place = tilted_place(0.3, 0);
  shapes::Collider plate;
  plate.shape = {shapes::Box{place.point - Vec3d(0, 0.1, 0), {0.4, 0.2, 0.4}}};
  plate.friction = 0.5;
  plate.velocity = {0.1, 0.4, 0};
  Simulation simulation(rest_settings(flip_cubic()), {Material{}}, {plate}, block_at(place, 0.5),
                        1);
  simulation.advance_to(0.6);
  EXPECT_FALSE(simulation.divergence());
  const Summary end = simulation.summary();
  place.point += 0.6 * Vec3d(0.1, 0.4, 0);
  verify_rest("on a plate that rises", rest_of(place, simulation.particles()));
  // Friction has brought it to the speed of the plate.
  verify_near({"rest", "on a plate that rises", "speed along it, m/s"}, 0.1,
              end.momentum[0] / end.mass, 2e-3);
}

/// Snow between the floor and a wall that comes nearer touches both at once.
TEST(Rest, SnowInACornerTouchesBothSides) {
  const RestingPlace place = tilted_place(0.4, 0);
  shapes::Collider wall =
      plane(place.point - Vec3d(0.06, 0, 0), {1, 0, 0}, 0, shapes::Contact::separate);
  wall.velocity = {0.1, 0, 0};
  Simulation simulation(rest_settings(flip_cubic()), {Material{}},
                        {plane(place.point, place.normal, 0.1), wall}, block_at(place, 0), 1);
  simulation.advance_to(0.5);
  EXPECT_FALSE(simulation.divergence());
  double lowest = 1, leftmost = 1;
  for (const Vec3d& x : simulation.particles().x) {
    lowest = std::min(lowest, (x - place.point)[1]);
    leftmost = std::min(leftmost, (x - place.point)[0] + 0.06 - 0.05);
  }
  verify_near({"rest", "pushed by a wall", "height of the lowest particle, cells"}, 0.1,
              lowest / rest_cell, 0.2);
  verify_near({"rest", "pushed by a wall", "distance of the nearest particle, cells"}, 0.1,
              leftmost / rest_cell, 0.2);
}

TEST(Impact, SnowStopsAtTheSurface) {
  for (const Method& method :
       {flip_cubic(), mls_quadratic(), Method{Transfer::aflip}, Method{Transfer::asflip}})
    for (const double speed : {1.0, 5.0, 20.0, 40.0}) {
      const RestingPlace place = tilted_place(0.2, 0);
      ParticleArrays p = block_at(place, 0.5);
      for (Vec3d& v : p.v) v = {0.1 * speed, -speed, 0};
      Simulation simulation(rest_settings(method), {Material{}},
                            {plane(place.point, place.normal, 0.5)}, p, 1);
      const double end = 0.1 / speed + 0.01;
      double deepest = 0;
      while (simulation.time() < end && !simulation.divergence()) {
        simulation.step(simulation.choose_dt(end - simulation.time()).dt);
        deepest = std::max(deepest, simulation.summary().max_depth);
      }
      EXPECT_FALSE(simulation.divergence());
      verify_at_most(
          {"impact",
           name(method.transfer) + " " + name(method.kernel) + ", " + in_digits(speed) + " m/s",
           "deepest particle, cells"},
          0.1, deepest / rest_cell);
    }
}

}  // namespace
