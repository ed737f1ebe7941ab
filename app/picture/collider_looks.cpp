#include "app/picture/collider_looks.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "app/picture/to_float.h"
#include "app/scene/toml/value.h"
#include "render/shapes/mesh_shapes.h"
#include "sim/shapes/deforming_mesh.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/solid.h"

namespace neve::app::picture {

namespace {

constexpr Vec3f wire_color{0.62f, 0.70f, 0.80f};

void add_plane(const sim::shapes::Plane& plane, const sim::shapes::Pose& pose,
               scene::ColliderStyle style, float line_spacing, render::Frame& frame) {
  render::GroundPlane ground;
  ground.point = to_float(pose.point);
  ground.normal = to_float((pose.rotation * plane.normal).normalized());
  ground.line_spacing = line_spacing;
  if (style == scene::ColliderStyle::wire) ground.fill = 0;
  ground.is_holdout = style == scene::ColliderStyle::holdout;
  (hides(style) ? frame.grounds : frame.ghost_grounds).push_back(ground);
}

void add_lines(render::Lines lines, float opacity, render::Frame& frame) {
  lines.color = wire_color;
  lines.opacity = opacity;
  frame.lines.push_back(std::move(lines));
}

void add_mesh(render::TriangleMesh mesh, scene::ColliderStyle style, render::Frame& frame) {
  mesh.is_holdout = style == scene::ColliderStyle::holdout;
  (hides(style) ? frame.meshes : frame.ghosts).push_back(std::move(mesh));
}

void add_sphere(const sim::shapes::Sphere& sphere, const sim::shapes::Pose& pose,
                scene::ColliderStyle style, render::Frame& frame) {
  const Vec3f center = to_float(pose.point);
  const auto radius = static_cast<float>(sphere.radius);
  if (style == scene::ColliderStyle::wire)
    return add_lines(render::shapes::sphere_lines(center, radius, to_rotation(pose.rotation)), 0.7f,
                     frame);
  add_mesh(render::shapes::sphere_mesh(center, radius), style, frame);
}

/// Flat faces have no rim: a ghost shows its edges instead.
void add_box(const sim::shapes::Box& box, const sim::shapes::Pose& pose, scene::ColliderStyle style,
             render::Frame& frame) {
  const Vec3f center = to_float(pose.point), size = to_float(box.size);
  const render::shapes::Rotation rotation = to_rotation(pose.rotation);
  if (style == scene::ColliderStyle::wire || style == scene::ColliderStyle::ghost)
    add_lines(render::shapes::box_lines(center, size, rotation),
              style == scene::ColliderStyle::wire ? 0.8f : 0.5f, frame);
  if (style == scene::ColliderStyle::wire) return;
  add_mesh(render::shapes::box_mesh(center, size, rotation), style, frame);
}

/// Adds any other form, placed: solid or ghost as triangles, otherwise as lines. Edges replace the
/// rim that a ghost lacks there.
void add_form(render::TriangleMesh mesh, render::Lines lines, scene::ColliderStyle style,
              bool has_rim, render::Frame& frame) {
  if (style == scene::ColliderStyle::wire) return add_lines(std::move(lines), 0.7f, frame);
  if (style == scene::ColliderStyle::ghost && !has_rim) add_lines(std::move(lines), 0.35f, frame);
  add_mesh(std::move(mesh), style, frame);
}

std::optional<render::shapes::Profile> profile_of(const sim::shapes::Shape& shape) {
  const auto real = [](double x) { return static_cast<float>(x); };
  if (const auto* s = std::get_if<sim::shapes::Capsule>(&shape.form))
    return render::shapes::capsule_profile(real(0.5 * (s->b - s->a).norm()), real(s->radius));
  if (const auto* s = std::get_if<sim::shapes::Cylinder>(&shape.form))
    return render::shapes::cylinder_profile(real(0.5 * s->height), real(s->radius));
  if (const auto* s = std::get_if<sim::shapes::Cone>(&shape.form))
    return render::shapes::cone_profile(real(0.5 * s->height), real(s->radius));
  if (const auto* s = std::get_if<sim::shapes::Torus>(&shape.form))
    return render::shapes::torus_profile(real(s->major_radius), real(s->minor_radius));
  return std::nullopt;
}

/// Drawing of a mesh, about the origin of its file.
struct MeshLook {
  render::TriangleMesh mesh;
  render::Lines lines;
};

std::shared_ptr<const MeshLook> make_look(const sim::shapes::SolidMesh& mesh) {
  std::vector<Vec3f> position;
  std::vector<std::uint32_t> index;
  for (const sim::Vec3d& x : mesh.vertices) position.push_back(to_float(x));
  for (const auto& t : mesh.triangles) index.insert(index.end(), t.begin(), t.end());
  return std::make_shared<const MeshLook>(MeshLook{render::shapes::creased_mesh(position, index),
                                                   render::shapes::mesh_lines(position, index)});
}

/// Returns the look of a mesh, which is made once for all frames.
std::shared_ptr<const MeshLook> look_of(const sim::shapes::Mesh& mesh) {
  static sim::shapes::Recent<MeshLook> recent;
  return recent.get(sim::shapes::reading_key(mesh),
                    [&] { return make_look(sim::shapes::mesh_surface(mesh)->mesh()); });
}

constexpr Vec3f terrain_color{0.24f, 0.245f, 0.26f};

/// Drawn at most along each side; of larger terrain, all around the snow and fewer away from it.
constexpr std::size_t max_drawn_posts = 257;
/// Lines of a wire along each side.
constexpr std::size_t max_wires = 48;

/// A stretch of the posts of a terrain along x and z.
struct Stretch {
  Eigen::Vector2d low, high;
};

render::Lines terrain_lines(const sim::shapes::HeightField& field,
                            const std::vector<std::size_t>& columns,
                            const std::vector<std::size_t>& rows) {
  render::Lines lines;
  const auto place = [&](std::size_t c, std::size_t r) {
    return sim::Vec3d(field.x_of(c), field.height_of(c, r), field.z_of(r));
  };
  const auto add = [&](const sim::Vec3d& a, const sim::Vec3d& b) {
    if (!a.allFinite() || !b.allFinite()) return;
    lines.ends.push_back(to_float(a));
    lines.ends.push_back(to_float(b));
  };
  const std::size_t over_rows = rows.size() / max_wires + 1,
                    over_columns = columns.size() / max_wires + 1;
  for (std::size_t r = 0; r < rows.size(); r += over_rows)
    for (std::size_t c = 0; c + 1 < columns.size(); ++c)
      add(place(columns[c], rows[r]), place(columns[c + 1], rows[r]));
  for (std::size_t c = 0; c < columns.size(); c += over_columns)
    for (std::size_t r = 0; r + 1 < rows.size(); ++r)
      add(place(columns[c], rows[r]), place(columns[c], rows[r + 1]));
  return lines;
}

std::shared_ptr<const MeshLook> make_look(const sim::shapes::HeightField& field,
                                          const Stretch& stretch) {
  const auto posts = [&](std::size_t count, int axis) {
    return sim::shapes::drawn_posts(count, stretch.low[axis], stretch.high[axis], max_drawn_posts);
  };
  const std::vector<std::size_t> columns = posts(field.grid().columns, 0),
                                 rows = posts(field.grid().rows, 1);
  const sim::shapes::HeightTriangles triangles = sim::shapes::triangles_of(field, columns, rows);
  MeshLook look;
  std::vector<Vec3f> position, normal;
  for (const sim::Vec3d& x : triangles.position) position.push_back(to_float(x));
  for (const sim::Vec3d& n : triangles.normal) normal.push_back(to_float(n));
  look.mesh.position = std::move(position);
  look.mesh.normal = std::move(normal);
  look.mesh.index = triangles.index;
  look.mesh.color = terrain_color;
  look.lines = terrain_lines(field, columns, rows);
  return std::make_shared<const MeshLook>(std::move(look));
}

/// Returns the look of a terrain, which is made once for all frames.
/// @param snow  about the terrain's origin; empty: the whole terrain matters
std::shared_ptr<const MeshLook> look_of(const sim::shapes::Terrain& terrain,
                                        const Eigen::AlignedBox3d& snow) {
  static sim::shapes::Recent<MeshLook> recent(sim::shapes::Made::each_moment);
  const std::shared_ptr<const sim::shapes::HeightField> field = sim::shapes::height_field(terrain);
  const sim::shapes::Bounds& all = field->bounds();
  const auto post = [&](const sim::Vec3d& x) -> Eigen::Vector2d {
    return Eigen::Vector2d(x.x() - all.min.x(), x.z() - all.min.z()) / field->grid().spacing;
  };
  // Snow moves about its own size away in most scenes.
  const sim::Vec3d margin = snow.isEmpty() ? sim::Vec3d(0, 0, 0) : snow.sizes();
  const Stretch stretch{post(snow.isEmpty() ? all.min : sim::Vec3d(snow.min() - margin)),
                        post(snow.isEmpty() ? all.max : sim::Vec3d(snow.max() + margin))};
  const bool is_large = std::max(field->grid().columns, field->grid().rows) > max_drawn_posts;
  std::string key = fmt::format("{}|{}|{}|{}|{}|{}|{}", sim::shapes::file_stamp(terrain.file),
                                terrain.spacing, terrain.low, terrain.high, terrain.origin.x(),
                                terrain.origin.y(), terrain.origin.z());
  if (is_large)
    key += fmt::format("|{}|{}|{}|{}", stretch.low.x(), stretch.low.y(), stretch.high.x(),
                       stretch.high.y());
  return recent.get(key, [&] { return make_look(*field, stretch); });
}

/// The snow at the start, in the axes of a terrain about its point.
Eigen::AlignedBox3d snow_on(const scene::Scene& scene, const sim::shapes::Pose& pose) {
  Eigen::AlignedBox3d snow;
  const auto add = [&](const sim::shapes::Shape& shape) {
    const sim::shapes::Bounds box = sim::shapes::bounds(shape);
    for (int k = 0; k < 8; ++k) {
      const sim::Vec3d corner(k & 1 ? box.max.x() : box.min.x(), k & 2 ? box.max.y() : box.min.y(),
                              k & 4 ? box.max.z() : box.min.z());
      snow.extend(sim::Vec3d(pose.rotation.transpose() * (corner - pose.point)));
    }
  };
  for (const auto& body : scene.bodies) add(body.shape);
  for (const auto& emitter : scene.emitters) add(emitter.shape);
  return snow;
}

void add_terrain(const scene::Scene& scene, const sim::shapes::Terrain& terrain,
                 const sim::shapes::Pose& pose, scene::ColliderStyle style, render::Frame& frame) {
  const sim::shapes::Pose start{sim::shapes::center({terrain, {}}), pose.rotation, {}, {}};
  const std::shared_ptr<const MeshLook> look = look_of(terrain, snow_on(scene, start));
  const Vec3f center = to_float(pose.point);
  const render::shapes::Rotation rotation = to_rotation(pose.rotation);
  add_form(render::shapes::moved_mesh(look->mesh, center, rotation),
           render::shapes::moved_lines(look->lines, center, rotation), style, false, frame);
}

/// @param time  s, see sim::shapes::shape_time
std::shared_ptr<const MeshLook> look_of(const sim::shapes::Shape& shape, double time) {
  if (const auto* terrain = std::get_if<sim::shapes::Terrain>(&shape.form))
    return look_of(*terrain, Eigen::AlignedBox3d());
  if (const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&shape.form))
    return make_look(sim::shapes::deforming_mesh(*sequence)->mesh_at(time));
  return look_of(std::get<sim::shapes::Mesh>(shape.form));
}

/// @param time  s, see sim::shapes::shape_time
void add_other(const sim::shapes::Shape& shape, const sim::shapes::Pose& pose, double time,
               scene::ColliderStyle style, render::Frame& frame) {
  const Vec3f center = to_float(pose.point);
  const render::shapes::Rotation rotation =
      to_rotation(pose.rotation * sim::shapes::form_axes(shape));
  if (const std::optional<render::shapes::Profile> profile = profile_of(shape)) {
    const bool has_rim = std::holds_alternative<sim::shapes::Capsule>(shape.form) ||
                         std::holds_alternative<sim::shapes::Torus>(shape.form);
    return add_form(render::shapes::round_mesh(*profile, center, rotation),
                    render::shapes::round_lines(*profile, center, rotation,
                                                style == scene::ColliderStyle::ghost),
                    style, has_rim, frame);
  }
  const std::shared_ptr<const MeshLook> look = look_of(shape, time);
  add_form(render::shapes::moved_mesh(look->mesh, center, rotation),
           render::shapes::moved_lines(look->lines, center, rotation), style, false, frame);
}

}  // namespace

