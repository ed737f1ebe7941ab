#include "sim/rigid/rigid_bodies.h"

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btAabbUtil2.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "sim/rigid/contact_search.h"
#include "sim/rigid/held.h"
#include "sim/rigid/rigid_shape.h"
#include "sim/rigid/triangles.h"
#include "sim/shapes/solid.h"

namespace neve::sim::rigid {

namespace {

/// Bodies are few and a step is short: contact is solved to the end.
constexpr int iterations = 50;
/// No body is larger in Bullet's units, and the largest no smaller than half of it: some of its
/// lengths are absolute, and small and large bodies are to move alike.
constexpr double largest_in_units = 0.2;
/// Share of an error that is taken back in a step: holds have no slack, and overlaps move apart.
constexpr double taken_back = 0.2;
/// Bodies that gravity and springs drive together in so many steps do not bounce: they lie.
constexpr double resting_steps = 3;
/// Bullet's largest coefficient; sticky.
constexpr double without_sliding = 10;

/// Bullet multiplies those of the two that touch: this way it is their geometric mean.
double bullet_friction(const shapes::Collider& collider) {
  if (collider.contact == shapes::Contact::sticky) return without_sliding;
  if (collider.contact == shapes::Contact::slip) return 0;
  return std::min(std::sqrt(collider.friction), without_sliding);
}

/// Columns are principal axes; where the given ones already are, they stay.
Mat3d principal_axes(const Mat3d& inertia) {
  Mat3d off = inertia;
  off.diagonal().setZero();
  if (off.norm() <= 1e-9 * inertia.norm()) return Mat3d::Identity();
  Mat3d axes = Eigen::SelfAdjointEigenSolver<Mat3d>(inertia).eigenvectors();
  if (axes.determinant() < 0) axes.col(0) *= -1;
  return axes;
}

btRigidBody::btRigidBodyConstructionInfo construction(double mass, btCollisionShape* shape,
                                                      const btVector3& inertia) {
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
  info.m_restitution = 0;
  return info;
}

}  // namespace

/// A rigid body of Bullet and what it needs; a collider that the scene moves has no mass there.
class RigidBodies::World {
 public:
  World(const std::vector<Body>& bodies, const std::vector<shapes::Collider>& colliders)
      : unit_(unit_of_length(bodies)) {
    for (const Body& body : bodies) heaviest_ = std::max(heaviest_, body.mass.mass);
    auto next = bodies.begin();
    for (std::size_t k = 0; k < colliders.size(); ++k) {
      const bool moves = next != bodies.end() && next->collider == k;
      things_.push_back(moves ? moving_thing(*next, colliders[k]) : fixed_thing(colliders[k]));
      things_.back().collider = k;
      if (moves) moving_.push_back(k), ++next;
      things_.back().restitution = moves ? colliders[k].body.restitution : 0;
      any_bounces_ = any_bounces_ || things_.back().restitution > 0;
    }
    for (std::size_t k = 0; k < colliders.size(); ++k)
      if (things_[k].deforming) add_twins(colliders[k], k);
    leave_out_joined(bodies, colliders);
  }

  void place(const std::vector<Body>& bodies, const std::vector<shapes::Collider>& colliders,
             double time) {
    for (Thing& thing : things_)
      if (!thing.moves) place_fixed(thing, colliders[thing.collider], time);
    for (std::size_t b = 0; b < bodies.size(); ++b) reset(bodies[b], things_[moving_[b]]);
    detect();
    for (Thing& thing : things_)
      if (thing.deforming) follow_surface(thing, colliders[thing.collider], time);
  }

