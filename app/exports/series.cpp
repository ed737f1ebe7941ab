#include "app/exports/series.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include "app/exports/usda.h"
#include "app/picture/collider_looks.h"
#include "app/scene/names.h"
#include "app/setup/camera_path.h"
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

std::string joined_numbers(const std::vector<std::uint32_t>& numbers) {
  std::string text = "[";
  for (std::size_t k = 0; k < numbers.size(); ++k)
    text += (k > 0 ? ", " : "") + std::to_string(numbers[k]);
  return text + "]";
}

/// Frames, with the numbers that files have.
double stage_time(const scene::Scene& scene, const Sample& sample) {
  return sample.time * scene.fps + scene::number_of(scene, 0);
}

std::string stage_times(const scene::Scene& scene, const std::vector<Sample>& samples,
                        const auto& value) {
  std::string text;
  for (const Sample& sample : samples)
    text +=
        "                " + usd_number(stage_time(scene, sample)) + ": " + value(sample) + ",\n";
  return text;
}

std::string transform_samples(const scene::Scene& scene, const std::vector<Sample>& samples,
                              const auto& matrix) {
  return "            matrix4d xformOp:transform.timeSamples = {\n" +
         stage_times(scene, samples, matrix) +
         "            }\n            uniform token[] xformOpOrder = [\"xformOp:transform\"]\n";
}

std::string usd_points(const Axes& axes, const std::vector<Vec3d>& places) {
  std::string points = "[";
  for (std::size_t k = 0; k < places.size(); ++k)
    points += (k > 0 ? ", " : "") + usd_tuple(axes.scale() * places[k]);
  return points + "]";
}

/// The points of a collider, at every sample where it deforms.
std::string usd_point_property(const scene::Scene& scene, const Axes& axes,
                               const scene::Collider& collider, const ColliderMesh& surface,
                               const std::vector<Sample>& samples) {
  const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&collider.shape.form);
  const std::string declared = "            point3f[] points";
  if (!sequence) return declared + " = " + usd_points(axes, surface.points) + "\n";
  const auto mesh = sim::shapes::deforming_mesh(*sequence);
  return declared + ".timeSamples = {\n" +
         stage_times(scene, samples,
                     [&](const Sample& sample) {
                       const PlacedShape* placed = sample.find(collider.name);
                       return usd_points(axes, mesh->mesh_at(placed ? placed->time : 0).vertices);
                     }) +
         "            }\n";
}

/// Empty for a collider that there is at every sample.
std::string usd_visibility(const scene::Scene& scene, const std::string& collider,
                           const std::vector<Sample>& samples) {
  if (std::all_of(samples.begin(), samples.end(),
                  [&](const Sample& sample) { return sample.find(collider) != nullptr; }))
    return {};
  return "            token visibility.timeSamples = {\n" +
         stage_times(
             scene, samples,
             [&](const Sample& sample) {
               return std::string(sample.find(collider) ? "\"inherited\"" : "\"invisible\"");
             }) +
         "            }\n";
}

/// @param samples  at least one of them has it
std::string usd_transform(const scene::Scene& scene, const Axes& axes, const std::string& collider,
                          const std::vector<Sample>& samples) {
  // Before and after its time it is where it is first and last.
  const PlacedShape* placed = nullptr;
  for (auto sample = samples.begin(); sample != samples.end() && !placed; ++sample)
    placed = sample->find(collider);
  return transform_samples(scene, samples, [&](const Sample& sample) {
    if (const PlacedShape* now = sample.find(collider)) placed = now;
    return usd_matrix(axes.turned(placed->pose.rotation), axes.scaled(placed->pose.point));
  });
}

std::string usd_collider(const scene::Scene& scene, const Axes& axes,
                         const scene::Collider& collider, const std::string& name,
                         const std::vector<Sample>& samples) {
  const ColliderMesh surface = collider_mesh(collider.shape);
  const std::vector<std::uint32_t> counts(surface.corners.size() / 3, 3);
  return "        def Mesh \"" + name + "\"\n        {\n" +
         "            uniform token subdivisionScheme = \"none\"\n" +
         "            int[] faceVertexCounts = " + joined_numbers(counts) + "\n" +
         "            int[] faceVertexIndices = " + joined_numbers(surface.corners) + "\n" +
         usd_point_property(scene, axes, collider, surface, samples) +
         usd_visibility(scene, collider.name, samples) +
         usd_transform(scene, axes, collider.name, samples) + "        }\n";
}

