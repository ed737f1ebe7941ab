#include "app/health/softness.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "app/setup/auto_ranges.h"
#include "app/setup/seed_scene.h"
#include "app/support/round_number.h"
#include "app/support/text.h"
#include "sim/health/diagnostics.h"
#include "sim/health/limits.h"
#include "sim/laws/law.h"
#include "sim/laws/threshold_cell.h"

namespace neve::app::health {

double stiffness_that_holds(const sim::Material& written, const sim::SolverSettings& settings,
                            double J_P, double speed) {
  const sim::Material material = sim::laws::in_cells(written, settings);
  constexpr double kept = 0.25, focus = 3, min_threshold = 0.005;
  if (const auto largest_pressure = sim::laws::of(material).largest_pressure) {
    const double shock = focus * material.density * speed * speed / (1 - kept);
    const double per_E = largest_pressure(material) / material.youngs_modulus;
    return round_up(std::max(2 * material.youngs_modulus, shock / per_E));
  }
  sim::Material unit = material;
  unit.youngs_modulus = 1;
  const double s = 1 - std::max(min_threshold, material.critical_compression), J = kept * s;
  const sim::Mat3d F_E = sim::Vec3d(1, s, 1).asDiagonal();
  const double pressure_per_E = -sim::health::first_piola(unit, F_E, kept)(1, 1) * s / J;
  const double shock = focus * material.density * speed * speed / (1 - J);
  // J_P of a state that is no number says nothing.
  const double from = J_P > 0 ? std::min(J_P, kept) : kept;
  const double packed = sim::health::hardening_factor(material, from) / from;
  const double wanted = sim::health::hardening_factor(material, kept) / kept;
  return round_up(std::max(material.youngs_modulus * packed / wanted, shock / pressure_per_E));
}

namespace {

/// Returns the material of the densest snow now; of the first snow where none is left.
const sim::Material& densest_material(const scene::Scene& scene,
                                      const sim::ParticleArrays& particles) {
  const sim::Material* densest = nullptr;
  for (const sim::Material& m : scene.materials)
    if (!densest && sim::laws::of(m).is_snow) densest = &m;
  double highest = 0;
  for (std::size_t p = 0; p < particles.J_P.size(); ++p) {
    const auto number = p < particles.material.size() ? particles.material[p] : 0;
    const sim::Material& m = scene.materials[static_cast<std::size_t>(number)];
    const double density = m.density / particles.J_P[p];
    if (!sim::laws::of(m).is_snow || !(density > highest)) continue;
    highest = density;
    densest = &m;
  }
  return densest ? *densest : scene.materials.front();
}

/// kg/m3, at rest
double densest_snow(const scene::Scene& scene) {
  double density = 0;
  for (const sim::Material& m : scene.materials)
    if (sim::laws::of(m).is_snow) density = std::max(density, m.density);
  return density;
}

}  // namespace

std::optional<DenseBirth> dense_birth(const scene::Scene& scene) {
  std::optional<DenseBirth> densest;
  const auto look_at = [&](const char* kind, const auto& list) {
    for (const auto& one : list) {
      const std::size_t number = setup::material_index(scene, one.material);
      const sim::Material& m = scene.materials[number];
      const double density = m.density / one.J_P;
      if (!sim::laws::of(m).is_snow || !(one.J_P < 1) || !(density > sim::ice_density)) continue;
      if (densest && density <= densest->density) continue;
      densest = {std::string(kind) + "." + one.name + ".J_P", one.J_P, density,
                 std::ceil(1e3 * m.density / sim::ice_density) / 1e3, number};
    }
  };
  look_at("body", scene.bodies);
  look_at("emitter", scene.emitters);
  return densest;
}

std::string evidence_text(const DenseBirth& birth) {
  return fmt::format("{} = {} packs snow to {} kg/m3 before it moves, denser than ice ({} kg/m3)",
                     birth.address, rough_text(birth.J_P), rough_text(birth.density),
                     rough_text(sim::ice_density));
}

std::string advice_text(const DenseBirth& birth) {
  return birth.J_P_of_ice < 1 ? fmt::format("{} = 1, snow that is not packed, or {} at least",
                                            birth.address, rough_text(birth.J_P_of_ice))
                              : birth.address + " = 1, snow that is not packed";
}

double load_speed(const scene::Scene& scene) {
  double speed = setup::impact_speed(scene);
  for (const scene::Collider& collider : scene.colliders)
    speed = std::max(speed, setup::collider_speed(scene, collider.name));
  return speed;
}

std::optional<std::string> softness_warning(const scene::Scene& scene,
                                            const sim::Simulation& simulation) {
  // A particle in a thousand, squeezed at an edge, is no matter.
  constexpr double notable = 1e-3;
  const double J_P = simulation.warnings().least_J_P;
  if (simulation.divergence()) return std::nullopt;
  const bool is_packed = J_P <= sim::health::packed_J_P;
  if (!is_packed && J_P * sim::ice_density > densest_snow(scene)) return std::nullopt;
  const double dense = is_packed ? 0 : simulation.summary().denser_than_ice;
  if (!is_packed && dense < notable) return std::nullopt;
  if (const auto birth = dense_birth(scene))
    return evidence_text(*birth) + "; try " + advice_text(*birth);
  const sim::Material& snow = densest_material(scene, simulation.particles());
  const double speed = load_speed(scene);
  if (!is_packed && snow.density >= sim::ice_density)
    return fmt::format(
        "{} % of the snow is denser than ice ({} kg/m3): material.{}.density = {:.6g} kg/m3 "
        "is, without any impact; try a smaller one",
        rough_text(100 * dense), rough_text(sim::ice_density), snow.name, snow.density);
  if (!is_packed)
    return fmt::format(
        "{} % of the snow was packed denser than ice ({} kg/m3): it is too soft for its impact at "
        "{} m/s; try a larger material.{}.youngs_modulus, or min_J_P = {}, where it yields without "
        "packing further",
        rough_text(100 * dense), rough_text(sim::ice_density), rough_text(speed), snow.name,
        rough_text(std::ceil(1e3 * snow.density / sim::ice_density) / 1e3));
  return fmt::format(
      "snow was packed to J_P = {}, {} kg/m3, and yielded without hardening further: it is too "
      "soft for its impact at {} m/s; try material.{}.youngs_modulus = {}",
      rough_text(J_P), rough_text(snow.density / J_P), rough_text(speed), snow.name,
      rough_text(stiffness_that_holds(snow, scene.solver, J_P, speed)));
}

}  // namespace neve::app::health