render::TriangleMesh local_mesh(const sim::shapes::Shape& shape) {
  const render::shapes::Rotation axes = to_rotation(sim::shapes::form_axes(shape));
  if (const auto* sphere = std::get_if<sim::shapes::Sphere>(&shape.form))
    return render::shapes::sphere_mesh({0, 0, 0}, static_cast<float>(sphere->radius));
  if (const auto* box = std::get_if<sim::shapes::Box>(&shape.form))
    return render::shapes::box_mesh({0, 0, 0}, to_float(box->size), axes);
  if (const std::optional<render::shapes::Profile> profile = profile_of(shape))
    return render::shapes::round_mesh(*profile, {0, 0, 0}, axes);
  const std::shared_ptr<const MeshLook> look = look_of(shape, 0);
  return render::shapes::moved_mesh(look->mesh, {0, 0, 0}, axes);
}

scene::Layer layer_of(const scene::Collider& collider) {
  const bool is_ground = std::holds_alternative<sim::shapes::Plane>(collider.shape.form) ||
                         std::holds_alternative<sim::shapes::Terrain>(collider.shape.form);
  return is_ground ? scene::Layer::ground : scene::Layer::colliders;
}

bool hides(scene::ColliderStyle style) {
  return style == scene::ColliderStyle::solid || style == scene::ColliderStyle::holdout;
}

