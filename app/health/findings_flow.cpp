/// Findings about emitters and sinks before a run.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "app/health/findings.h"
#include "app/scene/coarsen.h"
#include "app/setup/curves.h"
#include "app/setup/seed_scene.h"
#include "app/support/text.h"
#include "sim/laws/law.h"
#include "sim/seeding/sampling.h"
#include "sim/shapes/solid.h"

namespace neve::app::health {

namespace {

/// kg/s, of sim::seeding, at the moment when gravity, which may follow a curve, carries away most.
double largest_natural_rate(const scene::Scene& scene, const sim::seeding::Emitter& emitter) {
  const sim::Material& material = scene.materials[setup::material_index(scene, emitter.material)];
  return setup::largest_at_moments(scene, [&](const scene::Scene& then) {
    return natural_rate(emitter, material, then.solver.gravity);
  });
}

/// Finds what withholds snow in spite of all room; nothing where the rate is not too large.
std::optional<std::string> rate_problem(const scene::Scene& scene,
                                        const sim::seeding::Emitter& emitter) {
  const sim::Material& material = scene.materials[setup::material_index(scene, emitter.material)];
  const double natural = largest_natural_rate(scene, emitter);
  if (!sim::seeding::exceeds(emitter.rate, natural)) return std::nullopt;
  if (natural == 0)
    return "new snow is at rest, and gravity does not move it away: it fills the emitter once";
  const bool falls = natural > natural_rate(emitter, material, sim::Vec3d::Zero());
  return fmt::format("{} only about {} kg/s at {}",
                     emitter.velocity.isZero(0) ? "new snow is at rest, and gravity carries away"
                     : falls                    ? "gravity carries away"
                                                : "its velocity carries away",
                     rough_text(natural),
                     emitter.J_P == 1 ? "the density of " + material.name
                                      : rough_text(density_at_birth(emitter, material)) + " kg/m3");
}

const sim::seeding::Emitter* find_emitter(const scene::Scene& scene, const std::string& name) {
  for (const sim::seeding::Emitter& emitter : scene.emitters)
    if (emitter.name == name) return &emitter;
  return nullptr;
}

constexpr const char* remedy_for_rate = "lower the rate, or make the velocity or the shape larger";

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
  const double natural = largest_natural_rate(scene, emitter);
  const double carried = natural > 0 ? natural * (last - emitter.start)
                                     : density_at_birth(emitter, material) * volume(emitter.shape);
  if (mass < carried + of_one) return;
  if (const auto problem = rate_problem(scene, emitter))
    findings.push_back(
        {Severity::warning, at + ".rate", *problem + "; the rest finds no room", remedy_for_rate});
}

}  // namespace

std::optional<Clogging> clogging(const scene::Scene& scene, const std::string& emitter,
                                 double share) {
  const sim::seeding::Emitter* e = find_emitter(scene, emitter);
  if (!e) return std::nullopt;
  const sim::Material& material = scene.materials[setup::material_index(scene, e->material)];
  const double natural = largest_natural_rate(scene, *e);
  constexpr double notable = 0.02;
  if (const auto problem = rate_problem(scene, *e);
      problem && share < 1 - natural / e->rate + notable)
    return Clogging{true, *problem, remedy_for_rate};
  // Packed snow sticks together and stands in its own way.
  const bool is_packed = e->J_P == 1 && sim::laws::of(material).is_snow;
  return Clogging{false, "snow fills the emitter",
                  (is_packed ? fmt::format("use loose snow (emitter.{}.J_P = 1.5), ", emitter)
                             : std::string("use ")) +
                      "a lower rate, a higher velocity or a wider way out"};
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
