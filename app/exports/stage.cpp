#include "app/exports/stage.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "app/exports/stage_camera.h"
#include "app/exports/stage_path.h"
#include "app/exports/usda.h"
#include "app/picture/collider_looks.h"
#include "sim/shapes/deforming_mesh.h"

namespace neve::app::exports {

namespace {

using sim::Mat3d;
using sim::Vec3d;

/// Half the side of the square that stands for a plane, m.
constexpr double half_plane = 5;

/// A pose as USD has it: rows, so that a row vector is turned and moved.
std::string usd_matrix(const Mat3d& rotation, const Vec3d& place) {
  std::string text = "( ";
  for (int r = 0; r < 4; ++r) {
    text += "(";
    for (int c = 0; c < 3; ++c) text += usd_number(r < 3 ? rotation(c, r) : place[c]) + ", ";
    text += r < 3 ? "0), " : "1) )";
  }
  return text;
}

/// Corners and triangles of a collider about its point, in the axes of the simulation.
struct ColliderMesh {
  std::vector<Vec3d> points;
  std::vector<std::uint32_t> corners;  ///< three a triangle
};

/// Gives a mesh that deforms triangles without points: these move.
ColliderMesh collider_mesh(const sim::shapes::Shape& shape) {
  ColliderMesh surface;
  if (const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&shape.form)) {
    for (const auto& t : sim::shapes::deforming_mesh(*sequence)->mesh(0, 0).triangles)
      surface.corners.insert(surface.corners.end(), t.begin(), t.end());
    return surface;
  }
  if (const auto* plane = std::get_if<sim::shapes::Plane>(&shape.form)) {
    const Vec3d up = plane->normal.normalized();
    const Vec3d across = up.unitOrthogonal(), along = up.cross(across);
    for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      surface.points.push_back(half_plane * (a * across + b * along));
    surface.corners = {0, 1, 2, 0, 2, 3};
    return surface;
  }
  const render::TriangleMesh mesh = picture::local_mesh(shape);
  for (const Vec3f& p : mesh.position) surface.points.emplace_back(p.x, p.y, p.z);
  surface.corners = mesh.index;
  return surface;
}

std::string usd_points(const Axes& axes, const std::vector<Vec3d>& places) {
  std::string points = "[";
  for (std::size_t k = 0; k < places.size(); ++k)
    points += (k > 0 ? ", " : "") + usd_tuple(axes.scale() * places[k]);
  return points + "]";
}

using Values = std::vector<std::pair<double, std::string>>;

/// The points of a collider, at every sample where it deforms.
std::string usd_point_property(const scene::Scene& scene, const Axes& axes,
                               const scene::Collider& collider, const ColliderMesh& surface,
                               const std::vector<Sample>& samples) {
  const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&collider.shape.form);
  const std::string declared = "            point3f[] points";
  if (!sequence) return declared + " = " + usd_points(axes, surface.points) + "\n";
  const auto mesh = sim::shapes::deforming_mesh(*sequence);
  Values values;
  for (const Sample& sample : samples) {
    const PlacedShape* placed = sample.find(collider.name);
    values.emplace_back(sample.time,
                        usd_points(axes, mesh->mesh_at(placed ? placed->time : 0).vertices));
  }
  return usd_property(scene, declared, values);
}

/// Empty for a collider that there is at every sample.
std::string usd_visibility(const scene::Scene& scene, const std::string& collider,
                           const std::vector<Sample>& samples) {
  if (std::all_of(samples.begin(), samples.end(),
                  [&](const Sample& sample) { return sample.find(collider) != nullptr; }))
    return {};
  Values values;
  for (const Sample& sample : samples)
    values.emplace_back(sample.time, sample.find(collider) ? "\"inherited\"" : "\"invisible\"");
  return usd_property(scene, "            token visibility", values);
}

std::string usd_collider(const scene::Scene& scene, const Axes& axes,
                         const scene::Collider& collider, const ColliderMesh& surface,
                         const std::string& name, const std::vector<Sample>& samples) {
  const std::vector<std::uint32_t> counts(surface.corners.size() / 3, 3);
  return "        def Mesh \"" + name + "\"\n        {\n" +
         "            uniform token subdivisionScheme = \"none\"\n" +
         "            int[] faceVertexCounts = " + fmt::format("[{}]", fmt::join(counts, ", ")) +
         "\n" + "            int[] faceVertexIndices = " +
         fmt::format("[{}]", fmt::join(surface.corners, ", ")) + "\n" +
         usd_point_property(scene, axes, collider, surface, samples) +
         usd_visibility(scene, collider.name, samples) +
         usd_placed(scene, axes, collider_path(scene, collider.name, samples)) + "        }\n";
}