void add_colliders(const scene::Scene& scene, const scene::View& view, double time,
                   float line_spacing, render::Frame& frame) {
  for (const scene::Collider& collider : scene.colliders) {
    const sim::shapes::Pose pose = sim::shapes::pose_at(collider, time);
    if (!scene::has_layer(view, layer_of(collider))) continue;
    if (const auto* plane = std::get_if<sim::shapes::Plane>(&collider.shape.form))
      add_plane(*plane, pose, collider.style, line_spacing, frame);
    else if (const auto* terrain = std::get_if<sim::shapes::Terrain>(&collider.shape.form))
      add_terrain(scene, *terrain, pose, collider.style, frame);
    else if (const auto* sphere = std::get_if<sim::shapes::Sphere>(&collider.shape.form))
      add_sphere(*sphere, pose, collider.style, frame);
    else if (const auto* box = std::get_if<sim::shapes::Box>(&collider.shape.form))
      add_box(*box, pose, collider.style, frame);
    else
      add_other(collider.shape, pose, sim::shapes::shape_time(collider, time), collider.style,
                frame);
  }
}

namespace {

class OpenEdges {
 public:
  void add(const sim::shapes::Shape& shape, const std::string& name) {
    const auto* mesh = std::get_if<sim::shapes::Mesh>(&shape.form);
    if (!mesh) return;
    const auto solid = sim::shapes::read_solid_mesh(*mesh);
    if (solid->open_edges.empty()) return;
    const sim::Mat3d turn = sim::rotation_from_degrees(shape.rotation);
    for (const auto& edge : solid->open_edges)
      for (const std::uint32_t corner : edge)
        lines_.ends.push_back(to_float(mesh->center + turn * solid->vertices[corner]));
    const sim::shapes::Bounds box = bounds_of(*solid, turn);
    bounds_.extend(mesh->center + box.min);
    bounds_.extend(mesh->center + box.max);
    frame_.ghosts.push_back(
        render::shapes::moved_mesh(local_mesh(shape), to_float(mesh->center), to_rotation(turn)));
    frame_.caption.push_back(fmt::format("{}: {} open {}", name, solid->open_edges.size(),
                                         solid->open_edges.size() == 1 ? "edge" : "edges"));
  }

