#include "app/scene/check.h"

#include <Eigen/Geometry>
#include <vector>

#include "app/scene/leaf.h"
#include "app/text.h"
#include "sim/contact.h"

namespace neve::app {
namespace {

using Found = std::optional<Problem>;

/// Directions shorter than this, and points closer, are the same as none.
constexpr double negligible = 1e-6;

/// Cells are numbered by 32-bit integers.
constexpr double max_cells_from_origin = 1 << 30;

Found problem(const sim::Torus& torus, const std::string& at) {
  if (torus.minor_radius <= torus.major_radius) return {};
  return Problem{at + ".torus.minor_radius", "minor_radius is larger than major_radius",
                 "a tube thicker than its ring overlaps itself"};
}

Found problem(const sim::Plane& plane, const std::string& at) {
  if (plane.normal.norm() > negligible) return {};
  return Problem{at + ".plane.normal", "normal is zero", "it points out of the solid side"};
}

Found problem(const sim::Mesh& mesh, const std::string& at) {
  if (!mesh.file.empty()) return {};
  return Problem{at + ".mesh", "mesh has no file", "give file = \"NAME.obj\""};
}

template <class Form>
Found problem(const Form&, const std::string&) {
  return {};
}

struct Place {
  const char* key;
  sim::Vec3d point;
};
Place place(const sim::Capsule& c) {
  return {".capsule.a", c.a};
}
Place place(const sim::Plane& p) {
  return {".plane.point", p.point};
}
Place place(const sim::Sphere& s) {
  return {".sphere.center", s.center};
}
Place place(const sim::Box& b) {
  return {".box.center", b.center};
}
Place place(const sim::Cylinder& c) {
  return {".cylinder.center", c.center};
}
Place place(const sim::Cone& c) {
  return {".cone.center", c.center};
}
Place place(const sim::Torus& t) {
  return {".torus.center", t.center};
}
Place place(const sim::Mesh& m) {
  return {".mesh.center", m.center};
}

Found material_problem(const Scene& scene, const sim::Body& body, const std::string& address) {
  std::vector<std::string> names;
  for (const sim::Material& material : scene.materials) {
    if (material.name == body.material) return {};
    names.push_back(material.name);
  }
  const std::string nearest = nearest_name(body.material, names);
  return Problem{address + ".material", "there is no material " + toml_string(body.material),
                 nearest.empty() ? "expected " + list_of(names)
                                 : "did you mean " + toml_string(nearest) + "?"};
}

Found body_problem(const Scene& scene, const sim::Body& body) {
  const std::string address = "body." + body.name;
  if (const Found found = material_problem(scene, body, address)) return found;
  const Place at = std::visit([](const auto& form) { return place(form); }, body.shape.form);
  if (at.point.cwiseAbs().maxCoeff() > max_cells_from_origin * scene.solver.cell_size) {
    return Problem{address + ".shape" + at.key, "more than 2^30 cells from the origin",
                   "move it closer or enlarge solver.cell_size"};
  }
  return std::visit([&](const auto& form) { return problem(form, address + ".shape"); },
                    body.shape.form);
}

Found camera_problem(const CameraSettings& camera, const std::string& at) {
  if (camera.up.norm() <= negligible) return Problem{at + ".up", "up is zero", ""};
  if (camera.eye.has_value() != camera.target.has_value()) {
    return Problem{at + (camera.eye ? ".eye" : ".target"), "eye and target go together",
                   "give both, or neither to frame the whole scene"};
  }
  if (!camera.eye) return {};
  const sim::Vec3d forward = *camera.target - *camera.eye;
  if (forward.norm() <= negligible) {
    return Problem{at + ".target", "eye and target are the same point", ""};
  }
  if (forward.normalized().cross(camera.up.normalized()).norm() <= negligible) {
    return Problem{at + ".up", "up is parallel to the direction of view", "try up = [0, 0, -1]"};
  }
  return {};
}

Found light_problem(const LightSettings& light) {
  if (light.direction.norm() > negligible) return {};
  return Problem{"light.direction", "direction is zero", "it points towards the light"};
}

Found slice_problem(const Scene& scene, const SliceStyle& slice, const std::string& at) {
  if (slice.normal.norm() <= negligible)
    return Problem{at + ".normal", "normal is zero", "it points across the plane"};
  if (slice.follow.empty()) return {};
  std::vector<std::string> names;
  for (const sim::Body& body : scene.bodies) {
    if (body.name == slice.follow) return {};
    names.push_back(body.name);
  }
  const std::string nearest = nearest_name(slice.follow, names);
  return Problem{at + ".follow", "there is no body " + toml_string(slice.follow),
                 nearest.empty() ? "expected " + list_of(names)
                                 : "did you mean " + toml_string(nearest) + "?"};
}

}  // namespace

std::optional<Problem> find_problem(const Scene& scene) {
  Found found;
  if (scene.bodies.empty()) {
    return Problem{"", "the scene has no body",
                   "add [[body]] with shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }"};
  }
  for (const sim::Body& body : scene.bodies) {
    if ((found = body_problem(scene, body))) return found;
  }
  if (scene.colliders.size() > sim::max_colliders)
    return Problem{"collider." + scene.colliders[sim::max_colliders].name,
                   "there are " + std::to_string(scene.colliders.size()) + " colliders",
                   "at most " + std::to_string(sim::max_colliders) + " can be there"};
  for (const sim::Collider& collider : scene.colliders) {
    const std::string at = "collider." + collider.name + ".shape";
    found = std::visit([&](const auto& form) { return problem(form, at); }, collider.shape.form);
    if (found) return found;
  }
  if (scene.camera && (found = camera_problem(*scene.camera, "camera"))) return found;
  if ((found = light_problem(scene.light))) return found;
  for (const View& view : scene.views) {
    const std::string at = "view." + view.name;
    if ((found = slice_problem(scene, view.slice, at + ".slice"))) return found;
    if (view.camera && (found = camera_problem(*view.camera, at + ".camera"))) return found;
  }
  return {};
}

}  // namespace neve::app
