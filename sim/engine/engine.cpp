#include "sim/engine/engine.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sim/engine/dust_feed.h"
#include "sim/engine/load.h"

namespace neve::sim::engine {

namespace {

/// Halvings of a semi-implicit step: each costs the solves that were of no use.
constexpr int max_halvings = 2;
/// Explicit steps in place of one, at most.
constexpr int max_parts = 1000;

}  // namespace

template <class Real>
Engine<Real>::Engine(const SolverSettings& settings, const std::vector<Material>& materials,
                     const std::vector<shapes::Collider>& colliders,
                     const ParticleArrays& particles, int threads, const Vec3i& lattice_origin,
                     const seeding::Flow& flow)
    : state_(settings, materials, colliders, threads, lattice_origin), flow_(flow, state_.method) {
  watch_.start = load(particles, state_);
  prepare(state_, watch_.start);
  flow_.open(state_);
}

// ---- steps --------------------------------------------------------------------------------------

template <class Real>
void Engine<Real>::step(double dt) {
  take_whole_step(dt);
  run_dust(false);
}

template <class Real>
void Engine<Real>::take_whole_step(double dt) {
  take_step(dt);
  if (!divergence()) flow_.run(state_);
}

/// Dust in the air flies on, also where no snow sheds any more.
template <class Real>
bool Engine<Real>::has_dust() const {
  return wants_dust(state_.method) || !dust_.cloud().motes.empty();
}

/// Lets dust take its steps, which are longer than those of the snow. One ends with each frame.
template <class Real>
void Engine<Real>::run_dust(bool is_frame_end) {
  if (!has_dust() || divergence()) return;
  const SolverSettings& settings = state_.method.settings;
  const double time = state_.progress.time;
  const double end = state_.progress.frame.end;
  if (!is_frame_end && !dust_.is_due(time, end, settings.dust, settings.cell_size)) return;
  timed(parts_.seconds.dust, [&] { advance_dust(time, state_, dust_); });
}

template <class Real>
void Engine<Real>::take_step(double dt) {
  const Method<Real>& method = state_.method;
  solve_ = {};
  took_explicit_ = false;
  if (state_.particles.size() == 0) {
    state_.advance_time(dt);
    // Snow that has left limits no further step, as snow that has not come yet does not.
    StateLimits& limits = state_.progress.limits;
    limits.max_speed = limits.max_sound_speed = limits.max_strain_rate = 0;
    return;
  }
  if (method.takes_stages()) return take_stages(dt);
  if (method.settings.is_implicit())
    take_implicit(dt, max_halvings);
  else
    take_fused(dt, false);
}

/// Takes a semi-implicit step, or two of half the length where the solve is of no use, or explicit
/// ones in the end.
template <class Real>
void Engine<Real>::take_implicit(double dt, int halvings) {
  const bool is_taken = take_fused(dt, true);
  SolveReport solve = parts_.solver.last_solve();
  if (!is_taken) solve.residual = std::numeric_limits<double>::quiet_NaN();
  solve_.add(solve);
  if (is_taken) return;
  if (halvings > 0) {
    for (int half = 0; half < 2 && !divergence(); ++half) take_implicit(0.5 * dt, halvings - 1);
    return;
  }
  took_explicit_ = true;
  // Snow that is crushed hardens from each of them to the next. A step that would need thousands is
  // hopeless: steps that are too long break the rule of sound, which says so.
  const double least = dt / max_parts;
  for (double left = dt; left > 0 && !divergence();) {
    const double wanted = explicit_part(state_.method.settings, state_.progress.limits, left);
    const double part = std::min(left, std::max(wanted, least));
    take_fused(part, false);
    left -= part;
  }
}

/// @return false: the solve failed, nothing was changed
template <class Real>
bool Engine<Real>::take_fused(double dt, bool is_implicit) {
  if (!FusedDriver<Real>(state_, parts_, dt).step(is_implicit)) return false;
  timed(parts_.seconds.checks, [&] { check_step(dt, is_implicit); });
  return true;
}

/// Takes a step by stages, for settings that skip some, and for comparisons.
template <class Real>
void Engine<Real>::take_stages(double dt) {
  StageFields<Real> fields;
  StagedDriver<Real>(state_, parts_, fields, dt).step();
  solve_ = parts_.solver.last_solve();
  StateLimits& limits = state_.progress.limits;
  const double sound_speed = limits.max_sound_speed;
  check_step(dt, state_.method.settings.is_implicit());
  // Nothing has updated the stress; it is as it was.
  if (state_.method.settings.skips(Stage::deformation)) limits.max_sound_speed = sound_speed;
}

template <class Real>
void Engine<Real>::check_step(double dt, bool is_implicit) {
  Progress& progress = state_.progress;
  state_.grid.add_loads(state_.method.load_unit, loads_);
  const double speed_before = progress.limits.max_speed;
  const SolverSettings& settings = state_.method.settings;
  // The step feels the speed of sound less than an explicit one does, by this factor.
  const double stretch = is_implicit ? acoustic_stretch(settings) : 1;
  diverge_if(watch_.check_step(settings, dt, stretch, state_.grid.step_report(), progress));
  ++progress.steps_since_sink_check;
  progress.distance_since_sink_check += dt * std::max(speed_before, progress.limits.max_speed);
  if (progress.steps % HealthWatch::steps_between_sums == 0) check_sums();
}

template <class Real>
void Engine<Real>::check_sums() {
  const SolverSettings& settings = state_.method.settings;
  if (divergence() || state_.particles.size() == 0 || !settings.bypass.empty()) return;
  diverge_if(watch_.check_sums(settings, summary(), state_.progress));
}

template <class Real>
void Engine<Real>::diverge_if(const std::optional<BrokenRule>& broken) {
  if (!broken) return;
  const Method<Real>& method = state_.method;
  if (HealthWatch::may_ignore(*broken, method.settings, state_.progress)) return;
  watch_.diverge(*broken, state_.progress, method.settings, method.materials, particles());
}

template <class Real>
DtChoice Engine<Real>::choose_dt(double remaining) const {
  const Progress& progress = state_.progress;
  return sim::choose_dt(state_.method.settings, progress.limits, remaining, progress.dt_scale,
                        progress.frame.done);
}

template <class Real>
StepLimits Engine<Real>::step_limits() const {
  const StateLimits& limits = state_.progress.limits;
  return {limits_on_dt(state_.method.settings, limits), limits.max_speed, limits.max_sound_speed,
          limits.max_strain_rate, limits.max_collider_speed};
}

// ---- frames -------------------------------------------------------------------------------------

template <class Real>
AdvanceReport Engine<Real>::advance_to(double time, const StepObserver& after_step,
                                       std::size_t last_step) {
  AdvanceReport report;
  loads_.clear();
  Progress& progress = state_.progress;
  FrameProgress& frame = progress.frame;
  if (!(frame.end == time && progress.time == frame.start + frame.done))
    frame = {progress.time, 0, time};
  // Counting from the start of the frame keeps the end of the frame exact.
  const double whole = frame.end - frame.start;
  while (frame.done < whole && !divergence() && progress.steps < last_step) {
    advance_frame(choose_dt(whole - frame.done), report);
    if (after_step && after_step()) break;
  }
  report.loads = loads_;
  if (frame.done >= whole) {
    progress.time = time;
    check_sums();
  }
  return report;
}

/// One step of the frame that advance_to is in.
template <class Real>
void Engine<Real>::advance_frame(const DtChoice& choice, AdvanceReport& report) {
  const SolverSettings& settings = state_.method.settings;
  Progress& progress = state_.progress;
  FrameProgress& frame = progress.frame;
  const double whole = frame.end - frame.start;
  const std::uint64_t steps_before = progress.steps;
  watch_.set_limit(choice.limit);
  take_whole_step(choice.dt);
  frame.done += choice.dt;
  const bool is_last = choice.limit == DtLimit::frame_end && !(frame.done < whole * (1 - 1e-12));
  if (is_last) frame.done = whole;
  progress.time = frame.start + frame.done;
  run_dust(is_last);

  if (settings.is_implicit()) {
    if (!report.solve) report.solve.emplace();
    report.solve->add(last_solve());
  }
  // Shorter steps may have taken the place of one.
  const std::uint64_t steps = progress.steps - steps_before;
  const double dt = steps > 1 ? progress.last_dt : choice.dt;
  report.dt_min = report.steps == 0 ? dt : std::min(report.dt_min, dt);
  report.dt_max = std::max(report.dt_max, dt);
  const DtLimit limit = took_explicit_ ? explicit_limit(settings, progress.limits) : choice.limit;
  report.ruled[static_cast<std::size_t>(limit)] += steps;
  report.steps += steps;
  report.seconds += choice.dt;
}

// ---- changes ------------------------------------------------------------------------------------

template <class Real>
void Engine<Real>::apply(const SolverSettings& settings, const std::vector<Material>& materials,
                         const std::vector<shapes::Collider>& colliders) {
  if (divergence())
    throw std::logic_error(
        "this run has diverged: reset it, or go back to an earlier frame, for the change to take "
        "effect");
  const bool had_dust = has_dust();
  engine::apply(settings, materials, colliders, state_);
  if (!had_dust) dust_.start_at(state_.progress.time);
  dust_.forget_solids();
}

template <class Real>
std::vector<std::uint8_t> Engine<Real>::save() const {
  return joined(engine::save(state_, flow_), has_dust() || dust_.cloud().totals.born > 0
                                                 ? dust_.save()
                                                 : std::vector<std::uint8_t>());
}

template <class Real>
void Engine<Real>::restore(std::span<const std::uint8_t> bytes) {
  const SplitState parts = split(bytes);
  dust::Dust dust;
  if (!parts.dust.empty()) dust.restore(parts.dust);
  engine::restore(parts.snow, state_, flow_);
  watch_.forget();
  if (parts.dust.empty()) dust.start_at(state_.progress.time);
  dust_ = std::move(dust);
}

// ---- queries ------------------------------------------------------------------------------------

template <class Real>
std::uint64_t Engine<Real>::memory_bytes() const {
  return state_.colliders.memory_bytes() + state_.particles.memory_bytes() +
         state_.grid.memory_bytes() + dust_.memory_bytes() + parts_.contact.memory_bytes() +
         parts_.solver.memory_bytes();
}

template <class Real>
Summary Engine<Real>::summary() const {
  Summary summary = StateReader<Real>(state_).summary();
  summary.dust = dust_.cloud().totals;
  return summary;
}

template class Engine<float>;
template class Engine<double>;

}  // namespace neve::sim::engine
