#include "app/forecast/forecast.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "app/scene/coarsen.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/curves.h"
#include "app/setup/seed_scene.h"
#include "app/setup/snow_pieces.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "sim/health/diagnostics.h"
#include "sim/laws/law.h"
#include "sim/shapes/variation.h"

namespace neve::app::forecast {

namespace {

/// Step and limit of a scene, or of a copy with other cells, in a state of the coarse copy.
sim::DtChoice allowed(const scene::Scene& scene, const sim::StepLimits& state,
                      double cell_of_state) {
  sim::StateLimits limits;
  limits.max_speed = state.max_speed;
  limits.max_sound_speed = state.max_sound_speed;
  // The same difference of velocity over smaller cells.
  limits.max_strain_rate = state.max_strain_rate * cell_of_state / scene.solver.cell_size;
  for (const sim::Material& m : scene.materials)
    sim::laws::include_hardening(m, limits, sim::shapes::max_factor(m.variation.youngs_modulus));
  return sim::choose_dt(scene.solver, limits, 1e9);
}

double hardening_of(const sim::Material& m, double J_P) {
  return sim::laws::of(m).is_snow ? sim::health::hardening_factor(m, J_P) : 1;
}

/// The stiffest of many particles beside the stiffest of a copy: how much faster sound is in it.
struct Rarity {
  double expected = 1, most = 1;  ///< factors; most: exceeded by one run in 20
  double fastest = 0;             ///< m/s, in a crushed particle: no factor leads beyond
};

/// The largest of n draws with an exponential tail of scale b grows as b ln n, and its 95th
/// percentile lies 2.97 b higher (Gumbel). The tail of the logarithm of the speed of sound is that
/// of the stiffest ten particles: packed layers have none, and fragments that hit edges have one.
Rarity rarity_of(const scene::Scene& coarse, const sim::ParticleArrays& state, double particles) {
  constexpr std::size_t tail = 10, enough = 100;
  constexpr double percentile = 2.97;
  if (state.x.size() < enough) return {};
  std::vector<double> speeds;  // logarithms
  double fastest = 0;
  for (std::size_t p = 0; p < state.x.size(); ++p) {
    const sim::Material& m = coarse.materials[static_cast<std::size_t>(state.material[p])];
    const double share = state.V0[p] * m.density / state.m[p];
    const double hardening = hardening_of(m, state.J_P[p]);
    speeds.push_back(std::log(sim::sound_speed(m) * std::sqrt(share * hardening)));
    fastest = std::max(fastest, sim::sound_speed(m) * std::sqrt(crushed_hardening(m)));
  }
  std::nth_element(speeds.begin(), speeds.begin() + tail, speeds.end(), std::greater<>());
  const double scale =
      std::accumulate(speeds.begin(), speeds.begin() + tail, 0.0) / tail - speeds[tail];
  const double more = std::log(std::max(1.0, particles / static_cast<double>(state.x.size())));
  if (!std::isfinite(scale)) return {};
  return {std::exp(scale * more), std::exp(scale * (more + percentile)), fastest};
}

sim::StepLimits stiffer(sim::StepLimits state, double factor, double fastest) {
  const double now = state.max_sound_speed;
  state.max_sound_speed = std::max(now, std::min(factor * now, fastest));
  return state;
}

/// The steps of a frame at the scene's resolution: those that the coarse copy took, in proportion
/// to what both may take in the worst state that the copy had at the frame's ends. That state alone
/// says little of the frame: it may last a single step.
FrameForecast foresee_frame(const scene::Scene& scene, const scene::Scene& coarse, int frame,
                            const sim::StepLimits& worst, const sim::AdvanceReport& ran,
                            const Rarity& rarity) {
  // A frame that the copy does in a step or two does not tell how long these might have been.
  constexpr std::size_t telling = 3;
  const double duration = 1 / scene.fps, cell = coarse.solver.cell_size;
  const sim::DtChoice own = allowed(scene, stiffer(worst, rarity.expected, rarity.fastest), cell);
  FrameForecast forecast;
  forecast.frame = frame;
  forecast.dt = own.dt;
  forecast.steps = std::max(1.0, std::ceil(duration / own.dt));
  forecast.limit = own.limit;
  if (ran.steps >= telling) {
    const double ratio = allowed(coarse, worst, cell).dt / own.dt;
    forecast.steps = std::ceil(static_cast<double>(ran.steps) * ratio);
    forecast.dt = duration / forecast.steps;
    if (ran.limit() != sim::DtLimit::frame_end) forecast.limit = ran.limit();
  }
  // They grow as the time of a step over that of sound through a cell.
  if (ran.solve && ran.steps > 0)
    forecast.iterations = static_cast<double>(ran.solve->all_iterations) /
                          static_cast<double>(ran.steps) * cell / scene.solver.cell_size;
  forecast.min_steps = forecast.steps * own.dt / allowed(scene, worst, cell).dt;
  forecast.max_steps = forecast.steps * own.dt /
                       allowed(scene, stiffer(worst, rarity.most, rarity.fastest), cell).dt;
  if (forecast.steps == 1) forecast.limit = sim::DtLimit::frame_end;
  return forecast;
}

/// A copy of the scene that runs in a moment; the largest factor that leaves every body something.
/// @param wanted  particles of the copy
std::optional<scene::Scene> coarse_copy(const scene::Scene& scene, double particles,
                                        double wanted) {
  double factor = std::max(1.0, std::cbrt(particles / wanted));
  while (true) {
    scene::Scene copy = scene::without_dust(scene);
    try {
      scene::coarsen(copy, factor);
      // Forecasts were measured with thresholds that hold in any cell.
      copy.solver.threshold_cell = scene.solver.threshold_cell;
      return copy;
    } catch (const UsageError&) {
      if (factor == 1) return std::nullopt;
      factor = std::max(1.0, 0.7 * factor);
    }
  }
}

sim::StepLimits worst_of(const sim::StepLimits& before, sim::StepLimits after) {
  after.max_speed = std::max(after.max_speed, before.max_speed);
  after.max_sound_speed = std::max(after.max_sound_speed, before.max_sound_speed);
  after.max_strain_rate = std::max(after.max_strain_rate, before.max_strain_rate);
  return after;
}

/// Emitters that snow blocks in the coarse copy.
std::vector<Withheld> withheld_by(const scene::Scene& coarse, const sim::Simulation& copy) {
  constexpr double notable = 0.02;
  std::vector<Withheld> list;
  const std::vector<std::uint64_t> withheld = copy.withheld();
  for (std::size_t k = 0; k < withheld.size(); ++k) {
    const sim::seeding::Emitter& emitter = coarse.emitters[k];
    const sim::Material& material =
        coarse.materials[setup::material_index(coarse, emitter.material)];
    const auto all = static_cast<double>(
        sim::seeding::count_emitted(emitter, material, coarse.solver.cell_size, copy.time()));
    const double share = static_cast<double>(withheld[k]) / std::max(1.0, all);
    if (share >= notable) list.push_back({emitter.name, share, copy.time()});
  }
  return list;
}

/// Counts the steps that a copy took in explicit ones of packed snow.
double packed_work(const sim::AdvanceReport& report, const Spread& spread) {
  const auto steps = static_cast<double>(report.steps);
  const double iterations =
      report.solve ? static_cast<double>(report.solve->all_iterations) / std::max(1.0, steps) : 0;
  return steps * explicit_steps(iterations) * cost_of_step(spread);
}

/// Advances a copy to a time, or as far as it may. The solves of one frame may take longer than all
/// that the work allows, so its cost is looked at on the way.
template <class IsLate, class IsDear>
sim::AdvanceReport advance_while_cheap(sim::Simulation& copy, double time, std::size_t last_step,
                                       const IsLate& is_late, const IsDear& is_dear) {
  constexpr std::size_t steps_at_once = 32;
  sim::AdvanceReport report;
  do {
    const std::size_t until = std::min(last_step, copy.steps() + steps_at_once);
    report.append(copy.advance_to(time, is_late, until));
  } while (copy.time() < time && copy.steps() < last_step && !copy.divergence() && !is_late() &&
           !is_dear(report));
  return report;
}

double mean_of(const std::vector<double>& values) {
  if (values.empty()) return 1;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// A coarse copy that ran.
struct CopyRun {
  Forecast forecast;
  double particle_steps = 0;
  double work = 0;  ///< particle-steps, where a step of few particles counts as one of 400
  int reached = 0;  ///< the last frame that ran
};

/// @param wanted  particles of the copy
CopyRun run_copy(const scene::Scene& scene, double particle_count, int last, double wanted,
                 const ForecastBudget& budget) {
  CopyRun run;
  Forecast& result = run.forecast;
  const std::optional<scene::Scene> coarse = coarse_copy(scene, particle_count, wanted);
  if (!coarse) return run;
  const sim::ParticleArrays particles = setup::seed_scene(*coarse).particles;
  result.particles =
      static_cast<double>(particles.x.size()) + setup::planned_emission(*coarse, last / scene.fps);
  scene::Scene now = setup::with_curves(scene, 0), coarse_now = setup::with_curves(*coarse, 0);
  sim::Simulation simulation = setup::make_simulation(coarse_now, particles, 1);
  result.spread = spread_of(simulation, coarse->solver);
  const auto start = Clock::now();
  FrameForecast frame_forecast =
      foresee_frame(now, coarse_now, 1, simulation.step_limits(), {}, {});
  // A step with few particles that lie far apart, or meet meshes, costs far more than they do.
  constexpr double min_work_of_step = 400, max_steps_of_frame = 1e15;
  double seconds = 0, packed_steps = 0;
  bool is_over = false;
  const auto is_late = [&] { return is_interrupted() || seconds_since(start) >= budget.seconds; };
  for (int frame = 1; frame <= last; ++frame) {
    // The frame's start and end both count; where time runs out the last frames are as the one
    // before.
    if (!is_over && run.work < budget.particle_steps && !is_late()) {
      if (!scene.curves.empty()) {
        now = setup::with_curves(scene, frame);
        coarse_now = setup::with_curves(*coarse, frame);
        simulation.apply(coarse_now.solver, coarse_now.materials, scene::sim_colliders(coarse_now));
      }
      const double work_of_step =
          std::max(min_work_of_step, static_cast<double>(simulation.particle_count()));
      const sim::StepLimits before = simulation.step_limits();
      const auto before_frame = Clock::now();
      // A frame alone may take more steps than there is time for: its beginning then tells them.
      const auto last_step =
          simulation.steps() + static_cast<std::size_t>(2 * budget.particle_steps / work_of_step);
      const double from = simulation.time(), to = frame / scene.fps;
      const auto is_dear = [&](const sim::AdvanceReport& so_far) {
        return budget.work < ForecastBudget{}.work &&
               packed_steps + packed_work(so_far, spread_of(simulation, coarse->solver)) >
                   budget.work;
      };
      sim::AdvanceReport report = advance_while_cheap(simulation, to, last_step, is_late, is_dear);
      seconds += seconds_since(before_frame);
      result.peak_force = std::max(result.peak_force, report.max_force());
      run.work += static_cast<double>(report.steps) * work_of_step;
      run.particle_steps +=
          static_cast<double>(report.steps) * static_cast<double>(simulation.particle_count());
      if (simulation.divergence()) break;  // a broken state foretells nothing
      is_over = simulation.steps() >= last_step || is_dear(report) || is_late();
      if (is_over && simulation.time() > from)
        report.steps = static_cast<std::size_t>(
            std::min(max_steps_of_frame,
                     static_cast<double>(report.steps) * (to - from) / (simulation.time() - from)));
      const sim::ParticleArrays state = simulation.particles();
      frame_forecast =
          foresee_frame(now, coarse_now, frame, worst_of(before, simulation.step_limits()), report,
                        rarity_of(coarse_now, state, particle_count));
      result.mean_J_P = mean_of(state.J_P);
      frame_forecast.spread = spread_of(simulation, coarse->solver);
      run.reached = frame;
    }
    frame_forecast.frame = frame;
    result.frames.push_back(frame_forecast);
    packed_steps += frame_forecast.steps * explicit_steps(frame_forecast.iterations) *
                    cost_of_step(frame_forecast.spread);
    is_over = is_over || packed_steps > budget.work;
  }
  result.withheld = withheld_by(*coarse, simulation);
  const std::string copy = "a copy with cells of " + fixed_text(coarse->solver.cell_size, 3) + " m";
  if (simulation.divergence())
    result.divergence = copy + " diverges: " + simulation.divergence()->what;
  else if (const sim::Warnings& warnings = simulation.warnings(); warnings.rules_ignored > 0)
    result.ignored =
        fmt::format("{} breaks the rule {} in step {} and continues", copy,
                    sim::stop_rules.at(warnings.first_ignored_rule), warnings.first_ignored);
  if (run.particle_steps > 0) result.seconds_per_particle_step = seconds / run.particle_steps;
  return run;
}

/// Frames that the finer copy did not reach take as many times the steps that the first copy took
/// as the last ones that it reached.
void extend(Forecast& fine, int reached, const Forecast& first) {
  constexpr int telling = 3;  // frames
  double own = 0, others = 0;
  for (int frame = std::max(1, reached - telling + 1); frame <= reached; ++frame) {
    own += fine.frames[static_cast<std::size_t>(frame - 1)].steps;
    others += first.frames[static_cast<std::size_t>(frame - 1)].steps;
  }
  for (std::size_t k = static_cast<std::size_t>(reached); k < fine.frames.size(); ++k) {
    FrameForecast& frame = fine.frames[k];
    const double duration = frame.dt * frame.steps, before = frame.steps;
    frame.steps = std::ceil(first.frames[k].steps * own / others);
    frame.min_steps *= frame.steps / before;
    frame.max_steps *= frame.steps / before;
    frame.dt = duration / frame.steps;
  }
}

}  // namespace

double crushed_hardening(const sim::Material& material) {
  constexpr double crushed_J_P = 0.5;
  return hardening_of(material, crushed_J_P);
}

Forecast foresee(const scene::Scene& scene, double particle_count, int last,
                 const ForecastBudget& budget) {
  CopyRun first = run_copy(scene, particle_count, last, budget.particles, budget);
  const double coarse = first.forecast.particles;
  if (first.reached < last || first.particle_steps <= 0) return first.forecast;
  // Steps grow as one over the cell size, that is with the cube root of the particles, and with the
  // hardening that the first copy does not show.
  constexpr double hardening = 2.5, worth_it = 1.5;
  const double finer =
      std::pow(budget.fine_particle_steps / (hardening * first.particle_steps), 3.0 / 4);
  const double particles = std::min(particle_count, finer * coarse);
  if (particles < worth_it * coarse) return first.forecast;
  ForecastBudget fine = budget;
  fine.particle_steps = budget.fine_particle_steps;
  CopyRun second = run_copy(scene, particle_count, last, particles, fine);
  if (second.reached == 0 || is_interrupted() || !second.forecast.divergence.empty()) {
    first.forecast.divergence = second.forecast.divergence;
    return first.forecast;
  }
  extend(second.forecast, second.reached, first.forecast);
  return second.forecast;
}

namespace {

/// Steps of the shipped scenes over those that are foretold with the particles of the copy, and
/// with unlucky ones, lie within: docs/reports/speed.md has them.
constexpr double min_of_steps = 0.5, max_of_steps = 2;
/// Time of a step over that at the start, beyond the copy's spread: 0.7 to 2.0 on seven scenes.
/// Torn snow fills more of the grid and of the caches.
constexpr double dearest_step = 2;

/// Sums a number over the frames after one, to the last; those that the copy did not reach are as
/// its last one.
template <class Number>
double sum_of(const std::vector<FrameForecast>& frames, int after, int last, const Number& number) {
  double sum = 0;
  for (const FrameForecast& frame : frames)
    if (frame.frame > after && frame.frame <= last) sum += number(frame);
  const int reached = frames.empty() ? last : std::max(after, frames.back().frame);
  return last > reached ? sum + (last - reached) * number(frames.back()) : sum;
}

int last_of(const std::vector<FrameForecast>& frames) {
  return frames.empty() ? 0 : frames.back().frame;
}

/// Weighs steps with what each costs. @param weight  of a step of a frame, without its spread
template <class Weight>
Cost weighed(const Forecast& forecast, int after, int last, const Weight& weight) {
  const Cost steps = forecast.steps();
  const auto sum = [&](double FrameForecast::*cost) {
    return sum_of(forecast.frames, after, last, [&](const FrameForecast& frame) {
      return frame.steps * weight(frame) * frame.*cost;
    });
  };
  const double expected = sum(&FrameForecast::cost), least = min_of_steps, most = max_of_steps;
  const bool has_steps = steps.expected > 0;
  return {expected, (has_steps ? steps.least / steps.expected : least) * expected,
          dearest_step * (has_steps ? steps.most / steps.expected : most) *
              sum(&FrameForecast::max_cost)};
}

}  // namespace

double explicit_steps(double iterations) {
  // Time of an iteration over that of an explicit step: measured 0.21 to 0.22, in snowball_drop and
  // in press at --coarsen 2.
  constexpr double work_of_iteration = 0.25;
  return 1 + work_of_iteration * iterations;
}

Cost Forecast::steps() const {
  const auto sum = [&](double FrameForecast::*number) {
    return sum_of(frames, 0, last_of(frames),
                  [&](const FrameForecast& frame) { return frame.*number; });
  };
  return {sum(&FrameForecast::steps), min_of_steps * sum(&FrameForecast::min_steps),
          std::max(max_of_steps * sum(&FrameForecast::max_steps), crushed_steps)};
}

Cost Forecast::steps_of_start() const {
  return weighed(*this, 0, last_of(frames), [](const FrameForecast&) { return 1.0; });
}

Cost Forecast::work(int after, int last) const {
  return weighed(*this, after, last,
                 [](const FrameForecast& frame) { return explicit_steps(frame.iterations); });
}

void Forecast::count_in_packed_steps() {
  for (FrameForecast& frame : frames) frame.cost = frame.max_cost = cost_of_step(frame.spread);
}

void Forecast::include_spread(const Spread& start) {
  if (start.blocks <= 0 || spread.blocks <= 0) return;
  const double more = start.blocks / spread.blocks, first = cost_of_step(start);
  for (FrameForecast& frame : frames) {
    const Spread together{std::min(1.0, more * frame.spread.blocks), frame.spread.alone};
    frame.cost = cost_of_step(together) / first;
    frame.max_cost = std::max(frame.cost, cost_of_step(frame.spread) / first);
  }
}

double work_at_rest(const scene::Scene& scene, const setup::Plan& plan) {
  // Snow that is packed conducts sound about three times as fast as at rest.
  constexpr double packed = 3;
  sim::StateLimits limits;
  limits.max_speed = setup::largest_speed(scene);
  for (const sim::Material& material : scene.materials)
    limits.max_sound_speed = std::max(limits.max_sound_speed, packed * sim::sound_speed(material));
  const double dt = sim::choose_dt(scene.solver, limits, 1e9).dt;
  // The start of a run costs as much as some steps of few particles.
  constexpr double start = 1e5;
  // A solve takes about as long as some explicit steps.
  const double step = scene.solver.is_implicit() ? 8 : 1;
  return start + step * plan.particles * std::ceil(plan.frames.last / scene.fps / dt);
}

}  // namespace neve::app::forecast