/// The box of a deforming mesh has all its shapes.
SeenCollider seen_collider(const scene::Collider& collider, const ColliderMesh& surface,
                           const std::vector<Sample>& samples) {
  SeenCollider seen{collider.name, setup::box_of(surface.points)};
  if (const auto* plane = std::get_if<sim::shapes::Plane>(&collider.shape.form))
    seen.normal = plane->normal.normalized();
  if (const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&collider.shape.form)) {
    const auto mesh = sim::shapes::deforming_mesh(*sequence);
    for (const Sample& sample : samples)
      if (const PlacedShape* placed = sample.find(collider.name))
        for (const Vec3d& x : mesh->mesh_at(placed->time).vertices) seen.box.add(x);
  }
  return seen;
}

/// @param seen  gets what a camera may see of them
std::string usd_colliders(const scene::Scene& scene, const std::vector<scene::Collider>& colliders,
                          const Axes& axes, const std::vector<Sample>& samples,
                          std::vector<SeenCollider>& seen) {
  std::string text = "    def Xform \"colliders\"\n    {\n";
  std::set<std::string> names;
  for (const scene::Collider& collider : colliders) {
    const bool is_seen = std::any_of(samples.begin(), samples.end(), [&](const Sample& sample) {
      return sample.find(collider.name) != nullptr;
    });
    if (!is_seen) continue;
    std::string name = usd_name(collider.name);
    while (!names.insert(name).second) name += "_";
    const ColliderMesh surface = collider_mesh(collider.shape);
    seen.push_back(seen_collider(collider, surface, samples));
    text += usd_collider(scene, axes, collider, surface, name, samples);
  }
  return text + "    }\n";
}

std::string usd_light(const scene::Scene& scene, const Axes& axes) {
  const Vec3d towards = scene.light.direction.normalized();
  const Mat3d rotation = looking(-towards, towards.unitOrthogonal());
  return "    def DistantLight \"sun\"\n    {\n        float inputs:intensity = " +
         usd_number(scene.light.intensity) + "\n        matrix4d xformOp:transform = " +
         usd_matrix(axes.turned(rotation), Vec3d::Zero()) +
         "\n        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n    }\n";
}

std::string usd_clips(const scene::Scene& scene, const scene::Export& spec, const std::string& prim,
                      const std::vector<Sample>& samples) {
  const std::string folder = "./" + scene::folder_of(spec) + "/";
  std::string paths, active, times;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const std::string between = k > 0 ? ", " : "",
                      time = usd_number(stage_time(scene, samples[k].time));
    paths += between + "@" + folder + file_name(spec, samples[k].number) + "@";
    active += between + "(" + time + ", " + std::to_string(k) + ")";
    times += between + "(" + time + ", " + time + ")";
  }
  return "        clips = {\n            dictionary default = {\n                asset[] "
         "assetPaths = [" +
         paths + "]\n                double2[] active = [" + active +
         "]\n                double2[] times = [" + times +
         "]\n                asset manifestAssetPath = @" + folder +
         "manifest.usda@\n                string primPath = \"/neve/" + prim +
         "\"\n            }\n        }\n";
}

}  // namespace

std::string encode_stage(const scene::Scene& scene, const std::vector<scene::Collider>& colliders,
                         const scene::Export& spec, const Table& columns,
                         const std::vector<Sample>& files, const std::vector<Sample>& between) {
  const Axes axes(spec);
  const double first = files.empty() ? 0 : stage_time(scene, files.front().time);
  const double last = files.empty() ? 0 : stage_time(scene, files.back().time);
  const std::vector<Sample> samples = stage_samples(scene, files, between);
  std::string snow;
  for (const auto& [prim, name] : usd_prims(spec)) {
    const std::string indent(8, ' ');
    snow += "    def " + std::string(usd_type(prim)) + " \"" + name + "\" (\n" +
            usd_clips(scene, spec, name, files) + "    )\n    {\n" + usd_fixed(prim, indent) +
            usd_declarations(columns, prim, indent) + "    }\n";
  }
  std::vector<SeenCollider> seen;
  const std::string obstacles = usd_colliders(scene, colliders, axes, samples, seen);
  return usd_header(scene, spec, first, last) + "def Xform \"neve\"\n{\n" + usd_world(scene, spec) +
         snow + obstacles + usd_camera(scene, axes, samples, seen) + usd_light(scene, axes) + "}\n";
}

std::string encode_manifest(const scene::Scene& scene, const scene::Export& spec,
                            const Table& columns) {
  std::string snow;
  for (const auto& [prim, name] : usd_prims(spec))
    snow += "    over \"" + name + "\"\n    {\n" +
            usd_declarations(columns, prim, std::string(8, ' ')) + "    }\n";
  return usd_header(scene, spec, 0, 0) + "over \"neve\"\n{\n" + snow + "}\n";
}

}  // namespace neve::app::exports
