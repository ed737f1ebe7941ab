#include "sim/checks/watch.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/checks/places.h"
#include "sim/health/diagnostics.h"
#include "sim/health/shock.h"
#include "sim/laws/law.h"
#include "sim/staged.h"
#include "sim/types/number_text.h"
#include "sim/types/time_step.h"

namespace neve::sim::checks {

namespace {

using health::never;

double share(double a, double b) {
  return b > 0 ? a / b : 0;
}

bool is_finite(const ParticleArrays& p, std::size_t q) {
  return p.x[q].allFinite() && p.v[q].allFinite() && p.F_E[q].allFinite() &&
         std::isfinite(p.J_P[q]) && std::isfinite(p.V0[q]);
}

Vec3d centre_of_mass(const ParticleArrays& p) {
  Vec3d sum(0, 0, 0);
  double mass = 0;
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    sum += p.m[q] * p.x[q];
    mass += p.m[q];
  }
  return sum / mass;
}

/// The state of the particles.
void measure_particles(const ParticleArrays& p, const std::vector<Material>& materials,
                       WatchValues& out) {
  double min_J_E = never, min_J_P = never, max_J_P = 0;
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    if (!is_finite(p, q)) {
      ++out[WatchCheck::not_finite];
      continue;
    }
    const Material material = p.material_of(q, materials);
    min_J_E = std::min(min_J_E, p.F_E[q].determinant());
    min_J_P = std::min(min_J_P, p.J_P[q]);
    max_J_P = std::max(max_J_P, p.J_P[q]);
    const double hardening = health::hardening_factor(material, p.J_P[q]);
    out[WatchCheck::hardening] = std::max(out[WatchCheck::hardening], hardening);
    // Torn snow has hardly any stiffness left; what counts is the sound in packed snow.
    const double c = sound_speed(material) * std::sqrt(std::max(1.0, hardening));
    out[WatchCheck::mach] = std::max(out[WatchCheck::mach], share(p.v[q].norm(), c));
  }
  out[WatchCheck::inverted] = min_J_E;
  out[WatchCheck::compaction] = min_J_P;
  out[WatchCheck::dilation] = max_J_P;
}

/// Sums over nodes and particles that must agree.
void measure_sums(const SolverSettings& settings, const ParticleArrays& p, const Vec3d& centre,
                  const StagedStep& step, double dt, WatchValues& out) {
  const NodeFields& n = step.nodes;
  double node_mass = 0, node_size = 0, sum_f = 0, sum_turn = 0, newton = 0, newton_size = 0;
  Vec3d f(0, 0, 0), turn(0, 0, 0), before(0, 0, 0), after(0, 0, 0);
  for (std::size_t i = 0; i < n.mass.size(); ++i) {
    const double m = n.mass[i];
    const Vec3d arm = n.node[i].cast<double>() * settings.cell_size - centre;
    const Vec3d impulse = dt * (n.force[i] + m * settings.gravity);
    node_mass += m;
    node_size += m * n.v_new[i].norm();
    f += n.force[i];
    sum_f += n.force[i].norm();
    turn += arm.cross(n.force[i]);
    sum_turn += arm.cross(n.force[i]).norm();
    before += m * n.v_old[i];
    after += m * n.v_new[i];
    newton += (m * (n.v_free[i] - n.v_old[i]) - impulse).norm();
    newton_size +=
        m * n.v_old[i].norm() + dt * n.force[i].norm() + dt * m * settings.gravity.norm();
  }
  double mass = 0, size = 0;
  Vec3d momentum(0, 0, 0), momentum_after(0, 0, 0);
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    mass += p.m[q];
    size += p.m[q] * p.v[q].norm();
    momentum += p.m[q] * p.v[q];
    momentum_after += p.m[q] * step.v_before_collision[q];
  }
  // Snow at rest: the momentum that one step of gravity gives.
  size += mass * settings.gravity.norm() * dt;
  out[WatchCheck::mass] = share(std::abs(node_mass - mass), mass);
  out[WatchCheck::p2g_momentum] = share((before - momentum).norm(), size);
  out[WatchCheck::g2p_momentum] =
      share((after - momentum_after - step.own_taken).norm(), size + node_size);
  out[WatchCheck::newton] = share(newton, newton_size);
  out[WatchCheck::force_sum] = share(f.norm(), sum_f);
  out[WatchCheck::torque] = share(turn.norm(), sum_turn);
}