  std::optional<render::Frame> finish(scene::PictureSize size) {
    if (lines_.ends.empty()) return {};
    lines_.color = {0.95f, 0.15f, 0.1f};
    lines_.width = 3;
    frame_.lines.push_back(lines_);
    frame_.width = size.width;
    frame_.height = size.height;
    // The smaller angle of the picture holds all of it, with a little around it.
    const double tangent = std::tan(frame_.camera.fov / 2 * std::numbers::pi / 180) *
                           std::min(1.0, static_cast<double>(size.width) / size.height);
    const sim::Vec3d middle = bounds_.center();
    const double away = 1.1 * 0.5 * bounds_.diagonal().norm() / std::sin(std::atan(tangent));
    frame_.camera.target = to_float(middle);
    frame_.camera.eye = to_float(middle + away * sim::Vec3d(0.6, 0.45, 1).normalized());
    return std::move(frame_);
  }

 private:
  render::Frame frame_;
  render::Lines lines_;
  Eigen::AlignedBox3d bounds_;
};

}  // namespace

std::optional<render::Frame> open_edges_frame(const scene::Scene& scene) {
  OpenEdges edges;
  for (const auto& body : scene.bodies) edges.add(body.shape, body.name);
  for (const auto& emitter : scene.emitters) edges.add(emitter.shape, emitter.name);
  for (const auto& sink : scene.sinks) edges.add(sink.shape, sink.name);
  for (const auto& collider : scene.colliders) edges.add(collider.shape, collider.name);
  return edges.finish(scene.size);
}

}  // namespace neve::app::picture
