#include "sim/health/diagnostics.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/health/limits.h"
#include "sim/laws/stretches.h"
#include "sim/types/number_text.h"

namespace neve::sim::health {

namespace {

/// Degree to which a particle breaks the rule; larger is worse.
double badness(const std::string& rule, const ParticleArrays& p, std::size_t id,
               const std::vector<Material>& materials) {
  constexpr double worst = std::numeric_limits<double>::infinity();
  const bool is_finite = p.x[id].allFinite() && p.v[id].allFinite() && p.F_E[id].allFinite() &&
                         std::isfinite(p.J_P[id]);
  if (!is_finite) return worst;
  if (rule == "J_P" || rule == "packed") return -p.J_P[id];
  if (rule == "inverted") return -p.F_E[id].determinant();
  if (rule == "acoustic_cfl" || rule == "time_step")
    return p.V0[id] > 0
               ? wave_speed(p.material_of(id, materials), p.F_E[id], p.J_P[id], p.m[id] / p.V0[id])
               : 0;
  return p.v[id].norm();
}

/// Description of the event, without advice.
std::string what(const Divergence& d, double acoustic_cfl) {
  std::string text =
      "diverged at step " + std::to_string(d.step) + " (t = " + number_text(d.time) + " s): ";
  const std::string who = d.particle < 0 ? "a particle" : "particle " + std::to_string(d.particle);
  if (d.rule == "not_finite")
    text += "the state of " + who + " is not finite";
  else if (d.rule == "overflow")
    text += who + " left the lattice at " + number_text(d.v.norm()) + " m/s";
  else if (d.rule == "speed_cfl")
    text += who + " crossed " + number_text(d.value) + " cells in one step at " +
            number_text(d.v.norm()) + " m/s";
  else if (d.rule == "inverted")
    text += "the elastic deformation of " + who + " turned inside out";
  else if (d.rule == "J_P")
    text +=
        "J_P of " + who + " fell to " + number_text(d.value) + ", below " + number_text(d.limit);
  else if (d.rule == "packed")
    text += number_text(100 * d.value) +
            " % of the snow is packed to J_P = " + number_text(limits_of(Law::compaction).stop) +
            ", a tenth of its volume";
  else if (d.rule == "acoustic_cfl")
    text += "sound crossed " + number_text(d.value) + " cells in one step at " + who;
  else if (d.rule == "time_step")
    text += "the time step collapsed to " + number_text(d.value) + " s at the hardening of " + who;
  else
    text += "energy rose to " + number_text(d.value) + " J, " + number_text(d.limit) +
            " J can be explained";
  if (d.rule != "acoustic_cfl" && acoustic_cfl > limits_of(Law::acoustic_cfl).mention)
    text += "; acoustic CFL was " + number_text(acoustic_cfl);
  return text;
}

}  // namespace

double hardening_factor(const Material& material, double J_P) {
  return laws::of(material).hardens ? laws::hardening_factor(material, J_P) : 1;
}

double energy_density(const Material& material, const Mat3d& F_E, double J_P) {
  return laws::of(material).energy_density(material, F_E, J_P);
}

std::array<double, 4> energy_densities(const std::array<const Material*, 4>& materials,
                                       const std::array<Mat3d, 4>& F_E,
                                       const std::array<double, 4>& J_P) {
  const auto energies = laws::of(*materials[0]).energies;
  const auto has_same = [&](const Material* m) { return laws::of(*m).energies == energies; };
  if (energies && std::all_of(materials.begin(), materials.end(), has_same))
    return energies(materials, F_E, J_P);
  std::array<double, 4> out;
  for (std::size_t l = 0; l < 4; ++l) out[l] = energy_density(*materials[l], F_E[l], J_P[l]);
  return out;
}

Mat3d first_piola(const Material& material, const Mat3d& F_E, double J_P) {
  return laws::of(material).first_piola(material, F_E, J_P);
}

laws::ElasticResponse elastic_response(const Material& material, const Mat3d& F_E, double J_P) {
  if (const auto both = laws::of(material).response) return both(material, F_E, J_P);
  return {energy_density(material, F_E, J_P), first_piola(material, F_E, J_P)};
}

double wave_speed(const Material& material, const Mat3d& F_E, double J_P, double rho0) {
  return std::sqrt(laws::of(material).wave_modulus(material, F_E, J_P) / rho0);
}

double consolidation_pressure(const Material& material, double J_P) {
  const auto pressure = laws::of(material).consolidation_pressure;
  return pressure ? pressure(material, J_P) : 0;
}

double nearness_to_yield(const Material& material, const Mat3d& F_E, double J_P) {
  const auto nearness = laws::of(material).nearness_to_yield;
  return nearness ? nearness(material, F_E, J_P) : 0;
}

void find_culprits(const ParticleArrays& particles, const SolverSettings& settings,
                   const std::vector<Material>& materials, Divergence& d) {
  constexpr std::size_t most = 1000;
  const std::size_t count = particles.x.size();
  std::vector<double> bad(count);
  for (std::size_t id = 0; id < count; ++id) bad[id] = badness(d.rule, particles, id, materials);
  std::vector<std::uint32_t> ids(count);
  std::iota(ids.begin(), ids.end(), 0u);
  const std::size_t kept = std::min(count, most);
  std::partial_sort(
      ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(kept), ids.end(),
      [&](std::uint32_t a, std::uint32_t b) { return bad[a] != bad[b] ? bad[a] > bad[b] : a < b; });
  // Keeps those at least half as bad as the worst, so that there are few marks.
  if (kept > 0) {
    const std::size_t worst = ids[0];
    d.particle = particles.id_of(worst);
    d.x = particles.x[worst];
    d.v = particles.v[worst];
    d.material = particles.material[worst];
    d.F_E = particles.F_E[worst];
    d.J_E = d.F_E.determinant();
    d.J_P = particles.J_P[worst];
    const double bar = bad[worst] > 0 ? 0.5 * bad[worst] : bad[worst];
    for (std::size_t k = 0; k < kept && bad[ids[k]] >= bar; ++k)
      d.culprits.push_back(particles.id_of(ids[k]));
    const Material material = particles.material_of(worst, materials);
    if (d.F_E.allFinite()) {
      d.stretches = laws::Stretches(d.F_E).s;
      d.kirchhoff = first_piola(material, d.F_E, d.J_P) * d.F_E.transpose();
      if (particles.V0[worst] > 0)
        d.sound_speed =
            wave_speed(material, d.F_E, d.J_P, particles.m[worst] / particles.V0[worst]);
    }
  }
  d.what = what(d, d.dt * d.sound_speed / settings.cell_size);
  d.sentence = d.what;
  if (d.dt > d.dt_that_holds)
    d.sentence += ". dt = " + number_text(d.dt_that_holds) + " would have held";
}

}  // namespace neve::sim::health