/// Stress that snow which is being compressed has beyond its law: a pressure, and no larger than
/// the shock viscosity of the fastest compression. Pa, negative; 0 for others.
class ShockStress {
 public:
  ShockStress(const SolverSettings& settings, const Simulation& simulation)
      : share_(settings.shock_viscosity), h_(settings.cell_size), tau_(simulation.kirchhoff()) {
    const StepLimits limits = simulation.step_limits();
    rate_ = 3 * limits.max_strain_rate;
    c_ = limits.max_sound_speed;
  }

  double operator()(std::size_t q, const Material& m, const Mat3d& tau_of_law) const {
    if (!laws::of(m).is_plastic) return 0;
    const double largest = health::shock_pressure(share_, m.density, h_, rate_, c_);
    return std::clamp((tau_[q] - tau_of_law).trace() / 3, -largest, 0.0);
  }

 private:
  double share_, h_, rate_ = 0, c_ = 0;
  std::vector<Mat3d> tau_;
};

/// Forces, the update of F_E and the energy belong together; what the viscosity takes is lost.
void measure_work(const std::vector<Material>& materials, bool is_float, const ParticleArrays& p,
                  const StagedStep& step, const ShockStress& shock, double dt, WatchValues& out) {
  const NodeFields& n = step.nodes;
  double force_work = 0, size = 0;
  for (std::size_t i = 0; i < n.mass.size(); ++i) {
    force_work += dt * n.force[i].dot(n.v_new[i]);
    size += dt * std::abs(n.force[i].dot(n.v_new[i]));
  }
  double stress_work = 0, trial_work = 0, lost = 0, energy = 0, stresses = 0;
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    const Material material = p.material_of(q, materials);
    const Mat3d change = step.F_E_trial[q] - p.F_E[q];
    const laws::ElasticResponse now = health::elastic_response(material, p.F_E[q], p.J_P[q]);
    const laws::ElasticResponse trial =
        health::elastic_response(material, step.F_E_trial[q], p.J_P[q]);
    stress_work += p.V0[q] * now.first_piola.cwiseProduct(change).sum();
    trial_work += p.V0[q] * trial.first_piola.cwiseProduct(change).sum();
    energy += p.V0[q] * (trial.energy_density - now.energy_density);
    const double pressure = shock(q, material, now.first_piola * p.F_E[q].transpose());
    lost += dt * p.V0[q] * pressure * step.grad_v[q].trace();
    stresses += p.V0[q] * now.first_piola.norm();
  }
  // The change of F_E is a difference of rounded numbers.
  size += 100 * stresses * (is_float ? 6e-8 : 1.1e-16);
  out[WatchCheck::power] = share(std::abs(force_work + stress_work + lost), size);
  out[WatchCheck::work] = share(std::abs(energy - 0.5 * (trial_work - force_work - lost)), size);
}

}  // namespace

bool WatchRecord::breaks(double value, double limit) const {
  // NaN breaks everything.
  if (is_below) return check == WatchCheck::inverted ? !(value > limit) : !(value >= limit);
  return !(value <= limit);
}

std::string sentence(const WatchRecord& record, double value, double dt) {
  const health::Limits& law = health::limits_of(record.check);
  std::string remedy = law.remedy;
  if (const std::size_t at = remedy.find("%dt"); at != std::string::npos)
    remedy.replace(at, 3, number_text(dt * record.threshold / value) + " s");
  return "step " + std::to_string(record.first_step) + ": " + law.quantity + " is " +
         number_text(value) + (record.is_below ? ", at least " : ", at most ") +
         number_text(record.threshold) + " is expected; " + law.meaning + "; " + remedy;
}

bool is_watch_due(std::size_t steps) {
  const bool is_power_of_two = (steps & (steps - 1)) == 0;
  return steps < watch_interval ? is_power_of_two : steps % watch_interval == 0;
}

