/// Findings about numbers that are allowed, but mean something else than their writer thinks:
/// radians, thousandths, gravity in g, a light from below.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "app/health/findings.h"
#include "app/scene/toml/value.h"
#include "app/support/text.h"
#include "sim/laws/law.h"

namespace neve::app::health {

namespace {

using scene::toml::number_text;
using sim::Vec3d;

/// Degrees, rounded, if a number is a usual angle in radians to four digits.
std::optional<double> degrees_of_radians(double value) {
  for (const double degrees : {30.0, 45.0, 60.0, 90.0, 120.0, 135.0, 180.0, 270.0, 360.0})
    if (std::abs(std::abs(value) / (degrees * std::numbers::pi / 180) - 1) < 2e-4)
      return std::copysign(degrees, value);
  return std::nullopt;
}

void check_unit_of_rotation(const std::string& address, const Vec3d& rotation,
                            std::vector<Finding>& findings) {
  Vec3d meant = rotation;
  bool is_radians = false;
  for (int k = 0; k < 3; ++k)
    if (const std::optional<double> degrees = degrees_of_radians(rotation[k])) {
      meant[k] = *degrees;
      is_radians = true;
    }
  if (!is_radians) return;
  findings.push_back({Severity::warning, address + ".rotation",
                      fmt::format("a rotation of {} degrees is hardly seen; it looks like radians",
                                  vector_text(rotation)),
                      "rotations are in degrees: " + vector_text(meant)});
}

/// Spins are in radians a second; whole multiples of 45 look like degrees.
void check_unit_of_spin(const std::string& address, const Vec3d& spin,
                        std::vector<Finding>& findings) {
  constexpr double step = 45;
  const double fastest = spin.cwiseAbs().maxCoeff();
  if (fastest < step || std::fmod(fastest, step) != 0) return;
  // 14 turns a second and more are no spin that snow bears.
  findings.push_back({fastest < 2 * step ? Severity::note : Severity::warning,
                      address + ".angular_velocity",
                      fmt::format("{} rad/s are {} turns a second", number_text(fastest),
                                  rough_text(fastest / (2 * std::numbers::pi))),
                      fmt::format("{} degrees a second are {}", number_text(fastest),
                                  rough_text(fastest * std::numbers::pi / 180))});
}

void check_thresholds(const sim::Material& m, std::vector<Finding>& findings) {
  if (!sim::laws::of(m).reads(&sim::Material::critical_stretch)) return;
  constexpr double doubtful_stretch = 1, doubtful_compression = 0.5;
  const auto add = [&](const char* key, double value, const char* what) {
    findings.push_back(
        {Severity::warning, "material." + m.name + "." + key,
         fmt::format("{} is a share of the length: {}", number_text(value), what),
         fmt::format("tables of the paper are in thousandths: {}", number_text(value / 1000))});
  };
  if (m.critical_stretch >= doubtful_stretch)
    add("critical_stretch", m.critical_stretch,
        "snow stretches to twice its length and never breaks");
  if (m.critical_compression >= doubtful_compression)
    add("critical_compression", m.critical_compression, "snow never packs");
}

/// Snow may begin packed; grains may not, and their first step takes a J_P below 1 for 1.
template <class Thing>
void check_packing_of_grains(const scene::Scene& scene, const std::string& address,
                             const Thing& thing, std::vector<Finding>& findings) {
  const auto material = std::ranges::find(scene.materials, thing.material, &sim::Material::name);
  if (!(thing.J_P < 1) || material == scene.materials.end() ||
      !sim::laws::of(*material).is_granular)
    return;
  findings.push_back(
      {Severity::warning, address + ".J_P",
       fmt::format("{} is never packed: {} puts {} times its mass into the same space, and counts "
                   "as 1 from the first step on",
                   material->name, number_text(thing.J_P), rough_text(1 / thing.J_P)),
       fmt::format("{}.J_P = 1; material.{}.density makes it denser", address, material->name)});
}

/// A law that yields holds J_P in the range of its material, and takes what is born outside of it
/// to the end of the range in one step.
template <class Thing>
void check_range_of_packing(const scene::Scene& scene, const std::string& address,
                            const Thing& thing, std::vector<Finding>& findings) {
  const auto m = std::ranges::find(scene.materials, thing.material, &sim::Material::name);
  if (m == scene.materials.end() || !sim::laws::of(*m).is_plastic) return;
  const bool is_loose = thing.J_P > m->max_J_P;
  // Grains that are packed have a word of their own.
  if (!is_loose && (!(thing.J_P < m->min_J_P) || sim::laws::of(*m).is_granular)) return;
  const std::string key = is_loose ? "max_J_P" : "min_J_P";
  const double end = is_loose ? m->max_J_P : m->min_J_P;
  findings.push_back(
      {Severity::warning, address + ".J_P",
       fmt::format("{} is outside of the range of {}, whose {} is {}: J_P becomes that where it "
                   "first yields, without a load that moved it there",
                   number_text(thing.J_P), m->name, key, number_text(end)),
       fmt::format("{}.J_P = {}, or material.{}.{} = {}", address, number_text(end), m->name, key,
                   number_text(thing.J_P))});
}

void check_camera_angles(const std::string& address, const scene::CameraSettings& camera,
                         double duration, std::vector<Finding>& findings) {
  if (camera.turntable && *camera.turntable >= 90 && std::fmod(*camera.turntable, 90) == 0 &&
      *camera.turntable > 4 * duration)
    findings.push_back(
        {Severity::warning, address + ".turntable",
         fmt::format("a turn in {} s is {} degrees in this scene", number_text(*camera.turntable),
                     rough_text(360 * duration / *camera.turntable)),
         fmt::format("turntable is the time of one turn; for an angle set {}.orbit = {}", address,
                     number_text(*camera.turntable))});
  constexpr double few_turns = 4;
  if (camera.orbit && *camera.orbit != 0 && std::abs(*camera.orbit) <= few_turns)
    findings.push_back(
        {Severity::warning, address + ".orbit",
         fmt::format("an orbit of {} degrees is hardly seen", number_text(*camera.orbit)),
         "it is in degrees over the whole scene; a turn is 360"});
  constexpr double wide = 100, absurd = 140;
  if (camera.fov > wide)
    findings.push_back(
        {camera.fov < absurd ? Severity::note : Severity::warning, address + ".fov",
         fmt::format("a view of {} degrees bends what is near its edges", number_text(camera.fov)),
         "30 is usual; a lens of 35 mm has 38"});
}

}  // namespace

void check_senses(const scene::Scene& scene, std::vector<Finding>& findings) {
  const double g = scene.solver.gravity.norm();
  if (g > 0.9 && g < 1.1)
    findings.push_back({Severity::warning, "solver.gravity",
                        fmt::format("gravity of {} m/s2 is a tenth of the earth's", rough_text(g)),
                        "in m/s2 it is " + vector_text(9.81 * scene.solver.gravity)});
  for (const sim::Material& material : scene.materials) check_thresholds(material, findings);
  const auto check_things = [&](const auto& things, const char* kind) {
    for (const auto& thing : things) {
      const std::string address = std::string(kind) + "." + thing.name;
      check_unit_of_rotation(address + ".shape", thing.shape.rotation, findings);
      check_unit_of_spin(address, thing.angular_velocity, findings);
    }
  };
  check_things(scene.bodies, "body");
  check_things(scene.emitters, "emitter");
  check_things(scene.colliders, "collider");
  const auto check_packing = [&](const auto& sources, const char* kind) {
    for (const auto& source : sources) {
      const std::string address = std::string(kind) + "." + source.name;
      check_packing_of_grains(scene, address, source, findings);
      check_range_of_packing(scene, address, source, findings);
    }
  };
  check_packing(scene.bodies, "body");
  check_packing(scene.emitters, "emitter");
  const double duration = scene::duration(scene);
  if (scene.camera) check_camera_angles("camera", *scene.camera, duration, findings);
  for (const scene::View& view : scene.views)
    if (view.camera)
      check_camera_angles("view." + view.name + ".camera", *view.camera, duration, findings);
  if (scene.light.direction[1] < 0)
    findings.push_back({Severity::warning, "light.direction", "the light comes from below",
                        "it points to the light: " + vector_text(-scene.light.direction)});
}

}  // namespace neve::app::health