  void respond(std::vector<Body>& bodies, double dt, const Vec3d& gravity,
               const std::vector<Push>& pushes) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      reset(bodies[b], things_[moving_[b]]);
      push(bodies[b], things_[moving_[b]], dt, gravity, pushes[b]);
    }
    const double slowest = resting_steps * dt * gravity.norm() / unit_;
    if (any_bounces_) set_bounces(dt, slowest);
    solve(dt);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      read(things_[moving_[b]], bodies[b]);
      settle(things_[moving_[b]], bodies[b]);
    }
  }

  /// Returns the speed of the others that may touch a body in a step, m/s.
  /// @param own  speed of the body
  double fastest_near(const Body& body, double own, const std::vector<shapes::Collider>& colliders,
                      double time, double dt) const {
    const auto bounds = [](const Thing& thing) {
      std::array<btVector3, 2> box;
      thing.shape->get()->getAabb(thing.body->getWorldTransform(), box[0], box[1]);
      return box;
    };
    const Thing& self = things_[body.collider];
    const auto [low, high] = bounds(self);
    double fastest = 0;
    for (const Thing& thing : things_) {
      if (&thing == &self || (thing.meets && thing.meets != self.body.get())) continue;
      const shapes::Collider& other = colliders[thing.collider];
      double speed = 0;
      for (const double when : {time, time + dt}) {  // one that rests may start within the step
        const shapes::Pose pose = shapes::pose_at(other, when);
        const Vec3d arm = body.before.centre - pose.point;
        speed = std::max(speed, (pose.velocity + pose.angular_velocity.cross(arm)).norm() +
                                    pose.angular_velocity.norm() * body.furthest);
      }
      if (thing.deforming)
        speed += thing.deforming->fastest(shapes::shape_time(other, time),
                                          shapes::shape_time(other, time + dt));
      if (speed <= fastest) continue;
      const double reach = (own + speed) * dt / unit_;
      const btVector3 beyond(reach, reach, reach);
      const auto [from, to] = bounds(thing);
      if (TestAabbAgainstAabb2(low - beyond, high + beyond, from, to)) fastest = speed;
    }
    return fastest;
  }

 private:
  struct Thing {
    bool moves = false;
    std::size_t collider = 0;
    double restitution = 0;
    std::shared_ptr<RigidShape> shape;
    /// The shape, if it deforms. Bullet knows rigid motions alone: there is such a thing for each
    /// body, and it moves as the surface does where that body touches it.
    Deforming* deforming = nullptr;
    const btRigidBody* meets = nullptr;  ///< the only body that it touches; null: all
    std::unique_ptr<btRigidBody> body;
    btVector3 pushed{0, 0, 0}, pushed_spin{0, 0, 0};  ///< velocities that pushes give in a step
    btVector3 sprung{0, 0, 0}, sprung_spin{0, 0, 0};  ///< of these, what springs give
    bool bounced = false;                             ///< in this step
    Mat3d axes = Mat3d::Identity();                   ///< of the form
    Mat3d principal = Mat3d::Identity();              ///< in the axes of the form
    std::unique_ptr<Held> held;
    std::vector<std::size_t>
        joined;  ///< colliders that it overlaps where it is joined to the world
  };

  static double unit_of_length(const std::vector<Body>& bodies) {
    double furthest = 0;
    for (const Body& body : bodies) furthest = std::max(furthest, body.furthest);
    return furthest > 0 ? std::exp2(std::ceil(std::log2(furthest / largest_in_units))) : 1;
  }

  /// A length or a velocity.
  btVector3 in_units(const Vec3d& v) const { return to_bullet(Vec3d(v / unit_)); }
  Vec3d in_metres(const btVector3& v) const { return unit_ * from_bullet(v); }

  Thing fixed_thing(const shapes::Collider& collider) const {
    Thing out;
    out.axes = shapes::form_axes(collider.shape);
    if (const auto* sequence = std::get_if<shapes::MeshSequence>(&collider.shape.form)) {
      auto shape = std::make_shared<Deforming>(*sequence, unit_);
      out.deforming = shape.get();
      out.shape = std::move(shape);
    } else {
      out.shape = fixed_shape(collider.shape, unit_);
    }
    give_fixed_body(collider, out);
    return out;
  }

  static void give_fixed_body(const shapes::Collider& collider, Thing& out) {
    out.body = std::make_unique<btRigidBody>(construction(0, out.shape->get(), btVector3(0, 0, 0)));
    out.body->setFriction(bullet_friction(collider));
    out.body->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    out.body->setActivationState(DISABLE_DEACTIVATION);
  }

  /// @param k  of the collider, whose thing the first body meets
  void add_twins(const shapes::Collider& collider, std::size_t k) {
    for (const std::size_t body : moving_) {
      const btRigidBody* meets = things_[body].body.get();
      if (!things_[k].meets) {
        things_[k].meets = meets;
        continue;
      }
      Thing twin;
      twin.collider = k;
      twin.axes = things_[k].axes;
      twin.shape = things_[k].shape;
      twin.deforming = things_[k].deforming;
      twin.meets = meets;
      give_fixed_body(collider, twin);
      things_.push_back(std::move(twin));
    }
  }

  Thing moving_thing(const Body& body, const shapes::Collider& collider) const {
    Thing out;
    out.moves = true;
    out.axes = body.axes;
    out.principal = principal_axes(body.mass.inertia);
    out.shape = body_shape(collider.shape, body.mass, out.principal, body.is_convex, unit_);
    const Vec3d inertia =
        (out.principal.transpose() * body.mass.inertia * out.principal).diagonal() /
        (heaviest_ * unit_ * unit_);
    out.body = std::make_unique<btRigidBody>(
        construction(body.mass.mass / heaviest_, out.shape->get(), to_bullet(inertia)));
    out.body->setFriction(bullet_friction(collider));
    out.body->setActivationState(DISABLE_DEACTIVATION);
    // Bullet's gyroscopic torque is damped; see free_turn. A held body takes it along in its rows.
    if (Held::turns_freely(collider.body) || Held::pivot_of(collider.body)) out.body->setFlags(0);
    if (Held::holds(collider.body)) {
      const Mat3d turned = rotation_from_degrees(collider.shape.rotation) * body.axes;
      out.held = std::make_unique<Held>(*out.body, collider, body.mass, turned, unit_);
    }
    return out;
  }

  void place_fixed(Thing& thing, const shapes::Collider& collider, double time) const {
    const shapes::Pose pose = shapes::pose_at(collider, time);
    thing.body->setWorldTransform(
        btTransform(to_bullet(Mat3d(pose.rotation * thing.axes)), in_units(pose.point)));
    thing.body->setLinearVelocity(in_units(pose.velocity));
    thing.body->setAngularVelocity(to_bullet(pose.angular_velocity));
    if (thing.deforming) thing.deforming->move_to(shapes::shape_time(collider, time));
  }

  /// Gives a surface the motion that it has where the body that it meets touches it.
  void follow_surface(Thing& thing, const shapes::Collider& collider, double time) {
    const shapes::Pose pose = shapes::pose_at(collider, time);
    const Mat3d axes = pose.rotation * thing.axes;
    std::vector<Vec3d> places, velocities;
    each_point([&](const btPersistentManifold& manifold, const btManifoldPoint& point) {
      const bool is_first = manifold.getBody0() == thing.body.get();
      if (!is_first && manifold.getBody1() != thing.body.get()) return;
      const Vec3d place =
          in_metres(is_first ? point.getPositionWorldOnA() : point.getPositionWorldOnB());
      const Vec3d arm = place - pose.point;
      const int triangle = is_first ? point.m_index0 : point.m_index1;
      places.push_back(place);
      velocities.push_back(pose.velocity + pose.angular_velocity.cross(arm) +
                           axes * thing.deforming->velocity(triangle, axes.transpose() * arm));
    });
    if (places.empty()) return;
    const Twist twist = twist_of(places, velocities, pose.point);
    thing.body->setLinearVelocity(in_units(twist.velocity));
    thing.body->setAngularVelocity(to_bullet(twist.spin));
  }

  /// Puts a body back to the state before the step.
  void reset(const Body& body, Thing& thing) const {
    const Mat3d form = body.before.rotation * thing.axes;
    thing.body->setWorldTransform(
        btTransform(to_bullet(Mat3d(form * thing.principal)), in_units(body.before.centre)));
    thing.body->updateInertiaTensor();
    thing.body->setLinearVelocity(in_units(body.before.velocity));
    thing.body->setAngularVelocity(to_bullet(body.before.spin));
    thing.bounced = false;
    if (thing.held) thing.held->set_place(body.before.centre, form, body.joint_angle);
  }

  void push(Body& body, Thing& thing, double dt, const Vec3d& gravity, const Push& push) const {
    const Mat3d form = body.before.rotation * thing.axes;
    const Mat3d inertia = form * body.mass.inertia * form.transpose();
    Vec3d impulse = push.impulse + body.mass.mass * dt * gravity, moment = push.moment;
    Vec3d velocity = body.before.velocity + impulse / body.mass.mass;
    Vec3d spin = body.before.spin + inertia.ldlt().solve(moment);
    if (thing.held) {
      // A spring knows what else pushes: it resists the velocity that the body will have.
      const Held::Speeds free{velocity, spin};
      const Held::Speeds later = thing.held->add_springs(
          dt, {body.before.velocity, body.before.spin}, free, inertia, impulse, moment);
      body.later_velocity = later.velocity;
      body.later_spin = later.spin;
      velocity = body.before.velocity + impulse / body.mass.mass;
      spin = body.before.spin + inertia.ldlt().solve(moment);
      thing.sprung = in_units(velocity - free.velocity);
      thing.sprung_spin = to_bullet(Vec3d(spin - free.spin));
    }
    thing.body->setLinearVelocity(in_units(velocity));
    thing.body->setAngularVelocity(to_bullet(spin));
    thing.pushed = in_units(velocity - body.before.velocity);
    thing.pushed_spin = to_bullet(Vec3d(spin - body.before.spin));
  }

  /// Bullet has taken apart what overlapped.
  void read(const Thing& thing, Body& body) const {
    const btTransform& at = thing.body->getWorldTransform();
    body.after.centre = in_metres(at.getOrigin());
    body.after.rotation =
        from_bullet(at.getBasis()) * thing.principal.transpose() * thing.axes.transpose();
    body.after.velocity = in_metres(thing.body->getLinearVelocity());
    body.after.spin = from_bullet(thing.body->getAngularVelocity());
  }

  /// Settles the later speeds: holds take what they do not allow of them, and contacts take of them
  /// what they took of those of the way, at most as much.
  void settle(const Thing& thing, Body& body) const {
    if (body.later_velocity.isZero(0) && body.later_spin.isZero(0)) return;
    const Mat3d form = body.before.rotation * thing.axes;
    const Mat3d inertia = form * body.mass.inertia * form.transpose();
    Held::Speeds later = thing.held->allowed({body.later_velocity, body.later_spin}, inertia);
    const Held::Speeds taken =
        thing.held->allowed({body.after.velocity - body.before.velocity - in_metres(thing.pushed),
                             body.after.spin - body.before.spin - from_bullet(thing.pushed_spin)},
                            inertia);
    const auto product = [&](const Held::Speeds& a, const Held::Speeds& b) {
      return body.mass.mass * a.velocity.dot(b.velocity) + a.spin.dot(inertia * b.spin);
    };
    if (const double along = product(later, taken); along < 0 && !thing.bounced) {
      const double share = std::min(-along / product(taken, taken), 1.0);
      later.velocity += share * taken.velocity;
      later.spin += share * taken.spin;
    }
    body.later_velocity = later.velocity;
    body.later_spin = later.spin;
  }

  /// Everything that Bullet remembers is made anew: what it finds depends on the places alone.
  void detect() {
    world_.reset();
    // It costs more than a step of a few bodies, and has nothing left once the world has gone.
    if (!dispatcher_) dispatcher_ = std::make_unique<Dispatcher>(&configuration_, things_);
    broadphase_ = std::make_unique<btSimpleBroadphase>(static_cast<int>(things_.size()) + 1);
    world_ =
        std::make_unique<btCollisionWorld>(dispatcher_.get(), broadphase_.get(), &configuration_);
    for (std::size_t k = 0; k < things_.size(); ++k) {
      Thing& thing = things_[k];
      thing.body->setUserIndex(static_cast<int>(k));
      world_->addCollisionObject(thing.body.get());
    }
    world_->computeOverlappingPairs();
    dispatcher_->dispatchAllCollisionPairs(broadphase_->getOverlappingPairCache(),
                                           world_->getDispatchInfo(), dispatcher_.get());
    distances_.clear();
    each_point([&](const btPersistentManifold& manifold, btManifoldPoint& point) {
      for (const bool is_first : {true, false}) {
        const btCollisionObject* object = is_first ? manifold.getBody0() : manifold.getBody1();
        const Thing& thing = things_[static_cast<std::size_t>(object->getUserIndex())];
        turn_to_face(*thing.shape, is_first, manifold, point);
      }
      distances_.push_back(point.getDistance());
    });
  }

  /// body(manifold, point)
  template <class Visit>
  void each_point(const Visit& visit) {
    for (int m = 0; m < dispatcher_->getNumManifolds(); ++m) {
      btPersistentManifold& manifold = *dispatcher_->getManifoldByIndexInternal(m);
      for (int k = 0; k < manifold.getNumContacts(); ++k)
        visit(manifold, manifold.getContactPoint(k));
    }
  }

  /// Bullet stops in one step what will touch at its end, and bounces it by what is left in the
  /// next: the rebound would be too slow. Here a point that would touch in the step bounces at its
  /// start, and all others wait. It leaves with its share of the speed that it came with: with a
  /// share of what pushes give in this step as well, a ball would rise higher each time.
  /// @param slowest  in Bullet's units, that bounces
  void set_bounces(double dt, double slowest) {
    auto distance = distances_.begin();
    each_point([&](const btPersistentManifold& manifold, btManifoldPoint& point) {
      const double gap = *distance++;
      const auto number = [](const btCollisionObject* object) {
        return static_cast<std::size_t>(object->getUserIndex());
      };
      Thing &a = things_[number(manifold.getBody0())], &b = things_[number(manifold.getBody1())];
      const auto speed = [&](const Thing& thing, const btVector3& place) {
        const btVector3 arm = place - thing.body->getWorldTransform().getOrigin();
        return thing.body->getVelocityInLocalPoint(arm).dot(point.m_normalWorldOnB);
      };
      const auto given = [&](const Thing& thing, const btVector3& place, const btVector3& velocity,
                             const btVector3& spin) {
        const btVector3 arm = place - thing.body->getWorldTransform().getOrigin();
        return (velocity + spin.cross(arm)).dot(point.m_normalWorldOnB);
      };
      const btVector3 &at_a = point.getPositionWorldOnA(), &at_b = point.getPositionWorldOnB();
      const double closing = speed(b, at_b) - speed(a, at_a),
                   gained = given(b, at_b, b.pushed, b.pushed_spin) -
                            given(a, at_a, a.pushed, a.pushed_spin),
                   sprung = given(b, at_b, b.sprung, b.sprung_spin) -
                            given(a, at_a, a.sprung, a.sprung_spin);
      const bool bounces =
          closing > slowest + resting_steps * std::max(0.0, sprung) && gap < closing * dt;
      const double restitution = std::max(a.restitution, b.restitution);
      point.m_combinedRestitution =
          bounces ? std::max(0.0, restitution * (closing - gained) / closing) : 0;
      const bool is_early = point.m_combinedRestitution > 0 && gap > 0;
      if (point.m_combinedRestitution > 0) a.bounced = b.bounced = true;
      point.setDistance(is_early ? 0 : gap);
    });
  }

  void solve(double dt) {
    btContactSolverInfo info;
    info.m_timeStep = dt;
    info.m_numIterations = iterations;
    info.m_erp = info.m_erp2 = taken_back;
    info.m_splitImpulse = true;
    info.m_splitImpulsePenetrationThreshold = 0;
    info.m_restitutionVelocityThreshold = 0;  // see set_bounces
    info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS;
    std::vector<btCollisionObject*> objects;
    std::vector<btTypedConstraint*> constraints;
    for (Thing& thing : things_) {
      objects.push_back(thing.body.get());
      if (thing.held) constraints.push_back(thing.held.get());
    }
    const auto count = [](const auto& list) { return static_cast<int>(list.size()); };
    solver_.reset();
    solver_.solveGroup(objects.data(), count(objects), dispatcher_->getInternalManifoldPointer(),
                       dispatcher_->getNumManifolds(), constraints.data(), count(constraints), info,
                       nullptr, dispatcher_.get());
  }

  /// A body that is joined to the world where it overlaps something, as a sign with its post, does
  /// not meet that.
  void leave_out_joined(const std::vector<Body>& bodies,
                        const std::vector<shapes::Collider>& colliders) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const std::size_t k = moving_[b];
      if (colliders[k].body.joint == shapes::Joint::none) continue;
      std::vector<Body> start = bodies;
      for (Body& body : start) body.before = at_start(body, colliders[body.collider]);
      std::vector<shapes::Collider> unmoved = colliders;
      for (shapes::Collider& collider : unmoved) collider.pose_offset = {};
      place(start, unmoved, 0);
      for (int m = 0; m < dispatcher_->getNumManifolds(); ++m) {
        const btPersistentManifold* manifold = dispatcher_->getManifoldByIndexInternal(m);
        const int first = manifold->getBody0()->getUserIndex(),
                  second = manifold->getBody1()->getUserIndex();
        const int self = static_cast<int>(k);
        if ((first == self || second == self) && manifold->getNumContacts() > 0)
          things_[k].joined.push_back(static_cast<std::size_t>(first == self ? second : first));
      }
    }
  }

  static Motion at_start(const Body& body, const shapes::Collider& collider) {
    const Mat3d rotation = rotation_from_degrees(collider.shape.rotation);
    return {shapes::center(collider.shape) + rotation * body.axes * body.mass.centre, rotation,
            Vec3d::Zero(), Vec3d::Zero()};
  }

  class Dispatcher final : public btCollisionDispatcher {
   public:
    Dispatcher(btCollisionConfiguration* configuration, const std::vector<Thing>& things)
        : btCollisionDispatcher(configuration), things_(things) {}
    bool needsCollision(const btCollisionObject* a, const btCollisionObject* b) override {
      return btCollisionDispatcher::needsCollision(a, b) && !is_joined(a, b) && !is_joined(b, a) &&
             meets(a, b) && meets(b, a);
    }

   private:
    bool meets(const btCollisionObject* a, const btCollisionObject* b) const {
      const btRigidBody* only = things_[static_cast<std::size_t>(a->getUserIndex())].meets;
      return !only || only == b;
    }
    bool is_joined(const btCollisionObject* a, const btCollisionObject* b) const {
      const auto& joined = things_[static_cast<std::size_t>(a->getUserIndex())].joined;
      return std::find(joined.begin(), joined.end(), static_cast<std::size_t>(b->getUserIndex())) !=
             joined.end();
    }
    const std::vector<Thing>& things_;
  };

  /// kg. Bullet's impulses have a largest size: its unit of mass is that of the heaviest body.
  double heaviest_ = 0;
  /// m. A power of two, which rounds nothing.
  const double unit_;
  std::vector<Thing> things_;        ///< per collider, and further ones of those that deform
  std::vector<std::size_t> moving_;  ///< per body: its thing
  std::vector<double> distances_;    ///< per point of contact, as they were found
  bool any_bounces_ = false;
  ContactSearch configuration_;
  std::unique_ptr<Dispatcher> dispatcher_;
  std::unique_ptr<btSimpleBroadphase> broadphase_;
  std::unique_ptr<btCollisionWorld> world_;
  btSequentialImpulseConstraintSolver solver_;
};

