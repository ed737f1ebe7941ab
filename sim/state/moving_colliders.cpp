#include "sim/state/moving_colliders.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/types/errors.h"

namespace neve::sim::engine {

namespace {

bool moves(const kernels::ColliderPose& pose) {
  return pose.shape_speed > 0 ||
         std::any_of(pose.velocity, pose.velocity + 3, [](double v) { return v != 0; }) ||
         std::any_of(pose.omega, pose.omega + 3, [](double w) { return w != 0; });
}

bool is_same_place(const kernels::ColliderPose& a, const kernels::ColliderPose& b) {
  return std::equal(a.cell, a.cell + 3, b.cell) && std::equal(a.offset, a.offset + 3, b.offset) &&
         std::equal(a.axes, a.axes + 9, b.axes);
}

kernels::LocalCollider<double> seen_from_cell_0(const kernels::ColliderPose& pose, double h) {
  constexpr int cell_0[3] = {0, 0, 0};
  return kernels::localize<double>(pose, cell_0, h);
}

/// Middle of the particles that a block may have.
Vec3<double> middle_of(std::uint64_t key, double h) {
  Vec3<double> middle;
  for (int axis = 0; axis < 3; ++axis)
    middle[axis] = (kernels::block_coordinate(key, axis) * kernels::block_side + 2.75) * h;
  return middle;
}

/// Largest speed of the surface around a place. @param c  seen from cell 0
double speed_around(const kernels::LocalCollider<double>& c, const Vec3<double>& middle,
                    double around) {
  const Vec3<double> arm = c.to_block + middle;
  const double turning = std::sqrt(dot(c.omega, c.omega)) * (std::sqrt(dot(arm, arm)) + around);
  return std::sqrt(dot(c.velocity, c.velocity)) + turning + c.shape_speed;
}

/// The largest speed of a surface at blocks of particles that it can meet within dt: blocks are
/// looked at in fours.
class SpeedNear {
 public:
  /// @param c  seen from cell 0  @param snow_speed  m/s  @param fastest  gets it, if it is larger
  SpeedNear(const kernels::LocalCollider<double>& c, double h, double dt, double snow_speed,
            double& fastest)
      : c_(c), h_(h), dt_(dt), snow_speed_(snow_speed), fastest_(fastest) {}
  SpeedNear(const SpeedNear&) = delete;
  SpeedNear& operator=(const SpeedNear&) = delete;
  ~SpeedNear() { look(); }

  void add(std::uint64_t key) {
    const Vec3<double> middle = middle_of(key, h_);
    // Particles lie within 4 cells of the middle; they touch within half a cell of the surface, and
    // the block is where they were before the last step.
    const double around = 4 * h_, speed = speed_around(c_, middle, around);
    if (speed <= fastest_) return;
    for (int a = 0; a < 3; ++a) middle_[a][count_] = middle[a];
    reach_[count_] = around + 1.5 * h_ + (speed + snow_speed_) * dt_;
    speed_[count_] = speed;
    if (++count_ == 4) look();
  }

 private:
  void look() {
    if (count_ == 0) return;
    // Places that are left repeat the first.
    for (int l = count_; l < 4; ++l)
      for (int a = 0; a < 3; ++a) middle_[a][l] = middle_[a][0];
    const auto are_far = kernels::are_out_of_reach(c_, middle_, reach_);
    for (int l = 0; l < count_; ++l)
      if (!are_far[l]) fastest_ = std::max(fastest_, speed_[l]);
    count_ = 0;
  }

