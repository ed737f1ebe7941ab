/// Findings about emitters and sinks before a run.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "app/health/findings.h"
#include "app/scene/coarsen.h"
#include "app/setup/seed_scene.h"
#include "app/support/text.h"
#include "sim/laws/law.h"
#include "sim/seeding/sampling.h"
#include "sim/shapes/solid.h"

namespace neve::app::health {

namespace {

/// Allowed ratio of the rate to the carried rate: spheres and cones are not equally wide
/// everywhere.
constexpr double max_packing = 1.3;

/// kg/s that fall out of a shape in which snow is born at rest, at most at packed density; 0
/// without gravity. With the same rate everywhere, momentum asks for v^2 = g y / 1.5 at a depth y
/// and for the density rate / V sqrt(1.5 y / g).
double falling_rate(const sim::seeding::Emitter& emitter, const sim::Material& material,
                    const sim::Vec3d& gravity) {
  const double g = gravity.norm();
  if (!(g > 0)) return 0;
  const sim::shapes::Solid solid(emitter.shape);
  return density_at_birth(emitter, material) * solid.volume() *
         std::sqrt(g / (1.5 * solid.extent(gravity)));
}

void check_opening(const scene::Scene& scene, const sim::seeding::Emitter& emitter, double end,
                   double coarsening, std::vector<Finding>& findings) {
  const sim::Material& material = scene.materials[setup::material_index(scene, emitter.material)];
  const std::string at = "emitter." + emitter.name;
  const double h = scene.solver.cell_size;
  const double spacing = sim::seeding::particle_spacing(emitter.particles_per_cell, h);
  const double thick = thickness(emitter.shape);
  if (thick < spacing)
    findings.push_back(
        {Severity::warning, at + ".shape",
         fmt::format("{} is {} m thick, thinner than the {} m between particles: the snow comes "
                     "out in single particles",
                     emitter.name, rough_text(thick), rough_text(spacing)),
         "make it thicker, or " +
             scene::setting_text("solver.cell_size", 0.25 * thick / spacing * h, coarsening)});
  if (emitter.rate == 0) return;
  const double carried = sim::seeding::carried_rate(emitter, material);
  const double falling = falling_rate(emitter, material, scene.solver.gravity);
  if (carried > 0 && emitter.rate > max_packing * std::max(carried, falling))
    findings.push_back(
        {Severity::warning, at + ".rate",
         fmt::format("its velocity carries away only about {} kg/s at the density of "
                     "{}; the rest finds no room",
                     rough_text(carried), material.name),
         "lower the rate, or make the velocity or the shape larger"});
  const double last = std::min(end, emitter.end.value_or(end));
  const double mass = emitter.rate * (last - emitter.start);
  const double of_one = density_at_birth(emitter, material) * spacing * spacing * spacing;
  if (mass > 0 && sim::seeding::count_emitted(emitter, material, h, end) == 0)
    findings.push_back(
        {Severity::warning, at + ".rate",
         fmt::format("no snow comes: it emits {} kg, and a particle has {} kg", rough_text(mass),
                     rough_text(of_one)),
         fmt::format(
             "a rate of {} kg/s, a longer time, or smaller particles ({})",
             rough_text(emitter.rate * of_one / mass),
             scene::setting_text("solver.cell_size", h * std::cbrt(mass / of_one), coarsening))});
  const bool is_filled =
      mass > density_at_birth(emitter, material) * sim::shapes::volume(emitter.shape);
  if (carried == 0 && is_filled && emitter.rate > max_packing * falling)
    findings.push_back(
        {Severity::warning, at + ".rate",
         fmt::format("new snow is at rest: {}; the rest finds no room",
                     falling > 0
                         ? fmt::format("about {} kg/s fall out of the emitter", rough_text(falling))
                         : "gravity does not move it away"),
         "give it a velocity, a lower rate or a larger shape"});
}

}  // namespace

std::string remedy_for_clogging(const scene::Scene& scene, const std::string& emitter) {
  const std::string usual = "a lower rate, a higher velocity or a wider way out";
  for (const sim::seeding::Emitter& e : scene.emitters) {
    if (e.name != emitter || e.J_P > 1) continue;
    const sim::Material& material = scene.materials[setup::material_index(scene, e.material)];
    // Packed snow sticks together and stands in its own way.
    if (sim::laws::of(material).is_snow)
      return fmt::format("loose snow (emitter.{}.J_P = 1.5), {}", emitter, usual);
  }
  return usual;
}

void check_emitters(const scene::Scene& scene, std::vector<Finding>& findings, double coarsening) {
  const double end = scene::duration(scene);
  for (const sim::seeding::Emitter& emitter : scene.emitters) {
    if (emitter.start >= end && end > 0)
      findings.push_back({Severity::warning, "emitter." + emitter.name + ".start",
                          fmt::format("{} opens at {} s, the scene ends at {} s",
                                      display_name("emitter", emitter.name),
                                      rough_text(emitter.start), rough_text(end)),
                          "make start earlier, or frames larger"});
    else
      check_opening(scene, emitter, end, coarsening, findings);
  }
}

void check_sinks(const scene::Scene& scene, double speed, std::vector<Finding>& findings) {
  const sim::SolverSettings& s = scene.solver;
  // Snow is looked for when the fastest has gone a cell, and the step that does it ends beyond.
  const double step = s.time_step == sim::TimeStep::fixed
                          ? speed * s.dt
                          : std::min(speed * s.max_dt, s.cfl * s.cell_size);
  const double way = s.cell_size + step;
  for (const sim::seeding::Sink& sink : scene.sinks) {
    if (sink.outside) continue;
    const double thick = thickness(sink.shape);
    if (thick >= way) continue;
    findings.push_back(
        {Severity::warning, "sink." + sink.name + ".shape",
         fmt::format("{} is {} m thick; snow at {} m/s moves up to {} m between two "
                     "tests of the sink: some will fly through",
                     sink.name, rough_text(thick), rough_text(speed), rough_text(way)),
         "make it thicker than that"});
  }
}

}  // namespace neve::app::health
