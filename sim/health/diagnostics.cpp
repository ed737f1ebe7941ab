#include "sim/health/diagnostics.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/health/cam_clay.h"
#include "sim/health/limits.h"
#include "sim/health/sand.h"
#include "sim/kernels/constitutive.h"
#include "sim/types/number_text.h"

namespace neve::sim::health {

namespace {

struct Principal {
  Mat3d U, V;
  Vec3d s;
};

Principal decompose(const Mat3d& F) {
  double rows[9];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) rows[3 * a + b] = F(a, b);
  const kernels::SignedSvd<double> svd = kernels::signed_svd(rows);
  Principal p;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      p.U(a, b) = svd.U[3 * a + b];
      p.V(a, b) = svd.V[3 * a + b];
    }
    p.s[a] = svd.s[a];
  }
  return p;
}

Lame hardened(const Material& m, double J_P) {
  Lame l = lame(m.youngs_modulus, m.poisson_ratio);
  const double factor = hardening_factor(m, J_P);
  return {l.mu * factor, l.lambda * factor};
}

/// @param s the stretches of F_E
double corotated_energy(const Lame& l, const Vec3d& s) {
  const double J = s.prod();
  return l.mu * (s.array() - 1).square().sum() + 0.5 * l.lambda * (J - 1) * (J - 1);
}

Mat3d corotated_piola(const Lame& l, const Mat3d& F_E, const Principal& p) {
  const double J = p.s.prod();
  // J F^-T by cross products of columns: also right where F is singular.
  Mat3d cofactor;
  cofactor.col(0) = F_E.col(1).cross(F_E.col(2));
  cofactor.col(1) = F_E.col(2).cross(F_E.col(0));
  cofactor.col(2) = F_E.col(0).cross(F_E.col(1));
  return 2 * l.mu * (F_E - p.U * p.V.transpose()) + l.lambda * (J - 1) * cofactor;
}

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

/// Whether the energy is one of stretches alone, which one decomposition gives.
bool takes_stretches(const Material& material) {
  return material.model == Model::snow || material.model == Model::corotated;
}

}  // namespace

double hardening_factor(const Material& material, double J_P) {
  if (!hardens(material.model)) return 1;
  return std::clamp(std::exp(material.hardening * (1 - J_P)), kernels::min_hardening,
                    material.max_hardening);
}

double energy_density(const Material& material, const Mat3d& F_E, double J_P) {
  if (material.model == Model::cam_clay) return cam_clay::energy_density(material, F_E);
  if (material.model == Model::sand) return sand::energy_density(material, F_E);
  const Lame l = hardened(material, J_P);
  if (material.model == Model::neo_hookean) {
    const double J = F_E.determinant();
    if (!(J > 0)) return std::numeric_limits<double>::infinity();
    const double log_J = std::log(J);
    return 0.5 * l.mu * (F_E.squaredNorm() - 3) - l.mu * log_J + 0.5 * l.lambda * log_J * log_J;
  }
  return corotated_energy(l, decompose(F_E).s);
}

std::array<double, 4> energy_densities(const std::array<const Material*, 4>& materials,
                                       const std::array<Mat3d, 4>& F_E,
                                       const std::array<double, 4>& J_P) {
  std::array<double, 4> out;
  if (std::none_of(materials.begin(), materials.end(),
                   [](const Material* m) { return takes_stretches(*m); })) {
    for (std::size_t l = 0; l < 4; ++l) out[l] = energy_density(*materials[l], F_E[l], J_P[l]);
    return out;
  }
  Quad<double> rows[9];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (std::size_t l = 0; l < 4; ++l) rows[3 * a + b][l] = F_E[l](a, b);
  const kernels::SignedSvd<Quad<double>> svd = kernels::signed_svd_lanes(rows);
  for (std::size_t l = 0; l < 4; ++l)
    out[l] = !takes_stretches(*materials[l])
                 ? energy_density(*materials[l], F_E[l], J_P[l])
                 : corotated_energy(hardened(*materials[l], J_P[l]),
                                    Vec3d(svd.s[0][l], svd.s[1][l], svd.s[2][l]));
  return out;
}

Mat3d first_piola(const Material& material, const Mat3d& F_E, double J_P) {
  if (material.model == Model::cam_clay) return cam_clay::first_piola(material, F_E);
  if (material.model == Model::sand) return sand::first_piola(material, F_E);
  const Lame l = hardened(material, J_P);
  if (material.model == Model::neo_hookean) {
    const Mat3d inverse_transposed = F_E.inverse().transpose();
    return l.mu * (F_E - inverse_transposed) +
           l.lambda * std::log(F_E.determinant()) * inverse_transposed;
  }
  return corotated_piola(l, F_E, decompose(F_E));
}

ElasticResponse elastic_response(const Material& material, const Mat3d& F_E, double J_P) {
  if (!takes_stretches(material))
    return {energy_density(material, F_E, J_P), first_piola(material, F_E, J_P)};
  const Lame l = hardened(material, J_P);
  const Principal p = decompose(F_E);
  return {corotated_energy(l, p.s), corotated_piola(l, F_E, p)};
}

double wave_speed(const Material& material, const Mat3d& F_E, double J_P, double rho0) {
  if (material.model == Model::cam_clay)
    return std::sqrt(cam_clay::wave_modulus(material, F_E) / rho0);
  if (material.model == Model::sand) return std::sqrt(sand::wave_modulus(material, F_E) / rho0);
  const Lame l = hardened(material, J_P);
  const double stretch = F_E.jacobiSvd().singularValues()[0], J = F_E.determinant();
  return std::sqrt((2 * l.mu * stretch * stretch + l.lambda * J * J) / rho0);
}

double consolidation_pressure(const Material& material, double J_P) {
  return material.model == Model::cam_clay ? cam_clay::p0(material, J_P) : 0;
}

double nearness_to_yield(const Material& material, const Mat3d& F_E, double J_P) {
  if (material.model == Model::cam_clay) return cam_clay::nearness_to_yield(material, F_E, J_P);
  if (material.model == Model::sand) return sand::nearness_to_yield(material, F_E);
  if (material.model != Model::snow) return 0;
  const Vec3d s = decompose(F_E).s;
  constexpr double least = 1e-9;
  return std::max((s.maxCoeff() - 1) / std::max(material.critical_stretch, least),
                  (1 - s.minCoeff()) / std::max(material.critical_compression, least));
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
      d.stretches = decompose(d.F_E).s;
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