  const kernels::LocalCollider<double>& c_;
  const double h_, dt_, snow_speed_;
  double& fastest_;
  Vec3<Quad<double>> middle_{};
  Quad<double> reach_{};
  double speed_[4] = {};
  int count_ = 0;
};

}  // namespace

MovingColliders::MovingColliders(const std::vector<shapes::Collider>& colliders,
                                 const Lattice& lattice, double time, ThreadPool& pool)
    : list_(colliders), bodies_(colliders) {
  if (list_.size() > kernels::max_colliders)
    throw std::invalid_argument("at most " + std::to_string(kernels::max_colliders) + " colliders");
  for (const shapes::Collider& c : list_) {
    try {
      fields_.push_back(make_field(c, lattice, pool));
    } catch (const ShapeError& error) {
      throw ShapeError("collider " + c.name + ": " + error.what());
    }
  }
  bodies_.start(list_);
  place(lattice, time, pool);
}

MovingColliders::Field MovingColliders::make_field(const shapes::Collider& collider,
                                                   const Lattice& lattice, ThreadPool& pool) {
  if (const auto* mesh = std::get_if<shapes::Mesh>(&collider.shape.form))
    return {shapes::distance_field(*mesh, lattice.cell_size, pool), std::nullopt, nullptr};
  if (const auto* sequence = std::get_if<shapes::MeshSequence>(&collider.shape.form))
    return {nullptr,
            shapes::DeformingField(shapes::deforming_mesh(*sequence), sequence->files,
                                   lattice.cell_size),
            nullptr};
  if (const auto* terrain = std::get_if<shapes::Terrain>(&collider.shape.form))
    return {nullptr, std::nullopt, shapes::height_field(*terrain)};
  return {};
}

bool MovingColliders::deform() const {
  return std::any_of(fields_.begin(), fields_.end(),
                     [](const Field& field) { return field.deforming.has_value(); });
}

shapes::DistanceSamples MovingColliders::Field::samples() const {
  if (rigid) return rigid->samples();
  if (deforming) return deforming->samples();
  return {};
}

shapes::HeightSamples MovingColliders::Field::heights() const {
  return terrain ? terrain->samples() : shapes::HeightSamples{};
}

/// Returns the pose of a collider; one that deforms has the shape that it was placed with.
std::optional<KernelPose> MovingColliders::pose_at(std::size_t k, const Lattice& lattice,
                                                   double time, double until) const {
  auto pose = kernel_pose(list_[k], time, lattice.cell_size, lattice.origin, fields_[k].samples(),
                          fields_[k].heights());
  if (pose) pose->shape_speed = shape_speed(k, time, until);
  return pose;
}

double MovingColliders::shape_speed(std::size_t k, double from, double to) const {
  if (!fields_[k].deforming) return 0;
  return fields_[k].deforming->mesh().fastest(shapes::shape_time(list_[k], from),
                                              shapes::shape_time(list_[k], to));
}

void MovingColliders::place(const Lattice& lattice, double time, ThreadPool& pool) {
  poses_.clear();
  moved_.assign(list_.size(), Vec3d::Zero());
  has_begun_ = false;
  for (std::size_t k = 0; k < list_.size(); ++k) {
    if (fields_[k].deforming)
      fields_[k].deforming->move_to(shapes::shape_time(list_[k], time), pool);
    if (auto pose = pose_at(k, lattice, time, time)) {
      pose->index = static_cast<int>(k);
      poses_.push_back(*pose);
      moved_[k] = pose->moved;
    }
  }
}

rigid::RigidBodies* MovingColliders::begin_bodies(double time) {
  if (bodies_.empty()) return nullptr;
  bodies_.begin(list_, time);
  has_begun_ = true;
  return &bodies_;
}

void MovingColliders::move_bodies(double time, double dt, const Vec3d& gravity,
                                  const std::vector<rigid::Push>& pushes) {
  if (bodies_.empty()) return;
  if (!has_begun_) bodies_.begin(list_, time);
  has_begun_ = false;
  const int parts = bodies_.parts_of_step(list_, time, dt, gravity);
  std::vector<rigid::Push> shares = pushes;
  for (std::size_t b = 0; b < shares.size(); ++b) {
    rigid::Push& push = shares[b];
    push.moment += bodies_.point(b).cross(push.impulse);
    push.impulse /= parts;
    push.moment /= parts;
  }
  const double part = dt / parts;
  for (int n = 0; n < parts; ++n) {
    const double start = time + n * part;
    if (n > 0) bodies_.begin(list_, start);
    bodies_.respond(part, gravity, shares);
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      bodies_.move(b, part, start + part, list_[bodies_.collider(b)]);
  }
}

double MovingColliders::fastest_near(const std::vector<kernels::BlockRange>& blocks,
                                     const Lattice& lattice, double time, double dt,
                                     double snow_speed) const {
  double fastest = 0;
  for (std::size_t k = 0; k < list_.size(); ++k)
    // One that rests now may start within the step.
    for (const double when : {time, time + dt}) {
      const auto pose = pose_at(k, lattice, when, time + dt);
      if (!pose || !moves(*pose)) continue;
      const auto c = seen_from_cell_0(*pose, lattice.cell_size);
      SpeedNear near(c, lattice.cell_size, dt, snow_speed, fastest);
      for (const kernels::BlockRange& block : blocks) near.add(block.key);
      // A body keeps its velocity until it is pushed.
      if (list_[k].body.moves()) break;
    }
  return fastest;
}

void MovingColliders::look_ahead(const Lattice& lattice, double time, double dt) {
  cell_size_ = lattice.cell_size;
  dt_ = dt;
  ahead_.clear();
  for (std::size_t k = 0; k < list_.size(); ++k) {
    const auto now = pose_at(k, lattice, time, time + dt);
    const auto then = pose_at(k, lattice, time + dt, time + dt);
    if (now) ahead_.push_back(seen_from_cell_0(*now, cell_size_));
    if (then && !(now && is_same_place(*now, *then)))
      ahead_.push_back(seen_from_cell_0(*then, cell_size_));
  }
}

/// Nodes of a block lie within 5.7 cells of its middle, and so do particles wherever contact looks
/// for them; what comes nearer in the step by more than that, they and the collider, is added.
bool MovingColliders::is_free(std::uint64_t key, double snow_speed) const {
  const Vec3<double> middle = middle_of(key, cell_size_);
  const double around = 5.7 * cell_size_;
  return std::all_of(ahead_.begin(), ahead_.end(), [&](const auto& c) {
    const double closing = 2 * (speed_around(c, middle, around) + snow_speed) * dt_;
    return kernels::is_out_of_reach(c, middle, around + closing);
  });
}

std::uint64_t MovingColliders::memory_bytes() const {
  std::uint64_t bytes = 0;
  for (const Field& field : fields_) {
    bytes += field.rigid ? field.rigid->bytes() : 0;
    bytes += field.deforming ? field.deforming->bytes() : 0;
    bytes += field.terrain ? field.terrain->grid().height.size() * sizeof(float) : 0;
  }
  return bytes;
}

}  // namespace neve::sim::engine
