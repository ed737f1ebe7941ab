/// The kernels' distances against those of the host, for every shape.

#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <memory>
#include <random>
#include <sstream>
#include <vector>

#include "sim/shapes/distance_field.h"
#include "sim/simulation.h"
#include "sim/staged.h"
#include "sim/state/kernel_pose.h"
#include "tests/support/out_of_reach.h"
#include "tests/support/snow.h"
#include "tests/support/temporary_folder.h"

namespace neve::sim {
namespace {

struct Seen {
  double distance;
  Vec3d normal;
};

/// Places are a few cells from the first node of the block.
constexpr double h = 0.1;
constexpr int block[3] = {-4, 8, 4};
const Vec3d place_of_block = h * Vec3d(-4, 8, 4);

/// Returns the surface that the kernels of a precision see from a place, in every lane the same.
template <class Real>
Seen seen_by_kernel(const sim::kernels::ColliderPose& pose, const Vec3d& x) {
  using V = Quad<Real>;
  const sim::kernels::LocalCollider<Real> local = sim::kernels::localize<Real>(pose, block, h);
  const Vec3d from = x - place_of_block;
  Vec3<V> normal;
  const V distance = sim::kernels::surface_distance(
      local,
      Vec3<V>{all<V>(static_cast<Real>(from[0])), all<V>(static_cast<Real>(from[1])),
              all<V>(static_cast<Real>(from[2]))},
      normal);
  return {static_cast<double>(distance[1]),
          Vec3d(static_cast<double>(normal.x[1]), static_cast<double>(normal.y[1]),
                static_cast<double>(normal.z[1]))};
}

const Vec3d middle_of_shapes(-0.1, 1.0, 0.6);

std::vector<sim::shapes::Shape> analytic_shapes() {
  const Vec3d turn(20, -35, 50);
  return {{sim::shapes::Plane{middle_of_shapes, {1, 4, -2}}, turn},
          {sim::shapes::Sphere{middle_of_shapes, 0.4}, turn},
          {sim::shapes::Box{middle_of_shapes, {0.5, 0.9, 0.3}}, turn},
          {sim::shapes::Capsule{middle_of_shapes - Vec3d(0.2, 0.3, -0.1),
                                middle_of_shapes + Vec3d(0.3, 0.2, 0.1), 0.2},
           turn},
          {sim::shapes::Capsule{middle_of_shapes, middle_of_shapes, 0.3}, turn},
          {sim::shapes::Cylinder{middle_of_shapes, 0.4, 0.5}, turn},
          {sim::shapes::Cylinder{middle_of_shapes, 0.15, 0.9}, turn},
          {sim::shapes::Cone{middle_of_shapes, 0.4, 0.8}, turn},
          {sim::shapes::Cone{middle_of_shapes, 0.5, 0.3}, turn},
          {sim::shapes::Torus{middle_of_shapes, 0.35, 0.15}, turn},
          {sim::shapes::Torus{middle_of_shapes, 0.2, 0.2}, turn}};
}

sim::shapes::Collider moving_and_turned(const sim::shapes::Shape& shape) {
  sim::shapes::Collider c;
  c.shape = shape;
  c.velocity = {0.2, -0.1, 0.3};
  c.angular_velocity = {0.5, 1, -0.7};
  return c;
}

std::vector<Vec3d> random_places(std::size_t count, double reach) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Vec3d> places;
  for (std::size_t k = 0; k < count; ++k)
    places.push_back(middle_of_shapes + reach * Vec3d(unit(random), unit(random), unit(random)));
  return places;
}

TEST(ContactKernel, ContactKernelAgreesWithTheHostForEveryShape) {
  for (const sim::shapes::Shape& shape : analytic_shapes()) {
    SCOPED_TRACE(shape.form.index());
    const sim::shapes::Collider c = moving_and_turned(shape);
    const double time = 0.3;
    const sim::kernels::ColliderPose pose =
        *sim::engine::kernel_pose(c, time, h, Vec3i::Zero(), {});
    int inside = 0;
    for (const Vec3d& x : random_places(4000, 0.6)) {
      const sim::shapes::Surface host = sim::shapes::surface_at(c, time, x);
      const Seen lane = seen_by_kernel<double>(pose, x);
      // Rounding decides on the surface itself.
      if (std::abs(host.distance) > 1e-12) {
        EXPECT_EQ(lane.distance <= 0, host.distance <= 0);
      }
      // Outside kernels need no more than a bound.
      EXPECT_LE(lane.distance, host.distance + 1e-12);
      EXPECT_LT((lane.normal - host.normal).norm(), 1e-10);
      if (host.distance > 0) continue;
      ++inside;
      EXPECT_NEAR(lane.distance, host.distance, 1e-12);
      // Places are known to 1e-7 of the metre or so that they are from the collider.
      EXPECT_NEAR(seen_by_kernel<float>(pose, x).distance, host.distance, 1e-6);
    }
    EXPECT_GT(inside, 80);
  }
}

/// The same box at the origin of its file and 200 km from it, as of a map, taken home by its
/// centre.
TEST(ContactKernel, AMeshIsAsExactFarFromTheOriginOfItsFile) {
  const test::TemporaryFolder folder;
  ThreadPool pool(1);
  std::vector<sim::kernels::ColliderPose> poses;
  std::vector<std::shared_ptr<const sim::shapes::DistanceField>> fields;
  std::vector<Vec3d> velocities;
  const auto seen = [&](double away) {
    std::ostringstream text;
    for (int k = 0; k < 8; ++k)
      text << "v " << std::setprecision(17) << away + (k & 1 ? 0.25 : -0.25) << ' '
           << away + (k & 2 ? 0.5 : -0.5) << ' ' << away + (k & 4 ? 0.125 : -0.125) << '\n';
    text << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    sim::shapes::Collider c;
    const sim::shapes::Mesh mesh{
        folder.write("box_" + std::to_string(away) + ".obj", text.str()).string()};
    c.shape = {mesh, {20, -35, 50}};
    const Vec3d way = rotation_from_degrees(c.shape.rotation) * Vec3d(away, away, away);
    std::get<sim::shapes::Mesh>(c.shape.form).center = middle_of_shapes - way;
    c.angular_velocity = {0.5, 1, -0.7};
    c.velocity = -c.angular_velocity.cross(way);
    fields.push_back(sim::shapes::distance_field(mesh, h, pool));
    poses.push_back(*sim::engine::kernel_pose(c, 0, h, Vec3i::Zero(), fields.back()->samples()));
    velocities.push_back(Vec3d::Map(poses.back().velocity));
  };
  seen(0);
  seen(2e5);
  for (const Vec3d& x : random_places(500, 0.6)) {
    const Seen near = seen_by_kernel<float>(poses[0], x), far = seen_by_kernel<float>(poses[1], x);
    EXPECT_NEAR(near.distance, far.distance, 2e-6);
  }
  EXPECT_LT((velocities[0] - velocities[1]).norm(), 1e-9);
}

TEST(ContactKernel, NormalIsTheGradientOfTheDistanceInside) {
  for (const sim::shapes::Shape& shape : analytic_shapes()) {
    SCOPED_TRACE(shape.form.index());
    const sim::kernels::ColliderPose pose =
        *sim::engine::kernel_pose(moving_and_turned(shape), 0.3, h, Vec3i::Zero(), {});
    for (const Vec3d& x : random_places(1000, 0.5)) {
      const Seen here = seen_by_kernel<double>(pose, x);
      EXPECT_NEAR(here.normal.norm(), 1, 1e-12);
      if (here.distance > 0) continue;
      const double e = 1e-6;
      Vec3d gradient;
      for (int a = 0; a < 3; ++a)
        gradient[a] = (seen_by_kernel<double>(pose, x + e * Vec3d::Unit(a)).distance -
                       seen_by_kernel<double>(pose, x - e * Vec3d::Unit(a)).distance) /
                      (2 * e);
      // Differences mix two faces within 1e-6 of where both are as near: no random place is there.
      EXPECT_LT((gradient - here.normal).norm(), 1e-6);
    }
  }
}

/// Points with several nearest places on the surface, or a direction without length.
TEST(ContactKernel, TiesAndCentresAreAsDocumented) {
  struct Case {
    sim::shapes::Shape shape;
    Vec3d from_middle, normal;
    double distance;
  };
  const Vec3d none(0, 0, 0);
  const double slope = std::hypot(0.8, 0.4);
  const std::vector<Case> cases{
      {{sim::shapes::Sphere{middle_of_shapes, 0.4}, none}, {0, 0, 0}, {0, 1, 0}, -0.4},
      {{sim::shapes::Box{middle_of_shapes, {0.4, 0.4, 0.4}}, none}, {0, 0, 0}, {1, 0, 0}, -0.2},
      {{sim::shapes::Box{middle_of_shapes, {0.4, 0.4, 0.4}}, none},
       {-0.1, 0.1, -0.1},
       {-1, 0, 0},
       -0.1},
      // Both ends of a capsule's axis, and along it.
      {{sim::shapes::Capsule{middle_of_shapes - Vec3d(0, 0.25, 0),
                             middle_of_shapes + Vec3d(0, 0.25, 0), 0.1},
        none},
       {0, 0.25, 0},
       {1, 0, 0},
       -0.1},
      {{sim::shapes::Capsule{middle_of_shapes - Vec3d(0, 0.25, 0),
                             middle_of_shapes + Vec3d(0, 0.25, 0), 0.1},
        none},
       {0, 0, 0},
       {1, 0, 0},
       -0.1},
      {{sim::shapes::Capsule{middle_of_shapes, middle_of_shapes, 0.1}, none},
       {0, 0, 0},
       {1, 0, 0},
       -0.1},
      {{sim::shapes::Cylinder{middle_of_shapes, 0.2, 0.4}, none}, {0, 0, 0}, {1, 0, 0}, -0.2},
      {{sim::shapes::Cylinder{middle_of_shapes, 0.4, 0.2}, none}, {0, 0, 0}, {0, 1, 0}, -0.1},
      // A place as near to the wall as to an end belongs to the wall.
      {{sim::shapes::Cylinder{middle_of_shapes, 0.25, 0.5}, none},
       {-0.125, -0.125, 0},
       {-1, 0, 0},
       -0.125},
      {{sim::shapes::Cone{middle_of_shapes, 0.4, 0.8}, none},
       {0, 0.4, 0},
       {0.8 / slope, 0.4 / slope, 0},
       0},
      {{sim::shapes::Cone{middle_of_shapes, 0.4, 0.8}, none}, {0, -0.4, 0}, {0, -1, 0}, 0},
      {{sim::shapes::Torus{middle_of_shapes, 0.35, 0.15}, none}, {0.35, 0, 0}, {0, 1, 0}, -0.15},
      {{sim::shapes::Torus{middle_of_shapes, 0.2, 0.2}, none}, {0, 0, 0}, {-1, 0, 0}, 0}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.shape.form.index());
    sim::shapes::Collider collider;
    collider.shape = c.shape;
    // The middle_of_shapes is at cell -1, 10, 6 exactly, so that ties are exact in the kernels'
    // arithmetic too; what is left is the rounding of 0.1.
    const sim::kernels::ColliderPose pose =
        *sim::engine::kernel_pose(collider, 0, h, Vec3i::Zero(), {});
    const Seen lane = seen_by_kernel<double>(pose, middle_of_shapes + c.from_middle);
    const sim::shapes::Surface host =
        sim::shapes::surface_at(collider, 0, middle_of_shapes + c.from_middle);
    EXPECT_NEAR(host.distance, c.distance, 1e-12);
    EXPECT_NEAR(lane.distance, c.distance, 1e-12);
    EXPECT_NEAR(host.normal.norm(), 1, 1e-12);
    EXPECT_NEAR(lane.normal.norm(), 1, 1e-12);
    // The shape moves to the origin, where its own arithmetic has the very place.
    collider.shape = c.shape;
    std::visit(
        [&](auto& form) {
          using Form = std::decay_t<decltype(form)>;
          if constexpr (std::is_same_v<Form, sim::shapes::Capsule>) {
            form.a -= middle_of_shapes, form.b -= middle_of_shapes;
          } else if constexpr (!std::is_same_v<Form, sim::shapes::Plane>) {
            form.center.setZero();
          }
        },
        collider.shape.form);
    const sim::kernels::ColliderPose at_origin =
        *sim::engine::kernel_pose(collider, 0, 0.125, Vec3i::Zero(), {});
    const int origin[3] = {0, 0, 0};
    using V = Quad<double>;
    Vec3<V> normal;
    const Vec3d& r = c.from_middle;
    sim::kernels::surface_distance(sim::kernels::localize<double>(at_origin, origin, 0.125),
                                   Vec3<V>{all<V>(r[0]), all<V>(r[1]), all<V>(r[2])}, normal);
    EXPECT_LT((Vec3d(normal.x[0], normal.y[0], normal.z[0]) - c.normal).norm(), 1e-9);
    EXPECT_LT((sim::shapes::surface_at(collider, 0, r).normal - c.normal).norm(), 1e-9);
  }
}

