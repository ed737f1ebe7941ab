#include "app/scene/check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "app/advice/suggest.h"
#include "app/scene/burn_in.h"
#include "app/scene/flat.h"
#include "app/scene/leaf.h"
#include "app/scene/names.h"
#include "app/scene/read.h"
#include "app/support/room.h"
#include "app/support/text.h"
#include "sim/kernels/blocks.h"
#include "sim/kernels/contact.h"
#include "sim/laws/law.h"
#include "sim/laws/threshold_cell.h"
#include "sim/shapes/deforming_mesh.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/mesh_surface.h"
#include "sim/shapes/numbered_files.h"
#include "sim/shapes/placed_points.h"
#include "sim/shapes/solid.h"
#include "sim/shapes/variation.h"
#include "sim/shapes/world_place.h"

namespace neve::app::scene {
namespace {

using Found = std::optional<Problem>;

/// More exports than a person writes.
constexpr std::size_t max_exports = 1000;

/// Directions shorter than this, and points closer, are the same as none.
constexpr double negligible = 1e-6;

/// The solver's lattice of nodes ends there; the reach of a stencil is left.
constexpr double max_cells_from_origin = 4.0 * sim::kernels::block_limit - 8;

Found problem(const sim::shapes::Torus& torus, const std::string& at) {
  if (torus.minor_radius <= torus.major_radius) return {};
  return Problem{at + ".torus.minor_radius", "minor_radius is larger than major_radius",
                 "a tube thicker than its ring overlaps itself"};
}

Found problem(const sim::shapes::Plane& plane, const std::string& at) {
  if (plane.normal.norm() > negligible) return {};
  return Problem{at + ".plane.normal", "normal is zero", "it must point out of the solid side"};
}

Found problem(const sim::shapes::Mesh& mesh, const std::string& at) {
  if (!mesh.file.empty()) return {};
  return Problem{at + ".mesh", "mesh has no file", "give file = \"NAME.obj\", .ply or .stl"};
}

Found problem(const sim::shapes::MeshSequence& sequence, const std::string& at) {
  const std::string key = at + ".mesh_sequence";
  if (sequence.files.empty())
    return Problem{key, "mesh_sequence has no files", "give files = \"NAME_%04d.obj\""};
  if (sequence.last > sequence.first &&
      sequence.last - sequence.first < sim::shapes::max_numbered_files)
    return {};
  return Problem{key + ".last",
                 "the files have the numbers " + std::to_string(sequence.first) + " to " +
                     std::to_string(sequence.last),
                 "expected 2 to " + std::to_string(sim::shapes::max_numbered_files) +
                     " files; a mesh that keeps its shape is mesh = { file = \"NAME.obj\" }"};
}

Found problem(const sim::shapes::Points& points, const std::string& at) {
  if (!points.file.empty()) return {};
  return Problem{at + ".points", "points have no file", "give file = \"NAME.ply\" or .csv"};
}

Found problem(const sim::shapes::Terrain& terrain, const std::string& at) {
  if (!terrain.file.empty()) return {};
  return Problem{at + ".terrain", "terrain has no file", "give file = \"NAME.asc\" or .png"};
}

Found problem(const sim::shapes::Cover& cover, const std::string& at) {
  const std::string key = at + ".cover";
  const bool is_disc = cover.radius > 0, is_rectangle = cover.width > 0 && cover.length > 0;
  if (is_disc && cover.width == 0 && cover.length == 0) return {};
  if (!is_disc && is_rectangle) return {};
  return Problem{key, "cover has no outline", "give width and length, or radius alone"};
}

template <class Form>
Found problem(const Form&, const std::string&) {
  return {};
}

/// Key of the place of a form.
struct PlaceKey {
  const char* operator()(const sim::shapes::Capsule&) const { return ".capsule.a"; }
  const char* operator()(const sim::shapes::Plane&) const { return ".plane.point"; }
  const char* operator()(const sim::shapes::Sphere&) const { return ".sphere.center"; }
  const char* operator()(const sim::shapes::Box&) const { return ".box.center"; }
  const char* operator()(const sim::shapes::Cylinder&) const { return ".cylinder.center"; }
  const char* operator()(const sim::shapes::Cone&) const { return ".cone.center"; }
  const char* operator()(const sim::shapes::Torus&) const { return ".torus.center"; }
  const char* operator()(const sim::shapes::Mesh&) const { return ".mesh.center"; }
  const char* operator()(const sim::shapes::MeshSequence&) const { return ".mesh_sequence.center"; }
  const char* operator()(const sim::shapes::Points&) const { return ".points.center"; }
  const char* operator()(const sim::shapes::Terrain&) const { return ".terrain.center"; }
  const char* operator()(const sim::shapes::Cover&) const { return ".cover.center"; }
};

Found material_problem(const Scene& scene, const std::string& wanted, const std::string& address) {
  std::vector<std::string> names;
  for (const sim::Material& material : scene.materials) {
    if (material.name == wanted) return {};
    names.push_back(material.name);
  }
  if (value_named<Preset>(wanted))
    return Problem{address + ".material",
                   toml::toml_string(wanted) + " is a preset, not a material of this scene",
                   "add [material." + wanted + "] with preset = " + toml::toml_string(wanted)};
  return Problem{address + ".material", "there is no material " + toml::toml_string(wanted),
                 name_advice(wanted, names)};
}

Found too_far(const Scene& scene, const sim::Vec3d& x, const std::string& address) {
  if (x.cwiseAbs().maxCoeff() <= max_cells_from_origin * scene.solver.cell_size) return {};
  return Problem{address,
                 "more than " + toml::number_text(max_cells_from_origin) + " cells from the origin",
                 "move it closer or enlarge solver.cell_size"};
}

/// Problems that only preparing the shape reveals: an open mesh, a volume that is not positive.
template <class Make>
Found ready_problem(const std::string& address, const Make& make) {
  try {
    return make();
  } catch (const sim::ShapeError& error) {
    return Problem{address + ".shape", error.what(), ""};
  }
}

/// Problem of the form or of its place.
Found form_problem(const sim::shapes::Shape& shape, const std::string& address) {
  return std::visit([&](const auto& form) { return problem(form, address + ".shape"); },
                    shape.form);
}

std::string place_address(const sim::shapes::Shape& shape, const std::string& address) {
  return address + ".shape" + std::visit(PlaceKey{}, shape.form);
}

/// Problem of a shape that is filled with snow. Point files are read later, with their points.
Found shape_problem(const Scene& scene, const sim::shapes::Shape& shape,
                    const std::string& address) {
  const std::string at = place_address(shape, address);
  if (Found found = too_far(scene, sim::shapes::center(shape), at)) return found;
  if (Found found = form_problem(shape, address)) return found;
  if (std::holds_alternative<sim::shapes::Points>(shape.form)) return {};
  // Its place is found when the whole scene is known.
  if (sim::shapes::needs_place(shape)) return {};
  if (const auto* cover = std::get_if<sim::shapes::Cover>(&shape.form))
    if (std::visit(
            [](const auto& ground) {
              return sim::shapes::needs_place({ground, {}});
            },
            cover->ground))
      return {};
  return ready_problem(address, [&] {
    const sim::shapes::Bounds b = sim::shapes::Solid(shape).bounds();
    return too_far(scene, b.min.cwiseAbs().cwiseMax(b.max.cwiseAbs()), at);
  });
}

/// The factors of variation leave every particle a stretch to which it can be compressed.
Found problem_of(const Scene& scene, const sim::Material& material) {
  if (!sim::laws::of(material).reads(&sim::Material::critical_compression)) return {};
  const double finer = std::sqrt(sim::laws::threshold_factor(scene.solver));
  if (material.critical_compression * finer >= 1)
    return Problem{"solver.threshold_cell",
                   "threshold_cell = " + rough_text(scene.solver.threshold_cell) +
                       " makes critical_compression " +
                       rough_text(material.critical_compression * finer) +
                       " in these cells: snow cannot be compressed to nothing",
                   "use a threshold_cell nearer to cell_size"};
  const double factor = finer * sim::shapes::max_factor(material.variation.thresholds);
  const double theta_c = material.critical_compression;
  if (theta_c * factor < 1) return {};
  return Problem{"material." + material.name + ".variation.thresholds",
                 "thresholds = " + rough_text(material.variation.thresholds) +
                     " gives some particles a critical_compression of " +
                     rough_text(theta_c * factor) + ": snow cannot be compressed to nothing",
                 "use thresholds below " +
                     rough_text(sim::shapes::deviation_of(1 / (theta_c * finer))) +
                     ", or critical_compression below " + rough_text(1 / factor)};
}

/// A height field is not read before there is room for it.
void require_room_for(const sim::shapes::Terrain& terrain) {
  require_room(sim::shapes::memory_to_read(terrain), "the height field", terrain.file,
               "cut it or take fewer posts, as gdal_translate does with -projwin and -tr");
}

/// The ground that a cover lies on.
Found cover_problem(const Scene& scene, const sim::shapes::Shape& shape,
                    const std::string& address) {
  const auto* cover = std::get_if<sim::shapes::Cover>(&shape.form);
  if (!cover) return {};
  const std::string at = address + ".shape.cover.on";
  std::vector<std::string> names;
  for (const Collider& collider : scene.colliders) {
    const auto* terrain = std::get_if<sim::shapes::Terrain>(&collider.shape.form);
    const bool is_mesh = std::holds_alternative<sim::shapes::Mesh>(collider.shape.form);
    if (terrain || is_mesh) names.push_back(collider.name);
    if (collider.name != cover->on) continue;
    if (!terrain && !is_mesh)
      return Problem{
          at, "collider " + cover->on + " is neither a terrain nor a mesh",
          "a cover lies on a collider with shape = { terrain = { file = \"NAME.asc\" } } "
          "or { mesh = { file = \"NAME.obj\" } }"};
    if (!terrain) continue;
    if (cover->turned.x() != 0 || cover->turned.z() != 0)
      return Problem{"collider." + collider.name +
                         (collider.keyframes.empty() ? ".shape.rotation" : ".keyframes"),
                     "a terrain that is tilted carries no cover",
                     "turn it about y alone: rotation = [0, ANGLE, 0]"};
    require_room_for(*terrain);
  }
  if (std::ranges::find(names, cover->on) == names.end())
    return Problem{
        at, "there is no collider " + toml::toml_string(cover->on) + " that is a terrain or a mesh",
        names.empty() ? "give on = the name of one" : name_advice(cover->on, names)};
  if (shape.rotation.x() != 0 || shape.rotation.z() != 0)
    return Problem{address + ".shape.rotation", "a cover lies on its ground and cannot be tilted",
                   "turn its outline about y alone: rotation = [0, ANGLE, 0]"};
  return {};
}

Found problem_of(const Scene& scene, const sim::seeding::Body& body) {
  const std::string address = "body." + body.name;
  if (const Found found = material_problem(scene, body.material, address)) return found;
  if (Found found = form_problem(body.shape, address)) return found;
  if (Found found = cover_problem(scene, body.shape, address)) return found;
  return shape_problem(scene, body.shape, address);
}

Found problem_of(const Scene& scene, const sim::seeding::Emitter& emitter) {
  const std::string address = "emitter." + emitter.name;
  if (const Found found = material_problem(scene, emitter.material, address)) return found;
  if (emitter.end && !(*emitter.end > emitter.start))
    return Problem{address + ".end",
                   "it closes at " + toml::number_text(*emitter.end) + " s and opens at " +
                       toml::number_text(emitter.start) + " s",
                   "end must be later than start; remove end for an emitter that stays open"};
  if (emitter.end && emitter.rate == 0)
    return Problem{address + ".end", "without a rate the whole shape is filled at once",
                   "give rate, in kg/s, or remove end"};
  return shape_problem(scene, emitter.shape, address);
}

Found problem_of(const Scene&, const sim::seeding::Sink& sink) {
  const std::string address = "sink." + sink.name;
  if (Found found = form_problem(sink.shape, address)) return found;
  return ready_problem(address, [&] {
    [[maybe_unused]] const sim::shapes::Solid solid(sink.shape);
    return Found{};
  });
}

/// Problem of one camera position.
Found place_problem(const sim::Vec3d& eye, const sim::Vec3d& target, const sim::Vec3d& up,
                    const std::string& target_at, const std::string& up_at) {
  const sim::Vec3d forward = target - eye;
  if (forward.norm() <= negligible) {
    return Problem{target_at, "eye and target are the same point", "move one of them"};
  }
  if (forward.normalized().cross(up.normalized()).norm() <= negligible) {
    return Problem{up_at, "up is parallel to the direction of view", "try up = [0, 0, -1]"};
  }
  return {};
}

std::string key_address(const std::string& at, std::size_t k) {
  return at + ".keyframes[" + std::to_string(k + 1) + "]";
}

/// Keyframes follow each other.
template <class Key>
Found order_problem(const std::vector<Key>& keys, std::size_t k, const std::string& at) {
  if (k == 0 || keys[k].time > keys[k - 1].time) return {};
  return Problem{key_address(at, k) + ".time",
                 "keyframe " + std::to_string(k + 1) + " is at " + toml::number_text(keys[k].time) +
                     " s, the one before at " + toml::number_text(keys[k - 1].time) + " s",
                 "times must increase from one keyframe to the next"};
}

Found keyframe_problem(const CameraSettings& camera, const std::string& at) {
  for (std::size_t k = 0; k < camera.keyframes.size(); ++k) {
    if (Found found = order_problem(camera.keyframes, k, at)) return found;
    const CameraKeyframe& key = camera.keyframes[k];
    const std::string key_at = key_address(at, k);
    const auto eye = key.eye ? key.eye : camera.eye;
    const auto target = key.target ? key.target : camera.target;
    if (!eye || !target) continue;
    if (Found found = place_problem(*eye, *target, camera.up, key_at + ".target", key_at + ".eye"))
      return found;
  }
  return {};
}

/// Problem of the name of a body or collider that something moves along with.
Found follow_problem(const Scene& scene, const std::string& follow, const std::string& at) {
  if (follow.empty()) return {};
  std::vector<std::string> names;
  for (const sim::seeding::Body& body : scene.bodies) {
    if (body.name == follow) return {};
    names.push_back(body.name);
  }
  for (const Collider& collider : scene.colliders) {
    const bool has_place = !std::holds_alternative<sim::shapes::Plane>(collider.shape.form) &&
                           !std::holds_alternative<sim::shapes::Terrain>(collider.shape.form);
    if (!has_place) continue;
    if (collider.name == follow) return {};
    names.push_back(collider.name);
  }
  return Problem{at + ".follow", "there is no body " + toml::toml_string(follow),
                 name_advice(follow, names)};
}

Found camera_problem(const Scene& scene, const CameraSettings& camera, const std::string& at) {
  if (camera.up.norm() <= negligible) {
    return Problem{at + ".up", "up is zero", "it must point upwards in the picture"};
  }
  if (camera.eye.has_value() != camera.target.has_value()) {
    return Problem{at + (camera.eye ? ".eye" : ".target"), "eye and target go together",
                   "give both, or neither to frame the whole scene"};
  }
  if (camera.orbit && camera.turntable) {
    return Problem{at + ".turntable", "orbit and turntable both turn the eye",
                   "give one: orbit = degrees over the whole scene, turntable = seconds per turn"};
  }
  if (camera.push_in && (camera.eye || !camera.keyframes.empty() || !camera.follow.empty())) {
    const std::string other = camera.eye ? "eye" : camera.follow.empty() ? "keyframes" : "follow";
    return Problem{at + ".push_in", "push_in moves an automatic camera, and " + other + " is given",
                   "omit " + other + ", or give the move as keyframes"};
  }
  if (camera.eye) {
    if (Found found =
            place_problem(*camera.eye, *camera.target, camera.up, at + ".target", at + ".up"))
      return found;
  }
  if (Found found = keyframe_problem(camera, at)) return found;
  return follow_problem(scene, camera.follow, at);
}

/// Pictures of a view are in the folder of its name, among all else that a run has.
Found folder_problem(const std::string& at, const std::string& name) {
  for (const char* own : {"checkpoint", "exports", "log", "states"})
    if (name == own)
      return Problem{
          at + ".name",
          toml::toml_string(name) + " is the name of something else in the folder of a run",
          "choose another name"};
  return {};
}

Found problem_of(const Scene& scene, const View& view) {
  const std::string at = "view." + view.name;
  if (Found found = folder_problem(at, view.name)) return found;
  if (view.slice.normal.norm() <= negligible)
    return Problem{at + ".slice.normal", "normal is zero", "it must point across the plane"};
  if (Found found = follow_problem(scene, view.slice.follow, at + ".slice")) return found;
  if (view.camera)
    if (Found found = camera_problem(scene, *view.camera, at + ".camera")) return found;
  if (has_layer(view, Layer::smoke) && has_layer(view, Layer::dust))
    return Problem{at + ".layers", "smoke and dust are both drawn as smoke",
                   "give each a view of its own; dust goes with snow or particles"};
  if (view.clip && view.clip->normal.norm() <= negligible)
    return Problem{at + ".clip.normal", "normal is zero",
                   "it must point towards the side to cut away"};
  return {};
}

Found problem_of(const Scene& scene, const Mosaic& mosaic) {
  constexpr std::size_t most = 64;
  const std::string at = "mosaic." + mosaic.name;
  if (Found found = folder_problem(at, mosaic.name)) return found;
  std::vector<std::string> names;
  for (const View& view : scene.views) names.push_back(view.name);
  if (mosaic.views.empty() || mosaic.views.size() > most) {
    return Problem{at + ".views", "a mosaic of " + std::to_string(mosaic.views.size()) + " views",
                   "name 1 to " + std::to_string(most) + " of " + list_of(names)};
  }
  std::vector<std::string> drawable = names;
  for (const View& view : built_in_views())
    if (std::find(names.begin(), names.end(), view.name) == names.end())
      drawable.push_back(view.name);
  const auto is_view = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (is_view(mosaic.name)) {
    return Problem{at + ".name", "a view is called " + toml::toml_string(mosaic.name) + " too",
                   "both would write into the folder of that name; rename the mosaic"};
  }
  for (const std::string& name : mosaic.views) {
    if (is_view(name)) continue;
    return Problem{at + ".views", "there is no view " + toml::toml_string(name),
                   name_advice(name, drawable)};
  }
  return {};
}

bool names_attribute(const Export& e, ExportAttribute attribute) {
  return std::find(e.attributes.begin(), e.attributes.end(), attribute) != e.attributes.end();
}

bool holds_meshes(ExportFormat format) {
  return format == ExportFormat::ply || format == ExportFormat::vtp ||
         format == ExportFormat::usda || format == ExportFormat::obj || format == ExportFormat::vdb;
}

Found dust_export_problem(const Export& e) {
  const std::string at = "export." + e.name;
  if (e.surface) return Problem{at + ".surface", "dust has no surface", "remove surface, or dust"};
  if (!e.bodies.empty())
    return Problem{at + ".bodies", "dust is of no body", "remove bodies, or dust"};
  if (!e.carried.empty())
    return Problem{at + ".carried", "dust carries no columns of files", "remove carried, or dust"};
  if (e.attributes == Export{}.attributes) return {};
  for (const ExportAttribute attribute : e.attributes)
    if (!is_of_dust(attribute))
      return Problem{at + ".attributes",
                     std::string("dust has no ") + toml::toml_string(name(attribute)),
                     "expected some of id, x, v, m, radius, age"};
  return {};
}

Found export_format_problem(const Export& e) {
  const std::string at = "export." + e.name;
  if (e.surface && !holds_meshes(e.format))
    return Problem{at + ".surface",
                   std::string("a file of format ") + name(e.format) + " cannot hold a surface",
                   "use ply, vtp, usda, obj or vdb, or write the particles without the surface"};
  if (!e.surface && e.format == ExportFormat::obj)
    return Problem{at + ".format", "an obj file holds a surface and no particles",
                   "add --surface, or surface = true; ply has particles"};
  return {};
}

/// Columns of the point files that an export could carry along. A file that cannot be read is
/// refused when the body is made.
std::vector<std::string> carried_columns(const Scene& scene) {
  std::vector<std::string> all;
  for (const sim::seeding::Body& body : scene.bodies) {
    const auto* points = std::get_if<sim::shapes::Points>(&body.shape.form);
    if (!points) continue;
    try {
      for (const std::string& column : sim::shapes::column_names(*points))
        if (is_identifier(column) && std::find(all.begin(), all.end(), column) == all.end())
          all.push_back(column);
    } catch (const sim::ShapeError&) {
    }
  }
  return all;
}

/// Returns a name as formats write it that allow fewer letters.
std::string plain_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

/// Names that a file of a format has beside those of its attributes.
std::vector<std::string> own_names(const Export& e) {
  std::vector<std::string> names;
  if (e.format == ExportFormat::npz) names = {"time", "frame", "fps", "scale", "up"};
  if (e.format == ExportFormat::bgeo) names = {"P", "pscale", "time", "frame", "fps", "scale"};
  if (e.format == ExportFormat::vtp) names = {"Normals", "Points"};
  const bool has_components = e.format == ExportFormat::ply || e.format == ExportFormat::csv;
  if (has_components) names = {"x", "y", "z", "vx", "vy", "vz"};
  if (has_components && e.surface) names.insert(names.end(), {"nx", "ny", "nz"});
  return names;
}

Found carried_problem(const Scene& scene, const Export& e) {
  if (e.carried.empty()) return {};
  const std::string at = "export." + e.name + ".carried";
  const std::vector<std::string> columns = carried_columns(scene),
                                 ours = choices<ExportAttribute>();
  for (const std::string& name : e.carried) {
    const std::string quoted = toml::toml_string(name);
    if (std::count(e.carried.begin(), e.carried.end(), name) > 1)
      return Problem{at, quoted + " is named twice", "name each column once"};
    if (std::find(ours.begin(), ours.end(), name) != ours.end())
      return Problem{at, quoted + " is an attribute of neve itself",
                     "write it in attributes; rename the column of the file to carry it along"};
    const std::vector<std::string> own = own_names(e);
    const auto has_its_name = [&](const std::string& other) {
      return other == name ||
             (e.format == ExportFormat::usda && plain_name(other) == plain_name(name));
    };
    const auto is_other = [&](const std::string& other) {
      return other != name && has_its_name(other);
    };
    if (std::any_of(own.begin(), own.end(), has_its_name) ||
        std::any_of(e.carried.begin(), e.carried.end(), is_other) ||
        std::any_of(ours.begin(), ours.end(), is_other))
      return Problem{at, quoted + " would have the name of another column in a file of this format",
                     "rename the column of the file to carry it along"};
    if (std::find(columns.begin(), columns.end(), name) != columns.end()) continue;
    std::vector<std::string> known = ours;
    for (const std::string& column : columns)
      if (std::find(ours.begin(), ours.end(), column) == ours.end()) known.push_back(column);
    return Problem{at, "there is no attribute " + quoted + ", and no point file has such a column",
                   advice::suggest_one_of(name, {"attribute", known})};
  }
  return {};
}

Found problem_of(const Scene& scene, const Export& e) {
  const std::string at = "export." + e.name;
  if (Found found = export_format_problem(e)) return found;
  if (Found found = e.dust ? dust_export_problem(e) : Found{}) return found;
  if (Found found = carried_problem(scene, e)) return found;
  for (const Export& other : scene.exports) {
    if (&other == &e) break;
    if (folder_of(other) == folder_of(e))
      return Problem{at + ".name", "two exports write into the folder exports/" + folder_of(e),
                     "give one of them another name"};
  }
  const std::vector<std::string> names = snow_sources(scene);
  for (const std::string& name : e.bodies) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    return Problem{at + ".bodies", "there is no body or emitter " + toml::toml_string(name),
                   name_advice(name, names)};
  }
  if (e.dust || !mixes_emitters(scene)) return {};
  const bool needs_origin =
      names_attribute(e, ExportAttribute::body) || names_attribute(e, ExportAttribute::age);
  if (!needs_origin && e.bodies.empty()) return {};
  return Problem{at + (needs_origin ? ".attributes" : ".bodies"), mixed_emitters,
                 "omit body and age, and name no bodies, or use one emitter"};
}

/// Compares the attitudes, which several angles can describe, within 1e-4 degrees.
bool is_half_turn(const sim::Vec3d& degrees, const sim::Vec3d& next) {
  const sim::Mat3d turn =
      sim::rotation_from_degrees(degrees).transpose() * sim::rotation_from_degrees(next);
  return turn.trace() < -1 + 1e-12;
}

/// Finds a value that only a body with a mass has, on a collider without one.
Found massless_problem(const Collider& collider, const std::string& at) {
  const sim::shapes::RigidBody &body = collider.body, fresh;
  const std::pair<const char*, bool> given[] = {{".inertia", body.inertia != fresh.inertia},
                                                {".hold", !body.hold.empty()},
                                                {".joint", body.joint != fresh.joint},
                                                {".joint_stiffness", body.joint_stiffness != 0},
                                                {".joint_damping", body.joint_damping != 0},
                                                {".spring_stiffness", body.spring_stiffness != 0},
                                                {".spring_damping", body.spring_damping != 0},
                                                {".restitution", body.restitution != 0}};
  for (const auto& [key, is_given] : given)
    if (is_given)
      return Problem{at + key, std::string(key + 1) + " is of a body that moves by itself",
                     "give " + at + " a density in kg/m3, or a mass in kg"};
  return {};
}

/// A body that moves by itself.
Found body_problem(const Scene& scene, const Collider& collider) {
  const std::string at = "collider." + collider.name;
  const sim::shapes::RigidBody& body = collider.body;
  if (!body.moves()) return massless_problem(collider, at);
  const char* key = body.mass > 0 ? ".mass" : ".density";
  if (body.mass > 0 && body.density > 0)
    return Problem{at + key, "the body has a mass and a density", "give one of the two"};
  if (!sim::shapes::is_rigid_solid(collider.shape))
    return Problem{at + key, "a shape of this kind cannot move by itself",
                   "give a mass to a sphere, box, capsule, cylinder, cone, torus or mesh"};
  if (!collider.keyframes.empty())
    return Problem{at + key, "keyframes and a mass both move the collider",
                   "omit the one or the other"};
  if (!scene.solver.is_contact_at_particles())
    return Problem{at + key, "snow does not move bodies with solver.contact_at = \"nodes\"",
                   "use contact_at = \"particles\", the default"};
  const sim::Vec3d& inertia = body.inertia;
  if (!inertia.isZero(0) && (inertia.minCoeff() <= 0 || 2 * inertia.maxCoeff() > inertia.sum()))
    return Problem{at + ".inertia", "no body has these moments of inertia",
                   "give three above 0, none larger than the other two together"};
  if (body.joint != sim::shapes::Joint::none && body.joint_axis.isZero(0))
    return Problem{at + ".joint_axis", "the axis of the joint has no direction",
                   "give a vector, as [0, 0, 1]"};
  const bool has_axis =
      body.joint == sim::shapes::Joint::hinge || body.joint == sim::shapes::Joint::slider;
  if (!has_axis && (body.joint_stiffness > 0 || body.joint_damping > 0))
    return Problem{at + (body.joint_stiffness > 0 ? ".joint_stiffness" : ".joint_damping"),
                   "only a hinge or a slider has a spring or a damper",
                   "give joint = \"hinge\" or \"slider\""};
  return {};
}

Found motion_problem(const Collider& collider) {
  const std::string at = "collider." + collider.name;
  if (collider.keyframes.empty()) return {};
  for (const auto& [key, velocity] : {std::pair{".velocity", collider.velocity},
                                      std::pair{".angular_velocity", collider.angular_velocity}}) {
    if (velocity.isZero(0)) continue;
    return Problem{at + key, std::string(key + 1) + " and keyframes both move the collider",
                   "give one of the two; two equal keyframes hold the collider still"};
  }
  for (std::size_t k = 0; k < collider.keyframes.size(); ++k) {
    if (Found found = order_problem(collider.keyframes, k, at)) return found;
    const sim::shapes::PoseKeyframe& key = collider.keyframes[k];
    const sim::shapes::PoseKeyframe* before = k > 0 ? &key - 1 : nullptr;
    const std::string key_at = key_address(at, k), who = "keyframe " + std::to_string(k + 1);
    if (before && key.time - before->time < 1e-9) {
      return Problem{key_at + ".time", who + " is less than 1e-9 s after the one before",
                     "for a jump, set the keyframes 1e-4 s apart, less than a step"};
    }
    const sim::Vec3d own = collider.shape.rotation;
    const sim::Vec3d rotation = key.rotation.value_or(own);
    const sim::Vec3d last = before ? before->rotation.value_or(own) : rotation;
    if (sim::shapes::written_turn(last, rotation) >= 180 || is_half_turn(last, rotation)) {
      return Problem{
          key_at + ".rotation", who + " turns by 180 degrees or more since the one before",
          "a collider turns the shorter way; add a keyframe in between, or use angular_velocity"};
    }
  }
  return {};
}

/// A plane may have its point anywhere: any other of its surface does as well.
Found problem_of(const Scene& scene, const Collider& collider) {
  const std::string address = "collider." + collider.name;
  if (Found found = form_problem(collider.shape, address)) return found;
  if (Found found = motion_problem(collider)) return found;
  if (Found found = body_problem(scene, collider)) return found;
  if (std::holds_alternative<sim::shapes::Plane>(collider.shape.form)) return {};
  const std::string at = place_address(collider.shape, address);
  if (Found found = too_far(scene, sim::shapes::center(collider.shape), at)) return found;
  for (std::size_t k = 0; k < collider.keyframes.size(); ++k) {
    if (!collider.keyframes[k].position) continue;
    if (Found found =
            too_far(scene, *collider.keyframes[k].position, key_address(address, k) + ".position"))
      return found;
  }
  return ready_problem(address, [&] {
    if (const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&collider.shape.form)) {
      const sim::shapes::Bounds b = sim::shapes::deforming_mesh(*sequence)->bounds();
      return too_far(scene,
                     sequence->center.cwiseAbs() + b.min.cwiseAbs().cwiseMax(b.max.cwiseAbs()), at);
    }
    if (const auto* mesh = std::get_if<sim::shapes::Mesh>(&collider.shape.form))
      sim::shapes::mesh_surface(*mesh);
    else if (const auto* terrain = std::get_if<sim::shapes::Terrain>(&collider.shape.form))
      require_room_for(*terrain), sim::shapes::height_field(*terrain);
    else
      sim::shapes::Solid(collider.shape);
    return Found{};
  });
}