namespace {

/// @param centre  of mass, from the point of the pose in the axes of the scene
Motion motion_of(const shapes::Pose& pose, const Vec3d& centre) {
  const Vec3d arm = pose.rotation * centre;
  return {pose.point + arm, pose.rotation, pose.velocity + pose.angular_velocity.cross(arm),
          pose.angular_velocity};
}

}  // namespace

Motion motion_at(const shapes::Collider& body, double time) {
  return motion_of(shapes::pose_at(body, time),
                   shapes::form_axes(body.shape) * mass_properties(body).centre);
}

Motion motion_at_start(const shapes::Collider& collider) {
  Motion motion = motion_at(collider, 0);
  if (!Held::holds(collider.body)) return motion;
  const MassProperties mass = mass_properties(collider);
  const Mat3d form = motion.rotation * shapes::form_axes(collider.shape);
  btRigidBody any(construction(1, nullptr, btVector3(1, 1, 1)));  // rows are of a body
  const Held held(any, collider, mass, form, 1);
  const Held::Speeds allowed =
      held.allowed({motion.velocity, motion.spin}, form * mass.inertia * form.transpose());
  motion.velocity = allowed.velocity;
  motion.spin = allowed.spin;
  return motion;
}

RigidBodies::RigidBodies(const std::vector<shapes::Collider>& colliders) {
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    const shapes::Collider& c = colliders[k];
    if (!c.body.moves()) continue;
    try {
      const MassProperties mass = mass_properties(c);
      const shapes::Bounds box = shapes::Solid(c.shape).local_bounds();
      const Vec3d far = (box.max - mass.centre).cwiseMax(mass.centre - box.min);
      bodies_.push_back({k,
                         mass,
                         shapes::form_axes(c.shape),
                         (box.max - box.min).minCoeff(),
                         far.norm(),
                         is_convex(c.shape),
                         {},
                         {}});
    } catch (const ShapeError& error) {
      throw ShapeError("collider " + c.name + ": " + error.what());
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("collider " + c.name + ": " + error.what());
    }
  }
}

