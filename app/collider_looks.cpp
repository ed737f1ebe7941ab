#include "app/collider_looks.h"
#include "app/to_float.h"

#include "render/mesh_shapes.h"

namespace neve::app {

namespace {

constexpr Vec3f wire_color{0.62f, 0.70f, 0.80f};

render::Rotation to_rotation(const sim::Mat3d& matrix) {
  render::Rotation rotation;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rotation[static_cast<std::size_t>(3 * row + column)] =
          static_cast<float>(matrix(row, column));
  return rotation;
}

void add_plane(const sim::Plane& plane, const sim::Pose& pose, ColliderStyle style,
               float line_spacing, render::Frame& frame) {
  render::GroundPlane ground;
  ground.point = to_float(pose.point);
  ground.normal = to_float((pose.rotation * plane.normal).normalized());
  ground.line_spacing = line_spacing;
  if (style == ColliderStyle::wire) ground.fill = 0;
  (style == ColliderStyle::solid ? frame.grounds : frame.ghost_grounds).push_back(ground);
}

void add_lines(render::Lines lines, float opacity, render::Frame& frame) {
  lines.color = wire_color;
  lines.opacity = opacity;
  frame.lines.push_back(std::move(lines));
}

void add_sphere(const sim::Sphere& sphere, const sim::Pose& pose, ColliderStyle style,
                render::Frame& frame) {
  const Vec3f center = to_float(pose.point);
  const auto radius = static_cast<float>(sphere.radius);
  if (style == ColliderStyle::wire)
    return add_lines(render::sphere_lines(center, radius, to_rotation(pose.rotation)), 0.7f, frame);
  (style == ColliderStyle::ghost ? frame.ghosts : frame.meshes)
      .push_back(render::sphere_mesh(center, radius));
}

/// Flat faces have no rim: a ghost shows its edges instead.
void add_box(const sim::Box& box, const sim::Pose& pose, ColliderStyle style,
             render::Frame& frame) {
  const Vec3f center = to_float(pose.point), size = to_float(box.size);
  const render::Rotation rotation = to_rotation(pose.rotation);
  if (style != ColliderStyle::solid)
    add_lines(render::box_lines(center, size, rotation), style == ColliderStyle::wire ? 0.8f : 0.5f,
              frame);
  if (style == ColliderStyle::wire) return;
  (style == ColliderStyle::ghost ? frame.ghosts : frame.meshes)
      .push_back(render::box_mesh(center, size, rotation));
}

}  // namespace

void add_colliders(const Scene& scene, const View& view, double time, float line_spacing,
                   render::Frame& frame) {
  for (const Collider& collider : scene.colliders) {
    const sim::Pose pose = sim::pose_at(collider, time);
    const auto* plane = std::get_if<sim::Plane>(&collider.shape.form);
    if (!has_layer(view, plane ? Layer::ground : Layer::colliders)) continue;
    if (plane)
      add_plane(*plane, pose, collider.style, line_spacing, frame);
    else if (const auto* sphere = std::get_if<sim::Sphere>(&collider.shape.form))
      add_sphere(*sphere, pose, collider.style, frame);
    else if (const auto* box = std::get_if<sim::Box>(&collider.shape.form))
      add_box(*box, pose, collider.style, frame);
  }
}

}  // namespace neve::app
