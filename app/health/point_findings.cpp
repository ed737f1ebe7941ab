#include "app/health/point_findings.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>

#include "app/health/findings.h"
#include "app/scene/coarsen.h"
#include "app/scene/toml/value.h"
#include "app/support/text.h"
#include "sim/laws/law.h"
#include "sim/laws/threshold_cell.h"

namespace neve::app::health {

using scene::toml::number_text;
using sim::health::Law;

bool is_from_points(const sim::seeding::Body& body) {
  return std::holds_alternative<sim::shapes::Points>(body.shape.form);
}

double particles_in_cell(const sim::seeding::Body& body, double cell_size) {
  if (!is_from_points(body)) return body.particles_per_cell;
  const sim::seeding::SeedingPlan plan = sim::seeding::plan_seeding(body, cell_size);
  return static_cast<double>(plan.particle_count) * std::pow(cell_size, 3) / plan.volume;
}

void check_point_distance(const sim::seeding::Body& body, double cell_size, double coarsening,
                          std::vector<Finding>& findings) {
  const double per_cell = particles_in_cell(body, cell_size);
  const bool is_too_few = per_cell < sim::health::limits_of(Law::particles_per_cell).check_warning;
  if (!is_too_few && per_cell <= max_useful_per_cell) return;
  const std::string eight =
      scene::setting_text("solver.cell_size", cell_size * std::cbrt(8 / per_cell), coarsening);
  // --coarsen thins further, by the growth of a cell.
  const double thinning = std::get<sim::shapes::Points>(body.shape.form).thinning * per_cell / 8 /
                          std::pow(coarsening, 3);
  findings.push_back(
      {is_too_few ? Severity::warning : Severity::note, "body." + body.name + ".shape.points",
       "the points of " + display_name("body", body.name) + " are " + rough_text(per_cell) +
           " in a cell, from their volumes" +
           (is_too_few ? ": they leave gaps, and snow breaks at them"
                       : ": more than the grid resolves"),
       eight + " has 8" + (is_too_few ? "" : ", or thinning = " + rough_text(thinning))});
}

namespace {

/// Fewer have too few neighbours to go by.
constexpr std::size_t fewest_points = 27;

/// kg/m3, the mean over the particles of what the others weigh in their cell: 0 where each is
/// alone.
double density_where_they_lie(const sim::ParticleArrays& particles, std::size_t first,
                              std::size_t end, double h) {
  std::map<std::array<double, 3>, double> cells;
  double mass = 0, weighted = 0, alone = 0;
  for (std::size_t p = first; p < end; ++p) {
    const sim::Vec3d& x = particles.x[p];
    cells[{std::floor(x.x() / h), std::floor(x.y() / h), std::floor(x.z() / h)}] += particles.m[p];
    mass += particles.m[p];
    alone += particles.m[p] * particles.m[p];
  }
  for (const auto& [cell, in_cell] : cells) weighted += in_cell * in_cell;
  return (weighted - alone) / mass / (h * h * h);
}

/// Checks the J_P of points as check_range_of_packing() checks a number in the scene.
void check_packing_of_points(const scene::Scene& scene, const sim::seeding::Body& body,
                             std::span<const double> J_P, std::vector<Finding>& findings) {
  const sim::Material& m = scene.materials[setup::material_index(scene, body.material)];
  if (!sim::laws::of(m).is_plastic) return;
  const double least = sim::laws::of(m).is_granular ? 1 : m.min_J_P;
  const auto [low, high] = std::ranges::minmax(J_P);
  const bool is_loose = high > m.max_J_P;
  if (!is_loose && !(low < least)) return;
  const auto outside = std::ranges::count_if(
      J_P, [&](double value) { return is_loose ? value > m.max_J_P : value < least; });
  const std::string end = number_text(is_loose ? m.max_J_P : least),
                    key = fmt::format("material.{}.{}", m.name, is_loose ? "max_J_P" : "min_J_P");
  findings.push_back(
      {Severity::warning, "body." + body.name + ".shape.points",
       fmt::format("{} of {} points have a J_P {} {}, as {} as {}: {} makes it {} where it first "
                   "yields, without a load that moved it there",
                   outside, J_P.size(), is_loose ? "above" : "below", end,
                   is_loose ? "large" : "small", rough_text(is_loose ? high : low), m.name, end),
       is_loose || !sim::laws::of(m).is_granular
           ? fmt::format("{} = {}", key, number_text(is_loose ? high : low))
           : "grains are never packed: give them a J_P of 1"});
}

/// Checks the factors of points, which have the limits of material.variation in a scene.
void check_thresholds_of_points(const scene::Scene& scene, const sim::seeding::Body& body,
                                std::span<const double> threshold, std::vector<Finding>& findings) {
  const sim::Material m = sim::laws::in_cells(
      scene.materials[setup::material_index(scene, body.material)], scene.solver);
  if (!sim::laws::of(m).reads(&sim::Material::critical_compression)) return;
  const double largest = std::ranges::max(threshold);
  if (m.critical_compression * largest < 1) return;
  findings.push_back(
      {Severity::warning, "body." + body.name + ".shape.points",
       fmt::format("{} of {} points never yield in compression: their threshold, up to {}, times "
                   "critical_compression, {}, is 1 or more, and snow is not compressed to nothing",
                   std::ranges::count_if(threshold,
                                         [&](double t) { return m.critical_compression * t >= 1; }),
                   threshold.size(), rough_text(largest), rough_text(m.critical_compression)),
       "give a file without the column threshold, or the material that the points were exported "
       "with"});
}

/// Points that weigh where they lie something else than their material says: masses, volumes and
/// positions are not of the same units.
void check_density_of_points(const scene::Scene& scene, const sim::seeding::Body& body,
                             const sim::ParticleArrays& particles, std::size_t begin,
                             std::size_t end, std::vector<Finding>& findings) {
  if (end - begin < fewest_points) return;
  // Large enough for some points: what one of them weighs itself is left out.
  const double h = scene.solver.cell_size;
  const double edge = h * std::max(1.0, std::cbrt(8 / particles_in_cell(body, h)));
  const double found = density_where_they_lie(particles, begin, end, edge);
  const double wanted = scene.materials[setup::material_index(scene, body.material)].density;
  // Thin bodies fill a part of their cells; a tenth is a mistake of units.
  if (found < 2.5 * wanted && found > 0.1 * wanted) return;
  const std::string points = "the points of " + display_name("body", body.name);
  const std::string of_material =
      " kg/m3; material " + body.material + " has " + rough_text(wanted);
  findings.push_back(
      {Severity::warning, "body." + body.name + ".shape.points",
       found < wanted
           ? points + " are too far apart: their density is " + rough_text(found) + of_material
           : points + " have a density of " + rough_text(found) + of_material,
       "positions are in m, masses in kg, volumes in m3; spacing is the distance between "
       "neighbours in m"});
}

}  // namespace

void check_points(const scene::Scene& scene, const setup::SeededScene& seeded,
                  std::vector<Finding>& findings) {
  for (std::size_t k = 0; k < seeded.body_end.size(); ++k) {
    const sim::seeding::Body& body = scene.bodies[k];
    const std::size_t begin = seeded.body_begin(k), end = seeded.body_end[k];
    if (!is_from_points(body) || begin == end) continue;
    check_density_of_points(scene, body, seeded.particles, begin, end, findings);
    if (const std::span<const double> J_P = seeded.particles.J_P; !J_P.empty())
      check_packing_of_points(scene, body, J_P.subspan(begin, end - begin), findings);
    if (const std::span<const double> threshold = seeded.particles.threshold; !threshold.empty())
      check_thresholds_of_points(scene, body, threshold.subspan(begin, end - begin), findings);
  }
}

}  // namespace neve::app::health