RigidBodies::~RigidBodies() = default;
RigidBodies::RigidBodies(RigidBodies&&) noexcept = default;
RigidBodies& RigidBodies::operator=(RigidBodies&&) noexcept = default;
RigidBodies::RigidBodies(const RigidBodies& other) : bodies_(other.bodies_) {}
RigidBodies& RigidBodies::operator=(const RigidBodies& other) {
  bodies_ = other.bodies_;
  world_.reset();
  return *this;
}

void RigidBodies::start(std::vector<shapes::Collider>& colliders) const {
  constexpr double rounding = 1e-12;
  for (const Body& body : bodies_) {
    shapes::Collider& collider = colliders[body.collider];
    if (collider.pose_offset.motion || !Held::holds(collider.body)) continue;
    const Motion given = motion_at(collider, 0), allowed = motion_at_start(collider);
    const double taken = (allowed.velocity - given.velocity).norm() +
                         body.furthest * (allowed.spin - given.spin).norm();
    if (taken <= rounding * (given.velocity.norm() + body.furthest * given.spin.norm())) continue;
    const Vec3d arm = given.rotation * body.axes * body.mass.centre;
    collider.pose_offset.motion =
        std::array{Vec3d(allowed.velocity - allowed.spin.cross(arm)), allowed.spin};
  }
}

