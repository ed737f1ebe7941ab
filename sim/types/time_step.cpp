#include "sim/types/time_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace neve::sim {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

double ratio(double numerator, double denominator) {
  return denominator > 0 ? numerator / denominator : unlimited;
}

/// dt so that sound crosses acoustic_cfl cells. Snow that hits something at speed v compresses by
/// up to 0.7 v dt/h within the step (the steepest slope of the cubic weights), snow that a collider
/// hits by v dt/h (its particles move by less than a kernel). It hardens by e^(xi v dt/h), but no
/// more than its material lets it: the step is shortened until sound still crosses less than a cell
/// afterwards.
double acoustic_dt(const SolverSettings& s, const StateLimits& limits) {
  const double h = s.cell_size, stretch = acoustic_stretch(s);
  const double c = limits.max_sound_speed / stretch,
               c_hardest = limits.max_hardened_speed / stretch;
  double dt = ratio(s.acoustic_cfl * h, c);
  if (!(dt < unlimited)) return dt;
  const double v = std::max(0.7 * limits.max_speed, limits.max_collider_speed);
  for (int round = 0; round < 40; ++round) {
    const double squeeze = v * dt / h;
    const double hardened = c * std::exp(0.5 * limits.max_xi * squeeze);
    const double c_after = std::min(hardened, std::max(c, c_hardest));
    if (c_after * dt <= std::max(1.0, s.acoustic_cfl) * h) break;
    dt *= 0.8;
  }
  return dt;
}

}  // namespace

DtChoice choose_dt(const SolverSettings& s, const StateLimits& limits, double remaining,
                   double scale, double done) {
  // Rounding of the remaining time must not leave a step of 1e-18 s.
  constexpr double slack = 1 + 1e-9;
  if (s.time_step == TimeStep::fixed) {
    const double dt = s.dt * scale;
    // Equal steps are rounded the same way, each by up to half a unit in the last place of the sum.
    constexpr double most = 0.1;
    const double rounding =
        std::min(std::numeric_limits<double>::epsilon() * done * (done / dt), most * dt);
    if (remaining <= std::max(dt * slack, dt + rounding)) return {remaining, DtLimit::frame_end};
    return {dt, DtLimit::fixed};
  }
  const std::array<double, dt_limit_count> allowed = limits_on_dt(s, limits);
  const auto least = std::min_element(allowed.begin(), allowed.end());
  const DtChoice best{*least * scale, static_cast<DtLimit>(least - allowed.begin())};
  if (remaining <= best.dt * slack) return {remaining, DtLimit::frame_end};
  if (remaining < 2 * best.dt) return {0.5 * remaining, DtLimit::frame_end};
  return best;
}

std::array<double, dt_limit_count> limits_on_dt(const SolverSettings& s,
                                                const StateLimits& limits) {
  std::array<double, dt_limit_count> dt;
  dt.fill(unlimited);
  const auto of = [&](DtLimit limit) -> double& { return dt[static_cast<std::size_t>(limit)]; };
  of(DtLimit::max_dt) = s.max_dt;
  of(DtLimit::cfl) = ratio(s.cfl * s.cell_size, limits.max_speed);
  of(DtLimit::collider) = ratio(s.cfl * s.cell_size, limits.max_collider_speed);
  of(DtLimit::acoustic) = acoustic_dt(s, limits);
  of(DtLimit::strain) = ratio(s.strain_limit, limits.max_strain_rate);
  return dt;
}

double stable_dt(const SolverSettings& s, const StateLimits& limits) {
  const double speed = std::max(limits.max_speed, limits.max_collider_speed);
  return std::min(ratio(s.cfl * s.cell_size, speed), acoustic_dt(s, limits));
}

double explicit_part(const SolverSettings& s, const StateLimits& limits, double dt) {
  SolverSettings settings = s;
  settings.beta = 0;
  return dt / std::max(1.0, std::ceil(dt / stable_dt(settings, limits)));
}

DtLimit explicit_limit(const SolverSettings& s, const StateLimits& limits) {
  SolverSettings settings = s;
  settings.beta = 0;
  settings.time_step = TimeStep::adaptive;
  return choose_dt(settings, limits, unlimited).limit;
}

double acoustic_stretch(const SolverSettings& s) {
  if (!s.is_implicit()) return 1;
  return s.beta < 0.5 ? 1 / std::sqrt(1 - 2 * s.beta) : unlimited;
}

double flip_share(const SolverSettings& s, double dt) {
  if (s.flip_reference_dt <= 0) return s.flip_ratio;
  return std::pow(s.flip_ratio, dt / s.flip_reference_dt);
}

}  // namespace neve::sim