TEST(ContactKernel, EveryColliderInReachIsFound) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const sim::shapes::Shape& shape : analytic_shapes()) {
    SCOPED_TRACE(shape.form.index());
    const sim::kernels::ColliderPose pose =
        *sim::engine::kernel_pose(moving_and_turned(shape), 0.3, h, Vec3i::Zero(), {});
    const sim::kernels::LocalCollider<float> local = sim::kernels::localize<float>(pose, block, h);
    int left_out = 0;
    for (int k = 0; k < 400; ++k) {
      const Vec3d centre = middle_of_shapes + Vec3d(unit(random), unit(random), unit(random));
      const double reach = 0.1 + 0.1 * unit(random);
      left_out += test::is_left_out(
          local, centre - place_of_block, reach, 1e-5, random,
          [&](const Vec3d& way) { return seen_by_kernel<double>(pose, centre + way).distance; });
    }
    EXPECT_GT(left_out, 20);
  }
}

/// The contact law of the paper's section 8, in double, from the host's surface.
Vec3d after_contact(const sim::shapes::Collider& c, const sim::shapes::Surface& surface,
                    const Vec3d& v) {
  if (surface.distance > 0) return v;
  if (c.contact == sim::shapes::Contact::sticky) return surface.velocity;
  const Vec3d relative = v - surface.velocity;
  const double v_n = relative.dot(surface.normal);
  if (c.contact == sim::shapes::Contact::slip) return v - v_n * surface.normal;
  if (v_n >= 0) return v;
  const Vec3d v_t = relative - v_n * surface.normal;
  const double kept = v_t.norm() + c.friction * v_n;
  return surface.velocity + (kept > 0 ? Vec3d(kept / v_t.norm() * v_t) : Vec3d(Vec3d::Zero()));
}

