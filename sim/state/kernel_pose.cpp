#include "sim/state/kernel_pose.h"

#include <stdexcept>

#include "sim/kernels/blocks.h"
#include "sim/state/records.h"

namespace neve::sim::engine {

namespace {

/// The measures of each form, as kernels want them.
struct SetForm {
  kernels::ColliderPose& out;
  const shapes::Pose& pose;
  const shapes::DistanceSamples& samples;
  const shapes::HeightSamples& heights;

  void operator()(const shapes::Plane& plane) const {
    out.shape = kernels::ColliderShape::plane;
    const Vec3d n = pose.rotation * plane.normal.normalized();
    for (int a = 0; a < 3; ++a) out.normal[a] = n[a];
  }
  void operator()(const shapes::Sphere& sphere) const {
    out.shape = kernels::ColliderShape::sphere;
    out.radius = sphere.radius;
  }
  void operator()(const shapes::Box& box) const {
    out.shape = kernels::ColliderShape::box;
    for (int a = 0; a < 3; ++a) out.half[a] = 0.5 * box.size[a];
  }
  void operator()(const shapes::Capsule& capsule) const {
    set_round(kernels::ColliderShape::capsule, capsule.radius, (capsule.b - capsule.a).norm());
  }
  void operator()(const shapes::Cylinder& cylinder) const {
    set_round(kernels::ColliderShape::cylinder, cylinder.radius, cylinder.height);
  }
  void operator()(const shapes::Cone& cone) const {
    set_round(kernels::ColliderShape::cone, cone.radius, cone.height);
  }
  void operator()(const shapes::Torus& torus) const {
    set_round(kernels::ColliderShape::torus, torus.minor_radius, 0);
    out.ring = torus.major_radius;
  }
  void operator()(const shapes::Mesh&) const { set_field(); }
  void operator()(const shapes::MeshSequence&) const { set_field(); }
  void operator()(const shapes::Points&) const {
    throw std::invalid_argument("points have no surface: they cannot be a collider");
  }
  void operator()(const shapes::Terrain&) const {
    out.shape = kernels::ColliderShape::heights;
    out.heights = heights;
  }
  void operator()(const shapes::Cover&) const {
    throw std::invalid_argument("a cover is snow: it cannot be a collider");
  }

 private:
  void set_field() const {
    out.shape = kernels::ColliderShape::field;
    out.samples = samples;
  }
  void set_round(kernels::ColliderShape shape, double radius, double length) const {
    out.shape = shape;
    out.radius = radius;
    out.half[1] = 0.5 * length;
  }
};

bool is_in_lattice(const Vec3d& x, double cell_size) {
  return x.cwiseAbs().maxCoeff() / cell_size < 4.0 * kernels::block_limit;
}

/// Kernels count from the point of the pose, in single precision. The middle of the field takes its
/// place where that would show, as for a mesh whose file has the coordinates of a map. A body keeps
/// its own: its steps take moments about it.
void move_to_middle(const Mat3d& axes, double cell_size, shapes::Pose& pose,
                    shapes::DistanceSamples& samples) {
  constexpr double single = 0x1p-23, visible = 1e-3;  // of a cell
  Vec3d middle;
  for (int a = 0; a < 3; ++a)
    middle[a] = samples.first[a] + 0.5 * samples.spacing * (samples.size[a] - 1);
  if (single * middle.cwiseAbs().maxCoeff() < visible * cell_size) return;
  const Vec3d way = axes * middle;
  pose.point += way;
  pose.velocity += pose.angular_velocity.cross(way);
  for (int a = 0; a < 3; ++a) samples.first[a] -= middle[a];
}

/// The same plane by the point of its surface that is nearest to the origin.
void move_to_foot(const shapes::Plane& plane, shapes::Pose& pose) {
  const Vec3d n = pose.rotation * plane.normal.normalized();
  const Vec3d foot = n.dot(pose.point) * n;
  pose.velocity += pose.angular_velocity.cross(foot - pose.point);
  pose.point = foot;
}

}  // namespace

std::optional<KernelPose> kernel_pose(const shapes::Collider& c, double time, double cell_size,
                                      const Vec3i& lattice_origin,
                                      const shapes::DistanceSamples& samples,
                                      const shapes::HeightSamples& heights) {
  shapes::Pose pose = shapes::pose_at(c, time);
  const Vec3d own = pose.point;
  if (const auto* plane = std::get_if<shapes::Plane>(&c.shape.form);
      plane && !is_in_lattice(pose.point, cell_size))
    move_to_foot(*plane, pose);
  const Mat3d axes = pose.rotation * shapes::form_axes(c.shape);
  shapes::DistanceSamples field = samples;
  if (field.distance && !c.body.moves()) move_to_middle(axes, cell_size, pose, field);
  if (!is_in_lattice(pose.point, cell_size)) return std::nullopt;
  KernelPose out{};
  out.moved = pose.point - own;
  out.contact = static_cast<kernels::ContactLaw>(c.contact);
  out.friction = c.friction;
  out.moves_by_itself = c.body.moves();
  for (int a = 0; a < 3; ++a) {
    const double in_cells = pose.point[a] / cell_size;
    split(in_cells, out.cell[a], out.offset[a]);
    out.cell[a] += kernels::block_side * lattice_origin[a];
    out.velocity[a] = pose.velocity[a];
    out.omega[a] = pose.angular_velocity[a];
    for (int b = 0; b < 3; ++b) out.axes[3 * a + b] = axes(a, b);
  }
  std::visit(SetForm{out, pose, field, heights}, c.shape.form);
  return out;
}

}  // namespace neve::sim::engine