void RigidBodies::begin(const std::vector<shapes::Collider>& colliders, double time) {
  if (!world_) world_ = std::make_unique<World>(bodies_, colliders);
  for (Body& body : bodies_) {
    const shapes::Pose pose = shapes::pose_at(colliders[body.collider], time);
    body.before = motion_of(pose, body.axes * body.mass.centre);
    body.after = body.before;
    body.later_velocity.setZero();
    body.later_spin.setZero();
    body.point = pose.point - body.before.centre;
    body.joint_angle = colliders[body.collider].pose_offset.joint_angle;
  }
  world_->place(bodies_, colliders, time);
}

void RigidBodies::respond(double dt, const Vec3d& gravity, const std::vector<Push>& pushes) {
  world_->respond(bodies_, dt, gravity, pushes);
}

Mat3d RigidBodies::inertia(std::size_t body) const {
  const Mat3d form = bodies_[body].before.rotation * bodies_[body].axes;
  return form * bodies_[body].mass.inertia * form.transpose();
}

int RigidBodies::parts_of_step(const std::vector<shapes::Collider>& colliders, double time,
                               double dt, const Vec3d& gravity) const {
  double parts = 1;
  for (const Body& body : bodies_) {
    const double own =
        body.before.velocity.norm() + dt * gravity.norm() + body.before.spin.norm() * body.furthest;
    const double speed = own + world_->fastest_near(body, own, colliders, time, dt);
    parts = std::max(parts, std::ceil(4 * speed * dt / body.thickness));
  }
  // A body beyond these parts is faster than anything that neve shows: a step ends in any case.
  return static_cast<int>(std::min(parts, 1000.0));
}