TEST(ContactKernel, EveryShapeHasFrictionSlipAndStickiness) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const sim::shapes::Shape& shape : analytic_shapes())
    for (const sim::shapes::Contact contact :
         {sim::shapes::Contact::separate, sim::shapes::Contact::slip,
          sim::shapes::Contact::sticky}) {
      SCOPED_TRACE(shape.form.index());
      sim::shapes::Collider c = moving_and_turned(shape);
      c.contact = contact;
      c.friction = 0.4;
      const sim::kernels::ColliderPose pose =
          *sim::engine::kernel_pose(c, 0.3, h, Vec3i::Zero(), {});
      const sim::kernels::LocalCollider<double> local =
          sim::kernels::localize<double>(pose, block, h);
      int changed = 0, stuck = 0;
      for (const Vec3d& x : random_places(1500, 0.5)) {
        const Vec3d v(unit(random), unit(random), unit(random)), r = x - place_of_block;
        using V = Quad<double>;
        const auto lanes = [](const Vec3d& a) {
          return Vec3<V>{all<V>(a[0]), all<V>(a[1]), all<V>(a[2])};
        };
        const Vec3<V> out = sim::kernels::respond(local, lanes(r), lanes(v)).v;
        const sim::shapes::Surface surface = sim::shapes::surface_at(c, 0.3, x);
        const Vec3d expected = after_contact(c, surface, v), found(out.x[3], out.y[3], out.z[3]);
        EXPECT_LT((found - expected).norm(), 1e-11);
        changed += expected != v;
        stuck += (expected - surface.velocity).norm() == 0;
      }
      EXPECT_GT(changed, 10);
      if (contact == sim::shapes::Contact::separate) {
        EXPECT_GT(stuck, 1);
        EXPECT_LT(stuck, changed);
      }
    }
}