/// Finds a curve of the shape of a collider, or of the velocity of one that moves by itself.
Found collider_curve_problem(const Scene& scene, const Curve& curve, const std::string& at) {
  for (const Collider& collider : scene.colliders) {
    const std::string table = "collider." + collider.name + ".";
    if (curve.parameter.starts_with(table + "shape."))
      return Problem{at,
                     curve.parameter +
                         " would jump from frame to frame: snow would not feel its "
                         "surface come",
                     "give " + table + "keyframes, which move its surface with it"};
    if (collider.body.moves() &&
        (curve.parameter == table + "velocity" || curve.parameter == table + "angular_velocity"))
      return Problem{at,
                     collider.name +
                         " moves by itself: a curve of its velocity would take away in "
                         "each frame what it has gained",
                     "remove density from it, or the curve"};
  }
  return {};
}

/// Parameters with curves are numbers or vectors of the simulation that may change while it runs.
Found parameter_problem(const Scene& scene, const Curve& curve, const FlatParam* param) {
  const std::string at = "curve." + curve.name + ".parameter";
  if (curve.parameter.empty())
    return Problem{at, "the curve names no parameter",
                   "give its address, as in parameter = \"solver.gravity\"; neve params lists all"};
  if (!param) {
    std::vector<std::string> known;
    for (const FlatParam& other : flatten(scene))
      if (other.is_live && concerns_simulation(other.address)) known.push_back(other.address);
    return Problem{at, "nothing in the scene is called \"" + curve.parameter + "\"",
                   advice::suggest(curve.parameter, {"", known}, "neve params lists addresses")};
  }
  if (!concerns_simulation(param->address))
    return Problem{at, curve.parameter + " only concerns pictures",
                   "cameras and colliders have keyframes of their own"};
  if (!param->is_live)
    return Problem{at, curve.parameter + " cannot change while a simulation runs",
                   "neve params says \"live\" where it can"};
  if (Found found = collider_curve_problem(scene, curve, at)) return found;
  if (param->type == "number" || param->type == "vector") return {};
  return Problem{at, curve.parameter + " is a " + param->type, "numbers and vectors have curves"};
}