namespace {

struct Turn {
  Mat3d rotation;
  Vec3d spin;
};

/// The turn of a body that nothing turns, and its spin at the end. The angular momentum stays as it
/// is, and the implicit midpoint of the turn keeps the energy to second order, without drift.
/// @param momentum  angular, about what it turns about @param inertia  in the axes of the form
/// @param halvings  that are left: a body on a joint may be turned further than the midpoint finds
Turn free_turn(const Mat3d& rotation, const Mat3d& axes, const Vec3d& momentum,
               const Mat3d& inertia, double dt, int halvings = 8) {
  constexpr double min_spin = 1e-300;
  const Mat3d inverse = inertia.inverse();
  const auto spin_at = [&](const Mat3d& attitude) {
    const Mat3d form = attitude * axes;
    return Vec3d(form * (inverse * (form.transpose() * momentum)));
  };
  const auto turned = [&](double time, const Vec3d& spin) {
    return Mat3d(rotation_from_vector(time * spin) * rotation);
  };
  constexpr int most = 30;  // a step turns by less than a quarter: each one gains a digit
  constexpr double enough = 1e-15, nothing_found = 1e-6;
  Vec3d spin = spin_at(rotation);
  double change = INFINITY;  // of the spin, for its length
  for (int k = 0; k < most && change > enough; ++k) {
    const Vec3d next = spin_at(turned(0.5 * dt, spin));
    change = (next - spin).norm() / std::max(next.norm(), min_spin);
    spin = next;
  }
  if (change > nothing_found && halvings > 0) {
    const Turn half = free_turn(rotation, axes, momentum, inertia, 0.5 * dt, halvings - 1);
    return free_turn(half.rotation, axes, momentum, inertia, 0.5 * dt, halvings - 1);
  }
  const Mat3d end = turned(dt, spin);
  return {end, spin_at(end)};
}

/// The turn of a body about its hinge or ball joint, and its spin at the end: of a hinge it is the
/// same, of a ball joint that of a body whose inertia is about the joint.
/// @param lever  from the joint to the centre of mass, in the axes of the form
/// @param hinge  its axis; nothing: a ball joint
Turn joined_turn(const Motion& at, const Mat3d& axes, const Vec3d& lever,
                 const MassProperties& mass, const std::optional<Vec3d>& hinge, double dt) {
  const Mat3d form = at.rotation * axes;
  const Mat3d inertia = mass.inertia + mass.mass * inertia_at(lever);
  const Vec3d momentum = form * (mass.inertia * (form.transpose() * at.spin)) +
                         mass.mass * (form * lever).cross(at.velocity);
  if (!hinge) return free_turn(at.rotation, axes, momentum, inertia, dt);
  const Vec3d& axis = *hinge;
  const Vec3d in_form = form.transpose() * axis;
  const Vec3d spin = axis.dot(momentum) / in_form.dot(inertia * in_form) * axis;
  // The part beside the axis turns a body back that has tilted, for this step.
  const Vec3d beside = at.spin - axis.dot(at.spin) * axis;
  return {rotation_from_vector(dt * (spin + beside)) * at.rotation, spin};
}

}  // namespace

