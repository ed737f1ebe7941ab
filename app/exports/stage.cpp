#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "app/exports/series.h"
#include "app/exports/stage_path.h"
#include "app/exports/usda.h"
#include "app/picture/collider_looks.h"
#include "app/setup/camera_path.h"
#include "app/setup/plan.h"
#include "sim/shapes/deforming_mesh.h"

namespace neve::app::exports {

namespace {

using sim::Mat3d;
using sim::Vec3d;

/// The part of a collider that a camera may see: a box about its point and in its axes. For a plane
/// it holds the square that a stage has.
struct SeenCollider {
  std::string name;
  std::size_t shape;  ///< of those that it has had
  setup::Box box;
  std::optional<sim::Vec3d> normal{};  ///< of a plane
};

constexpr double height = 24;  // tenths of a unit, as film has millimetres

/// Returns how far a camera has moved with the thing it follows, linear between samples.
Vec3d followed_at(const std::vector<Sample>& samples, const std::string& name, double time) {
  const auto next = std::ranges::upper_bound(samples, time, {}, &Sample::time);
  const Sample& after = next == samples.end() ? samples.back() : *next;
  const Sample& before = next == samples.begin() ? after : *(next - 1);
  const auto moved = [&](const Sample& sample) {
    const auto found = sample.followed.find(name);
    return found == sample.followed.end() ? Vec3d(Vec3d::Zero()) : found->second;
  };
  const Vec3d a = moved(before), b = moved(after);
  const double seconds = after.time - before.time;
  return seconds > 0 ? Vec3d(a + (time - before.time) / seconds * (b - a)) : a;
}

setup::CameraPlace camera_at(const scene::Scene& scene, const scene::CameraSettings& camera,
                             const std::vector<Sample>& samples, double time) {
  setup::CameraPlace place = setup::camera_at(camera, time, scene::duration(scene));
  const Vec3d moved = followed_at(samples, camera.follow, time);
  place.eye += moved;
  place.target += moved;
  return place;
}

/// Nearest and farthest that a camera sees, m.
struct Range {
  double nearest = 1e300, farthest = 0;
  /// @param eye  in the axes of the box
  void add(const setup::Box& box, const Vec3d& eye) {
    const Vec3d inside = eye.cwiseMax(box.min).cwiseMin(box.max);
    nearest = std::min(nearest, (inside - eye).norm());
    add_farthest(box, eye);
  }
  void add_farthest(const setup::Box& box, const Vec3d& eye) {
    const Vec3d far = (eye - box.min).cwiseAbs().cwiseMax((eye - box.max).cwiseAbs());
    farthest = std::max(farthest, far.norm());
  }
};

/// Distances along the axis of view: less than those from the eye by what the corners of the
/// picture are aside.
std::string usd_clipping_range(const scene::Scene& scene, const StageCamera& of, const Axes& axes,
                               const std::vector<Sample>& samples,
                               const std::vector<SeenCollider>& colliders) {
  const double aspect = 1.0 * of.size.width / of.size.height;
  Range seen;
  double widest = 0;
  for (const Sample& sample : samples) {
    const setup::CameraPlace camera = camera_at(scene, of.settings, samples, sample.time);
    widest = std::max(widest, camera.fov);
    if (sample.snow) seen.add(*sample.snow, camera.eye);
    for (const SeenCollider& collider : colliders) {
      const PlacedShape* placed = sample.find(collider.name, collider.shape);
      if (!placed) continue;
      const Mat3d& rotation = placed->pose.rotation;
      const Vec3d eye = rotation.transpose() * (camera.eye - placed->pose.point);
      if (collider.normal) {
        seen.nearest = std::min(seen.nearest, std::abs(collider.normal->dot(eye)));
        seen.add_farthest(collider.box, eye);
      } else {
        seen.add(collider.box, eye);
      }
    }
  }
  if (!(seen.farthest > 0)) return {};
  const double slope = std::tan(0.5 * widest * std::numbers::pi / 180);
  const double corner = 1 / std::sqrt(1 + slope * slope * (1 + aspect * aspect));
  // Half of the way to the nearest and half as far again: things move between frames. Depths of
  // one picture are of no use where they span more than five orders.
  const double far = 1.5 * seen.farthest, near = std::max(0.5 * corner * seen.nearest, 1e-5 * far);
  return "            float2 clippingRange = (" +
         usd_number(static_cast<float>(axes.scale() * near)) + ", " +
         usd_number(static_cast<float>(axes.scale() * far)) + ")\n";
}

/// A frame whose third axis points away from where one looks.
Mat3d looking(const Vec3d& forward, const Vec3d& up) {
  Mat3d rotation;
  rotation.col(2) = -forward.normalized();
  rotation.col(0) = up.cross(rotation.col(2)).normalized();
  rotation.col(1) = rotation.col(2).cross(rotation.col(0));
  return rotation;
}

/// Writes a camera. The clipping range has the snow and the colliders of all samples, with room for
/// what is between: USD's own starts at 1 unit, farther than a small scene.
std::string usd_camera(const scene::Scene& scene, const StageCamera& camera, const Axes& axes,
                       const std::vector<Sample>& samples,
                       const std::vector<SeenCollider>& colliders) {
  const double width = height * camera.size.width / camera.size.height;
  std::vector<std::pair<double, std::string>> focal_lengths;
  for (const Sample& sample : samples) {
    const double half =
        0.5 * camera_at(scene, camera.settings, samples, sample.time).fov * std::numbers::pi / 180;
    focal_lengths.emplace_back(sample.time, usd_number(0.5 * height / std::tan(half)));
  }
  const auto place_at = [&](double time) {
    const setup::CameraPlace place = camera_at(scene, camera.settings, samples, time);
    return Place{time, looking(place.target - place.eye, camera.settings.up), place.eye};
  };
  return "        def Camera \"" + camera.name + "\"\n        {\n" +
         std::string("            float horizontalAperture = ") + usd_number(width) +
         "\n            float verticalAperture = " + usd_number(height) + "\n" +
         usd_clipping_range(scene, camera, axes, samples, colliders) +
         usd_property(scene, "            float focalLength", focal_lengths) +
         usd_placed(scene, axes, path_of(samples, place_at)) + "        }\n";
}

/// Writes the cameras; "" if none has a place yet.
std::string usd_cameras(const scene::Scene& scene, const Axes& axes,
                        const std::vector<Sample>& samples,
                        const std::vector<SeenCollider>& colliders) {
  const std::vector<StageCamera> cameras = stage_cameras(scene);
  if (cameras.empty() || samples.empty()) return {};
  std::string text = "    def Xform \"view\"\n    {\n";
  for (const StageCamera& camera : cameras)
    text += usd_camera(scene, camera, axes, samples, colliders);
  return text + "    }\n";
}

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

/// Writes the visibility of a shape; "" for a collider that has it at every sample.
std::string usd_visibility(const scene::Scene& scene, const std::string& collider,
                           std::size_t shape, const std::vector<Sample>& samples) {
  const auto is_there = [&](const Sample& s) { return s.find(collider, shape) != nullptr; };
  if (std::ranges::all_of(samples, is_there)) return {};
  Values values;
  for (const Sample& sample : samples)
    values.emplace_back(sample.time, is_there(sample) ? "\"inherited\"" : "\"invisible\"");
  return usd_property(scene, "            token visibility", values);
}

std::string usd_collider(const scene::Scene& scene, const Axes& axes,
                         const scene::Collider& collider, std::size_t shape,
                         const ColliderMesh& surface, const std::string& name,
                         const std::vector<Sample>& samples) {
  const std::vector<std::uint32_t> counts(surface.corners.size() / 3, 3);
  return "        def Mesh \"" + name + "\"\n        {\n" +
         "            uniform token subdivisionScheme = \"none\"\n" +
         "            int[] faceVertexCounts = " + fmt::format("[{}]", fmt::join(counts, ", ")) +
         "\n" + "            int[] faceVertexIndices = " +
         fmt::format("[{}]", fmt::join(surface.corners, ", ")) + "\n" +
         usd_point_property(scene, axes, collider, surface, samples) +
         usd_visibility(scene, collider.name, shape, samples) +
         usd_placed(scene, axes, collider_path(scene, collider.name, samples)) + "        }\n";
}

/// The box of a deforming mesh has all its shapes.
SeenCollider seen_collider(const scene::Collider& collider, std::size_t shape,
                           const ColliderMesh& surface, const std::vector<Sample>& samples) {
  SeenCollider seen{collider.name, shape, setup::box_of(surface.points)};
  if (const auto* plane = std::get_if<sim::shapes::Plane>(&collider.shape.form))
    seen.normal = plane->normal.normalized();
  if (const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&collider.shape.form)) {
    const auto mesh = sim::shapes::deforming_mesh(*sequence);
    for (const Sample& sample : samples)
      if (const PlacedShape* placed = sample.find(collider.name, shape))
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
  std::map<std::string, std::size_t> shapes;
  for (const scene::Collider& collider : colliders) {
    const std::size_t shape = shapes[collider.name]++;
    if (std::ranges::none_of(samples,
                             [&](const Sample& s) { return s.find(collider.name, shape); }))
      continue;
    std::string name = usd_name(collider.name);
    while (!names.insert(name).second) name += "_";
    const ColliderMesh surface = collider_mesh(collider.shape);
    seen.push_back(seen_collider(collider, shape, surface, samples));
    text += usd_collider(scene, axes, collider, shape, surface, name, samples);
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
                      time = usd_number(time_in_frames(scene, samples[k].time));
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

std::vector<StageCamera> stage_cameras(const scene::Scene& scene) {
  const auto shares = [](const scene::View& view) { return !view.camera; };
  std::vector<StageCamera> cameras;
  if (scene.camera && setup::has_place(*scene.camera)) {
    const auto view = std::ranges::find_if(scene.views, shares);
    cameras.push_back({"camera", *scene.camera,
                       view == scene.views.end() ? scene.size : setup::size_of(scene, *view)});
  }
  std::set<std::string> names{"camera"};
  for (const scene::View& view : scene.views) {
    // Cameras that neve found frame the snow for a slice or another shape of pictures.
    if (!view.camera || !setup::has_place(*view.camera) ||
        view.camera->found == scene::FoundCamera::camera)
      continue;
    std::string name = cameras.empty() ? "camera" : usd_name(view.name);
    while (!cameras.empty() && !names.insert(name).second) name += "_";
    cameras.push_back({std::move(name), *view.camera, setup::size_of(scene, view)});
  }
  return cameras;
}

std::string encode_stage(const scene::Scene& scene, const std::vector<scene::Collider>& colliders,
                         const scene::Export& spec, const Table& columns,
                         const std::vector<Sample>& files, const std::vector<Sample>& between) {
  const Axes axes(spec);
  const double first = files.empty() ? 0 : time_in_frames(scene, files.front().time);
  const double last = files.empty() ? 0 : time_in_frames(scene, files.back().time);
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
         snow + obstacles + usd_cameras(scene, axes, samples, seen) + usd_light(scene, axes) +
         "}\n";
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