/// A floor on a plane of nodes: these are free, those below are held, in both precisions.
TEST(ContactKernel, ASurfaceDoesNotHoldTheNodesOnIt) {
  for (const Precision precision : {Precision::single, Precision::real64})
    for (const double height : {0.0, 0.3}) {
      SolverSettings s;
      s.cell_size = h;
      s.contact_at = ContactAt::nodes;
      s.precision = precision;
      const Vec3d low(0, height, 0), high(0.4, height + 0.4, 0.4);
      Simulation simulation(s, {Material{}}, {test::plane(low, {0, 1, 0}, 0.5)},
                            test::box_of_snow(low, high, 0.05), 1);
      const NodeFields nodes = staged_step(simulation, 1e-4).nodes;
      const int on_floor = static_cast<int>(std::lround(height / h));
      int free = 0, held = 0;
      for (std::size_t n = 0; n < nodes.node.size(); ++n) {
        if (nodes.node[n][1] > on_floor) continue;
        const bool is_free = nodes.v_star[n] == nodes.v_free[n];
        EXPECT_EQ(is_free, nodes.node[n][1] == on_floor) << nodes.node[n].transpose();
        ++(is_free ? free : held);
      }
      EXPECT_GT(free, 20);
      EXPECT_GT(held, 20);
    }
}