std::string usd_colliders(const scene::Scene& scene, const std::vector<scene::Collider>& colliders,
                          const Axes& axes, const std::vector<Sample>& samples) {
  std::string text = "    def Xform \"colliders\"\n    {\n";
  std::set<std::string> names;
  for (const scene::Collider& collider : colliders) {
    const bool is_seen = std::any_of(samples.begin(), samples.end(), [&](const Sample& sample) {
      return sample.find(collider.name) != nullptr;
    });
    if (!is_seen) continue;
    std::string name = usd_name(collider.name);
    while (!names.insert(name).second) name += "_";
    text += usd_collider(scene, axes, collider, name, samples);
  }
  return text + "    }\n";
}

/// A frame whose third axis points away from where one looks.
Mat3d looking(const Vec3d& forward, const Vec3d& up) {
  Mat3d rotation;
  rotation.col(2) = -forward.normalized();
  rotation.col(0) = up.cross(rotation.col(2)).normalized();
  rotation.col(1) = rotation.col(2).cross(rotation.col(0));
  return rotation;
}

/// Empty if the camera has no place yet.
std::string usd_camera(const scene::Scene& scene, const Axes& axes,
                       const std::vector<Sample>& samples) {
  if (!scene.camera || !scene.camera->eye || !scene.camera->target) return {};
  constexpr double height = 24;  // tenths of a unit, as film has millimetres
  const double width = height * scene.size.width / scene.size.height;
  const auto place_at = [&](const Sample& sample) {
    setup::CameraPlace place = setup::camera_at(*scene.camera, sample.time, scene::duration(scene));
    const Vec3d moved = sample.followed.value_or(Vec3d::Zero());
    place.eye += moved;
    place.target += moved;
    return place;
  };
  const auto focal_length = [&](const Sample& sample) {
    const double half = 0.5 * place_at(sample).fov * std::numbers::pi / 180;
    return usd_number(0.5 * height / std::tan(half));
  };
  const auto matrix = [&](const Sample& sample) {
    const setup::CameraPlace place = place_at(sample);
    const Mat3d rotation = looking(place.target - place.eye, scene.camera->up);
    return usd_matrix(axes.turned(rotation), axes.scaled(place.eye));
  };
  return "    def Xform \"view\"\n    {\n        def Camera \"camera\"\n        {\n" +
         std::string("            float horizontalAperture = ") + usd_number(width) +
         "\n            float verticalAperture = " + usd_number(height) +
         "\n            float focalLength.timeSamples = {\n" +
         stage_times(scene, samples, focal_length) + "            }\n" +
         transform_samples(scene, samples, matrix) + "        }\n    }\n";
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
    const std::string between = k > 0 ? ", " : "", time = usd_number(stage_time(scene, samples[k]));
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

const PlacedShape* Sample::find(const std::string& collider) const {
  const auto found =
      std::find_if(colliders.begin(), colliders.end(),
                   [&](const PlacedShape& placed) { return placed.collider == collider; });
  return found == colliders.end() ? nullptr : &*found;
}

std::string file_name(const scene::Export& spec, int number) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%04d.", number);
  return digits + std::string(scene::name(spec.format));
}

std::string series_name(const scene::Export& spec) {
  switch (spec.format) {
    case scene::ExportFormat::vtp:
    case scene::ExportFormat::vti:
      return scene::folder_of(spec) + ".pvd";
    case scene::ExportFormat::usda:
      return scene::folder_of(spec) + ".usda";
    default:
      return {};
  }
}

std::string encode_pvd(const scene::Export& spec, const std::vector<Sample>& samples) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const Sample& sample : samples) {
    text += "<DataSet timestep=\"";
    append_text(sample.time, text);
    text += "\" part=\"0\" file=\"" + scene::folder_of(spec) + "/" +
            file_name(spec, sample.number) + "\"/>\n";
  }
  return text + "</Collection>\n</VTKFile>\n";
}

std::string encode_stage(const scene::Scene& scene, const std::vector<scene::Collider>& colliders,
                         const scene::Export& spec, const Table& columns,
                         const std::vector<Sample>& samples) {
  const Axes axes(spec);
  const double first = samples.empty() ? 0 : stage_time(scene, samples.front());
  const double last = samples.empty() ? 0 : stage_time(scene, samples.back());
  std::string snow;
  for (const auto& [prim, name] : usd_prims(spec)) {
    const std::string indent(8, ' ');
    snow += "    def " + std::string(usd_type(prim)) + " \"" + name + "\" (\n" +
            usd_clips(scene, spec, name, samples) + "    )\n    {\n" + usd_fixed(prim, indent) +
            usd_declarations(columns, prim, indent) + "    }\n";
  }
  return usd_header(scene, spec, first, last) + "def Xform \"neve\"\n{\n" + usd_world(scene, spec) +
         snow + usd_colliders(scene, colliders, axes, samples) + usd_camera(scene, axes, samples) +
         usd_light(scene, axes) + "}\n";
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
