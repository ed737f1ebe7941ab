#include "app/collider_looks.h"

#include <memory>
#include <optional>
#include <utility>

#include "app/scene/value.h"
#include "app/to_float.h"
#include "render/mesh_shapes.h"
#include "sim/mesh_surface.h"

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

/// Of any other form, placed: solid or ghost as triangles, otherwise as lines. Edges show where a
/// ghost would have no rim.
void add_form(render::TriangleMesh mesh, render::Lines lines, ColliderStyle style, bool has_rim,
              render::Frame& frame) {
  if (style == ColliderStyle::wire) return add_lines(std::move(lines), 0.7f, frame);
  if (style == ColliderStyle::ghost && !has_rim) add_lines(std::move(lines), 0.35f, frame);
  (style == ColliderStyle::ghost ? frame.ghosts : frame.meshes).push_back(std::move(mesh));
}

std::optional<render::Profile> profile_of(const sim::Shape& shape) {
  const auto real = [](double x) { return static_cast<float>(x); };
  if (const auto* s = std::get_if<sim::Capsule>(&shape.form))
    return render::capsule_profile(real(0.5 * (s->b - s->a).norm()), real(s->radius));
  if (const auto* s = std::get_if<sim::Cylinder>(&shape.form))
    return render::cylinder_profile(real(0.5 * s->height), real(s->radius));
  if (const auto* s = std::get_if<sim::Cone>(&shape.form))
    return render::cone_profile(real(0.5 * s->height), real(s->radius));
  if (const auto* s = std::get_if<sim::Torus>(&shape.form))
    return render::torus_profile(real(s->major_radius), real(s->minor_radius));
  return std::nullopt;
}

/// Of a mesh, about the origin of its file.
struct MeshLook {
  render::TriangleMesh mesh;
  render::Lines lines;
};

/// Made once for all frames.
std::shared_ptr<const MeshLook> look_of(const sim::Mesh& mesh) {
  static sim::Recent<MeshLook> recent;
  return recent.get(sim::file_stamp(mesh.file) + "|" + number_text(mesh.scale), [&] {
    const std::shared_ptr<const sim::MeshSurface> surface = sim::mesh_surface(mesh);
    std::vector<Vec3f> position;
    std::vector<std::uint32_t> index;
    for (const sim::Vec3d& x : surface->mesh().vertices) position.push_back(to_float(x));
    for (const auto& t : surface->mesh().triangles) index.insert(index.end(), t.begin(), t.end());
    return std::make_shared<const MeshLook>(
        MeshLook{render::creased_mesh(position, index), render::mesh_lines(position, index)});
  });
}

void add_other(const sim::Shape& shape, const sim::Pose& pose, ColliderStyle style,
               render::Frame& frame) {
  const Vec3f center = to_float(pose.point);
  const render::Rotation rotation = to_rotation(pose.rotation * sim::form_axes(shape));
  if (const std::optional<render::Profile> profile = profile_of(shape)) {
    const bool has_rim = std::holds_alternative<sim::Capsule>(shape.form) ||
                         std::holds_alternative<sim::Torus>(shape.form);
    return add_form(render::round_mesh(*profile, center, rotation),
                    render::round_lines(*profile, center, rotation, style == ColliderStyle::ghost),
                    style, has_rim, frame);
  }
  const std::shared_ptr<const MeshLook> look = look_of(std::get<sim::Mesh>(shape.form));
  add_form(render::moved_mesh(look->mesh, center, rotation),
           render::moved_lines(look->lines, center, rotation), style, false, frame);
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
    else
      add_other(collider.shape, pose, collider.style, frame);
  }
}

}  // namespace neve::app