Watch::Watch(const SolverSettings& settings, const std::vector<Material>& materials)
    : settings_(settings), materials_(materials) {
  const bool is_float = settings.precision == Precision::single;
  for (int k = 0; k < watch_check_count; ++k) {
    const health::Limits& law = health::laws[static_cast<std::size_t>(k)];
    const bool is_own = is_float && law.watch_single > 0;
    records_.push_back({law.law, law.is_below, is_own ? law.watch_single : law.watch_warning,
                        is_own && law.watch_error < never ? law.watch_single : law.watch_error});
  }
  // Steps with stages left out keep no law but those of the numbers themselves.
  if (!settings.bypass.empty())
    for (std::size_t k = static_cast<std::size_t>(WatchCheck::energy); k < records_.size(); ++k)
      records_[k].threshold = records_[k].error = never;
  if (settings.is_implicit()) {
    // A limit that no longer applies says nothing about the step; neither does a trapezoidal rule
    // over steps that are long for the stiffness, and that damp.
    const double stretch = sim::acoustic_stretch(settings);
    for (WatchRecord& record : records_) {
      if (record.check == WatchCheck::work) record.threshold = never;
      if (record.check != WatchCheck::acoustic_cfl) continue;
      record.threshold *= stretch;
      record.error *= stretch;
    }
  }
  if (settings.time_step != TimeStep::adaptive) return;
  // Adaptive steps go up to the limits that the user chose.
  const auto expect = [&](WatchCheck check, double limit) {
    double& threshold = records_[static_cast<std::size_t>(check)].threshold;
    threshold = std::max(threshold, limit * (1 + 1e-6));
  };
  expect(WatchCheck::acoustic_cfl, settings.acoustic_cfl * sim::acoustic_stretch(settings));
  expect(WatchCheck::speed_cfl, settings.cfl);
}

void Watch::use(const SolverSettings& settings, const std::vector<Material>& materials) {
  const Watch other(settings, materials);
  for (std::size_t k = 0; k < records_.size(); ++k) {
    records_[k].threshold = other.records_[k].threshold;
    records_[k].error = other.records_[k].error;
  }
  settings_ = settings;
  materials_ = materials;
}

WatchValues Watch::measure(const Simulation& simulation) const {
  WatchValues out;
  if (simulation.particle_count() == 0) {
    out[WatchCheck::inverted] = out[WatchCheck::compaction] = 1;
    return out;
  }
  const ParticleArrays p = simulation.particles();
  measure_particles(p, materials_, out);
  if (out[WatchCheck::not_finite] > 0) return out;
  const double h = settings_.cell_size;
  const double dt = simulation.choose_dt(never).dt;
  const StepLimits limits = simulation.step_limits();
  out[WatchCheck::acoustic_cfl] = limits.max_sound_speed * dt / h;
  out[WatchCheck::speed_cfl] = limits.max_speed * dt / h;
  out[WatchCheck::energy] = energy_account(simulation).ratio();
  const seeding::FlowTotals flow = simulation.flow_totals();
  const double volume = believed_volume(p, materials_, p.x.size() + flow.removed - flow.emitted);
  out[WatchCheck::places] = std::max(volume, share(1, volume));
  const StagedStep step = staged_step(simulation, dt);
  for (const Mat3d& grad_v : step.grad_v)
    out[WatchCheck::strain_step] =
        std::max(out[WatchCheck::strain_step], dt * grad_v.cwiseAbs().maxCoeff());
  measure_sums(settings_, p, centre_of_mass(p), step, dt, out);
  measure_work(materials_, settings_.precision == Precision::single, p, step,
               ShockStress(settings_, simulation), dt, out);
  return out;
}

std::vector<std::string> Watch::look(const Simulation& simulation) {
  const WatchValues values = measure(simulation);
  std::vector<std::string> sentences;
  for (WatchRecord& record : records_) {
    const double value = values[record.check];
    const bool is_worse = record.is_below ? !(value >= record.worst) : !(value <= record.worst);
    if (looks_ == 0 || is_worse) record.worst = value;
    if (!record.breaks(value, record.threshold)) continue;
    if (record.breaks(value, record.error)) ++record.errors;
    if (record.times++ > 0) continue;
    record.first_step = simulation.steps();
    record.first_time = simulation.time();
    sentences.push_back(sentence(record, value, simulation.choose_dt(never).dt));
  }
  ++looks_;
  return sentences;
}

bool Watch::has_errors() const {
  return std::any_of(records_.begin(), records_.end(),
                     [](const WatchRecord& record) { return record.errors > 0; });
}

}  // namespace neve::sim::checks