Found key_problem(const CurveKeyframe& key, const FlatParam& param, const std::string& at) {
  const bool is_vector = param.type == "vector";
  const char *wanted = is_vector ? "vector" : "value", *other = is_vector ? "value" : "vector";
  if (is_vector ? key.value.has_value() : key.vector.has_value())
    return Problem{at + "." + other, param.address + " is a " + param.type,
                   std::string("give ") + wanted + " = " + (is_vector ? "[0, -9.81, 0]" : "0.5")};
  if (is_vector ? !key.vector : !key.value)
    return Problem{at + ".time", std::string("the keyframe has no ") + wanted,
                   std::string("give ") + wanted + " = " + (is_vector ? "[0, -9.81, 0]" : "0.5")};
  for (int c = 0; c < (is_vector ? 3 : 1); ++c) {
    const double number = is_vector ? (*key.vector)[c] : *key.value;
    if (!param.valid.contains(number))
      return Problem{at + "." + wanted, param.address + " would be " + toml::number_text(number),
                     "expected " + param.valid.text_of_bounds()};
  }
  return {};
}

Found curve_problem(const Scene& scene, const Curve& curve, const FlatParam* param) {
  if (Found found = parameter_problem(scene, curve, param)) return found;
  const std::string at = "curve." + curve.name;
  if (curve.keyframes.empty())
    return Problem{at + ".keyframes", "the curve has no keyframes",
                   "add keyframes = [{ time = 0, value = ... }, { time = 1, value = ... }]"};
  for (std::size_t k = 0; k < curve.keyframes.size(); ++k) {
    if (Found found = order_problem(curve.keyframes, k, at)) return found;
    if (Found found = key_problem(curve.keyframes[k], *param, key_address(at, k))) return found;
  }
  for (const Curve& other : scene.curves)
    if (&other < &curve && other.parameter == curve.parameter)
      return Problem{at + ".parameter",
                     curve.parameter + " has the curve " + other.name + " already",
                     "put all keyframes of a parameter into one curve"};
  return {};
}

