/// Findings about colliders before a run.

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "app/health/findings.h"
#include "app/health/places.h"
#include "app/scene/coarsen.h"
#include "app/setup/auto_ranges.h"
#include "app/support/text.h"
#include "sim/shapes/deforming_mesh.h"

namespace neve::app::health {

namespace {

using sim::Vec3d;

constexpr const char* why_move_it =
    "move it out; contact lets snow out slowly, by 5 cells a second (solver.push_out at once, and "
    "crushes it)";

/// A plane that has the snow on its solid side is likelier turned the wrong way than a ceiling.
std::string way_out(const scene::Scene& scene, const sim::shapes::Collider& collider) {
  const auto* plane = std::get_if<sim::shapes::Plane>(&collider.shape.form);
  if (!plane || plane->normal.norm() == 0) return why_move_it;
  const Vec3d normal = sim::rotation_from_degrees(collider.shape.rotation) * plane->normal;
  const Vec3d& g = scene.solver.gravity;
  constexpr double steep = 0.5;
  const double down = g.norm() > 0 ? normal.normalized().dot(g.normalized()) : 0;
  if (down < -steep) return why_move_it;  // a floor, with snow below it
  const Vec3d other = Vec3d::Zero() - plane->normal;
  const std::string turned =
      fmt::format("collider.{}.shape.plane.normal = {}", collider.name, vector_text(other));
  if (down > steep)
    return fmt::format(
        "its normal {} points down, so its upper side is the solid one; a floor has {}",
        vector_text(plane->normal), turned);
  return fmt::format(
      "its normal {} points away from the snow, which is on its solid side; turn it round, {}, or "
      "move the snow",
      vector_text(plane->normal), turned);
}

/// Particles of a body: a share needs no more.
constexpr std::size_t max_looked_at = 20000;

void check_emitter_overlaps(const scene::Scene& scene, std::vector<Finding>& findings) {
  constexpr double much = 0.02;  // a nozzle that ends in a wall is none
  for (const sim::seeding::Emitter& emitter : scene.emitters) {
    const std::vector<Vec3d> places = places_in(emitter.shape);
    for (const sim::shapes::Collider& collider : scene.colliders) {
      const double share = share_inside(places, collider, emitter.start);
      if (share < much) continue;
      findings.push_back(
          {Severity::warning, "emitter." + emitter.name + ".shape",
           fmt::format("{} of {} is inside collider {} at its start", percent_text(share),
                       display_name("emitter", emitter.name), collider.name),
           why_move_it});
    }
  }
}

}  // namespace

const char* fastest_part(const sim::shapes::Collider& collider, double speed) {
  const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&collider.shape.form);
  if (sequence && sim::shapes::deforming_mesh(*sequence)->fastest() >= 0.5 * speed)
    return ".shape.mesh_sequence.rate";
  if (!collider.keyframes.empty()) return ".keyframes";
  if (collider.body.moves() && sim::shapes::largest_speed(collider) < speed) return "";  // it falls
  return collider.velocity.norm() < 0.5 * speed ? ".angular_velocity" : ".velocity";
}

void check_collider_overlaps(const scene::Scene& scene, const setup::SeededScene& seeded,
                             std::vector<Finding>& findings) {
  check_emitter_overlaps(scene, findings);
  for (const sim::shapes::Collider& collider : scene.colliders) {
    const Inside is_inside(collider, 0);
    for (std::size_t body = 0; body < seeded.body_end.size(); ++body) {
      const std::size_t first = seeded.body_begin(body), end = seeded.body_end[body];
      const std::size_t stride = (end - first) / max_looked_at + 1;
      std::size_t inside = 0, count = 0;
      for (std::size_t p = first; p < end; p += stride, ++count)
        inside += is_inside(seeded.particles.x[p]);
      if (inside == 0) continue;
      const std::string& name = scene.bodies[body].name;
      const double share = static_cast<double>(inside) / static_cast<double>(count);
      findings.push_back({Severity::warning, "body." + name + ".shape",
                          fmt::format("{} of {} starts inside collider {}", percent_text(share),
                                      display_name("body", name), collider.name),
                          2 * inside > count ? way_out(scene, collider) : why_move_it});
    }
  }
}

void check_motion(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings) {
  const sim::SolverSettings& s = scene.solver;
  // Adaptive steps are short enough.
  const double dt = s.time_step == sim::TimeStep::fixed ? s.dt : 0;
  for (const sim::shapes::Collider& collider : scene.colliders) {
    const double speed = setup::collider_speed(scene, collider.name),
                 cells = speed * dt / s.cell_size;
    const double c = check.start.max_sound_speed;
    const std::string at = "collider." + collider.name + fastest_part(collider, speed);
    if (cells > sim::health::limits_of(sim::health::Law::collider_cfl).check_warning)
      findings.push_back(
          {Severity::warning, at,
           fmt::format("{} moves up to {} m/s: {} cells in a step and runs over snow at rest",
                       display_name("collider", collider.name), rough_text(speed),
                       rough_text(cells)),
           scene::setting_text("solver.dt", 0.4 * s.cell_size / speed, check.coarsening) +
               ", or time_step = \"adaptive\""});
    else if (c > 0 &&
             speed > sim::health::limits_of(sim::health::Law::collider_mach).check_warning * c)
      findings.push_back(
          {Severity::warning, at,
           fmt::format("{} moves up to {} m/s, faster than sound in the snow ({} "
                       "m/s): it crushes the snow that it hits",
                       display_name("collider", collider.name), rough_text(speed), rough_text(c)),
           "make it slower, or youngs_modulus larger"});
  }
}

}  // namespace neve::app::health