void RigidBodies::move(std::size_t k, double dt, double time, shapes::Collider& collider) const {
  const Body& body = bodies_[k];
  const Motion& after = body.after;
  const auto arm_of = [&](const Mat3d& rotation) {
    return Vec3d(rotation * body.axes * body.mass.centre);
  };
  const std::optional<Held::Pivot> pivot = Held::pivot_of(collider.body);
  const Mat3d at_first = rotation_from_degrees(collider.shape.rotation);
  // From the joint to the centre of mass, in the axes of the form.
  const Vec3d lever =
      body.axes.transpose() * at_first.transpose() *
      (shapes::center(collider.shape) + arm_of(at_first) - collider.body.joint_point);
  const Turn turn =
      pivot ? joined_turn(after, body.axes, lever, body.mass, pivot->axis, dt)
      : Held::turns_freely(collider.body)
          ? free_turn(after.rotation, body.axes, inertia(k) * after.spin, body.mass.inertia, dt)
          : Turn{rotation_from_vector(dt * after.spin) * after.rotation, after.spin};
  const Vec3d spin = turn.spin + body.later_spin;
  // Products of many turns stay a turn.
  const Eigen::Quaterniond attitude = Eigen::Quaterniond(turn.rotation).normalized();
  const Mat3d rotation = attitude.toRotationMatrix();
  const Vec3d arm = arm_of(rotation);
  Vec3d centre = after.centre + dt * after.velocity,
        velocity = after.velocity + body.later_velocity;
  if (pivot) {
    // The centre of mass goes round the joint, and its speed with it: along the tangent at its
    // start it would leave the circle, and lose speed as it is put back. The rest of the
    // velocity goes back to the joint, for this step.
    const Vec3d from = after.rotation * body.axes * lever, to = rotation * body.axes * lever;
    centre += to - from - dt * after.spin.cross(from);
    velocity = spin.cross(to);
  }
  const Vec3d point = centre - arm;
  const Mat3d since_start = rotation * at_first.transpose();
  double joint_angle = 0;
  if (collider.body.joint == shapes::Joint::hinge) {
    const Vec3d axis = collider.body.joint_axis.stableNormalized();
    joint_angle = hinge_angle(axis, since_start, body.joint_angle + dt * axis.dot(body.after.spin));
  }
  collider.pose_offset = {time,
                          point - shapes::center(collider.shape),
                          since_start,
                          collider.pose_offset.delay,
                          std::array{Vec3d(velocity - spin.cross(arm)), spin},
                          joint_angle};
}

}  // namespace neve::sim::rigid