Found curves_problem(const Scene& scene) {
  if (scene.curves.empty()) return {};
  const std::vector<FlatParam> params = flatten(scene);
  std::unordered_map<std::string_view, const FlatParam*> named;
  for (const FlatParam& param : params) named.emplace(param.address, &param);
  for (const Curve& curve : scene.curves) {
    const auto param = named.find(curve.parameter);
    if (Found found = curve_problem(scene, curve, param == named.end() ? nullptr : param->second))
      return found;
  }
  return {};
}

}  // namespace

std::optional<Problem> find_problem(const Scene& scene) {
  Found found;
  if (scene.bodies.empty() && scene.emitters.empty()) {
    return Problem{"", "the scene has no body and no emitter",
                   "add [[body]] with shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }"};
  }
  const auto is_wrong = [&](const auto& list) {
    return std::ranges::any_of(list, [&](const auto& one) {
      found = problem_of(scene, one);
      return found.has_value();
    });
  };
  if (is_wrong(scene.materials) || is_wrong(scene.bodies) || is_wrong(scene.emitters) ||
      is_wrong(scene.sinks))
    return found;
  if (scene.colliders.size() > sim::kernels::max_colliders)
    return Problem{"collider." + scene.colliders[sim::kernels::max_colliders].name,
                   "there are " + std::to_string(scene.colliders.size()) + " colliders",
                   "at most " + std::to_string(sim::kernels::max_colliders) + " are allowed"};
  if (is_wrong(scene.colliders)) return found;
  if ((found = curves_problem(scene))) return found;
  if (scene.camera && (found = camera_problem(scene, *scene.camera, "camera"))) return found;
  if (scene.light.direction.norm() <= negligible)
    return Problem{"light.direction", "direction is zero", "it must point towards the light"};
  if (is_wrong(scene.views) || is_wrong(scene.mosaics)) return found;
  // Each is compared with each, and held beside every other one.
  if (scene.exports.size() > max_exports)
    return Problem{"export", "has more than " + std::to_string(max_exports) + " exports",
                   "write several attributes into one file"};
  if (is_wrong(scene.exports)) return found;
  return shot_problem(scene);
}

}  // namespace neve::app::scene