TEST(KernelPose, APlaneIsTakenByTheFootNearestToTheOrigin) {
  sim::shapes::Collider floor;
  floor.shape = {sim::shapes::Plane{{-1e6, 0.25, 3e6}, {0, 1, 0}}, {0, 0, 0}};
  floor.angular_velocity = {0, 1e-6, 0};
  const auto pose = sim::engine::kernel_pose(floor, 0, h, Vec3i::Zero(), {});
  ASSERT_TRUE(pose);
  const Vec3d x(0.3, 0.5, -0.2);
  EXPECT_NEAR(seen_by_kernel<double>(*pose, x).distance,
              sim::shapes::surface_at(floor, 0, x).distance, 1e-9);
  // Its surface turns about the point that was given.
  EXPECT_NEAR(pose->velocity[0], 1e-6 * -3e6, 1e-9);
  EXPECT_NEAR(pose->velocity[2], 1e-6 * -1e6, 1e-9);
}

TEST(KernelPose, AColliderThatLeftTheLatticeIsOutOfReach) {
  sim::shapes::Collider press;
  press.shape.form = sim::shapes::Box{};
  press.velocity = {0, 0, 1e6};
  EXPECT_TRUE(sim::engine::kernel_pose(press, 0, 0.01, Vec3i::Zero(), {}));
  EXPECT_FALSE(sim::engine::kernel_pose(press, 1, 0.01, Vec3i::Zero(), {}));
}

}  // namespace
}  // namespace neve::sim
