#pragma once
/// The limits on dt, and which one rules.

#include <array>

#include "sim/types/material.h"
#include "sim/types/particle_arrays.h"
#include "sim/types/reports.h"
#include "sim/types/settings.h"

namespace neve::sim {

/// Extremes of a state that limit the next step.
struct StateLimits {
  double max_speed = 0;           ///< m/s
  double max_sound_speed = 0;     ///< m/s, of the stiffest particle, hardened
  double max_strain_rate = 0;     ///< 1/s, largest |entry| of grad v
  double max_xi = 0;              ///< largest hardening coefficient of the materials in use
  double max_hardened_speed = 0;  ///< m/s, of sound where max_hardening ends hardening
  double max_collider_speed = 0;  ///< m/s, of colliders that snow may meet in the next step
};

/// dt of the next step and the limit that rules it. `remaining` is the time to the end of the
/// frame; the last two steps before it share what is left, so that none is tiny. `scale` is a
/// factor of the step, not of the limits. `done` is the time since the start of the frame, as the
/// sum of its steps, which is rounded.
/// Check: TimeStep.FixedStepsOfALongFrameEndWithoutASliver
DtChoice choose_dt(const SolverSettings& settings, const StateLimits& limits, double remaining,
                   double scale = 1, double done = 0);

/// dt that each limit allows, infinite for those that no state has (fixed, frame_end).
std::array<double, dt_limit_count> limits_on_dt(const SolverSettings& settings,
                                                const StateLimits& limits);

/// The largest dt that speed and sound allow now, whatever the settings say about fixed steps.
double stable_dt(const SolverSettings& settings, const StateLimits& limits);

/// The next of the explicit steps that take the place of a semi-implicit one, of which dt is left.
double explicit_part(const SolverSettings& settings, const StateLimits& limits, double dt);

/// The limit that rules those.
DtLimit explicit_limit(const SolverSettings& settings, const StateLimits& limits);

/// Largest stable dt over that of explicit steps: 1 / sqrt(1 - 2 beta) below beta = 1/2, infinite
/// from there on. A mode of frequency w becomes v' = (v - dt w^2 x) / (1 + beta dt^2 w^2),
/// x' = x + dt v'; its eigenvalues stay in the unit circle while dt^2 w^2 (1 - 2 beta) <= 4.
double acoustic_stretch(const SolverSettings& settings);

/// alpha of a step of dt: flip_ratio^(dt / flip_reference_dt), or flip_ratio itself.
double flip_share(const SolverSettings& settings, double dt);

}  // namespace neve::sim
