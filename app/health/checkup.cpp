#include "app/health/checkup.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "app/health/findings.h"
#include "app/scene/coarsen.h"
#include "app/scene/toml/error.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/seed_scene.h"
#include "app/setup/snow_pieces.h"
#include "app/support/clock.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "sim/health/diagnostics.h"

namespace neve::app::health {

namespace {

/// Two copies of about a second each. The time matters only where a machine is busy or snow is
/// spread out, so that a forecast is the same every time.
constexpr ForecastBudget coarse_budget{8, 3e7, 1500, 3e7};
/// Time of an iteration of the solve over that of an explicit step: measured 0.21 to 0.22, in
/// snowball_drop and in press at --coarsen 2.
constexpr double work_of_iteration = 0.25;
constexpr double calibration_seconds = 1;
constexpr int calibration_steps = 40;
/// Above this many particles seeding alone takes too long for a look.
constexpr double max_seeded = 3e6;

/// Steps of the shipped scenes over those that are foretold with the particles of the copy, and
/// with unlucky ones, lie within: docs/performance.md has them.
constexpr double least_of_steps = 0.5, most_of_steps = 2;
/// Time of a step over that at the start, beyond the copy's spread: 0.7 to 2.0 on seven scenes.
/// Torn snow fills more of the grid and of the caches.
constexpr double dearest_step = 2;

/// Cost of a block over that of a packed particle, measured with about a particle to a block:
/// blocks without neighbours take no room on the grid (neve bench sim: spray_lattice), the others
/// do, and cost 40 with quadratic weights and 90 with cubic ones.
constexpr double cost_alone = 3, cost_on_grid = 60;

using Block = std::array<int, 3>;

bool is_alone(const Block& block, const std::set<Block>& blocks) {
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k)
        if ((i || j || k) && blocks.contains({block[0] + i, block[1] + j, block[2] + k}))
          return false;
  return true;
}

Spread spread_of(const sim::Simulation& simulation) {
  std::set<Block> blocks;
  const std::vector<sim::Vec3i> cells = simulation.cells();
  for (const sim::Vec3i& cell : cells) blocks.insert({cell[0] >> 2, cell[1] >> 2, cell[2] >> 2});
  if (cells.empty()) return {};
  const auto alone = std::count_if(blocks.begin(), blocks.end(),
                                   [&](const Block& block) { return is_alone(block, blocks); });
  return {static_cast<double>(blocks.size()) / static_cast<double>(cells.size()),
          static_cast<double>(alone) / static_cast<double>(blocks.size())};
}

double cost_of_step(const Spread& spread) {
  return 1 + spread.blocks * (cost_on_grid + spread.alone * (cost_alone - cost_on_grid));
}

/// The median of some steps, after two that warm caches up.
/// @param solve  the worst of them
double measure_step(sim::Simulation& simulation, double frame, sim::SolveReport& solve) {
  std::vector<double> seconds;
  const auto start = Clock::now();
  for (int k = 0; k < calibration_steps && seconds_since(start) < calibration_seconds; ++k) {
    const auto before = Clock::now();
    simulation.step(simulation.choose_dt(frame).dt);
    solve.add(simulation.last_solve());
    if (k >= 2) seconds.push_back(seconds_since(before));
    if (simulation.divergence() || is_interrupted()) break;
  }
  if (seconds.empty()) return 0;
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

/// Step and limit of a scene, or of a copy with other cells, in a state of the coarse copy.
sim::DtChoice allowed(const scene::Scene& scene, const sim::StepLimits& state,
                      double cell_of_state) {
  sim::engine::StateLimits limits;
  limits.max_speed = state.max_speed;
  limits.max_sound_speed = state.max_sound_speed;
  // The same difference of velocity over smaller cells.
  limits.max_strain_rate = state.max_strain_rate * cell_of_state / scene.solver.cell_size;
  for (const sim::Material& m : scene.materials) sim::engine::include_hardening(m, limits);
  return sim::engine::choose_dt(scene.solver, limits, 1e9);
}

/// An impact at this share of the speed of sound may crush single particles to about half of their
/// volume. Which ones is chance, and no copy tells it: a ball of dry snow that hits a post at 0.39
/// takes 61 000 steps with one seed and 8000 with another.
constexpr double crushing_speed = 0.3, crushed_J_P = 0.5;

/// How much faster sound is in the stiffest of many particles than in the stiffest of a copy.
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
    const auto hardening_at = [&](double J_P) {
      return m.model == sim::Model::snow ? sim::health::hardening_factor(m, J_P) : 1;
    };
    const double share = state.V0[p] * m.density / state.m[p];
    speeds.push_back(std::log(sim::sound_speed(m) * std::sqrt(share * hardening_at(state.J_P[p]))));
    fastest = std::max(fastest, sim::sound_speed(m) * std::sqrt(hardening_at(crushed_J_P)));
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
  FrameForecast forecast{frame, own.dt, std::max(1.0, std::ceil(duration / own.dt)),
                         0,     0,      own.limit};
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
  forecast.least_steps = forecast.steps * own.dt / allowed(scene, worst, cell).dt;
  forecast.most_steps = forecast.steps * own.dt /
                        allowed(scene, stiffer(worst, rarity.most, rarity.fastest), cell).dt;
  if (forecast.steps == 1) forecast.limit = sim::DtLimit::frame_end;
  return forecast;
}

/// Step of the first emitted snow, for a scene that starts empty.
sim::DtChoice first_emission(const scene::Scene& scene, sim::StepLimits& start) {
  sim::engine::StateLimits limits;
  for (const setup::SnowPiece& piece : setup::snow_places(scene)) {
    limits.max_speed = std::max(limits.max_speed, piece.velocity.norm());
    limits.max_sound_speed = std::max(limits.max_sound_speed, sim::sound_speed(*piece.material));
    sim::engine::include_hardening(*piece.material, limits);
  }
  start = {sim::engine::limits_on_dt(scene.solver, limits), limits.max_speed,
           limits.max_sound_speed, 0};
  return sim::engine::choose_dt(scene.solver, limits, 1 / scene.fps);
}

/// A copy of the scene that runs in a moment; the largest factor that leaves every body something.
/// @param wanted  particles of the copy
std::optional<scene::Scene> coarse_copy(const scene::Scene& scene, double particles,
                                        double wanted) {
  double factor = std::max(1.0, std::cbrt(particles / wanted));
  while (true) {
    scene::Scene copy = scene;
    try {
      scene::coarsen(copy, factor);
      return copy;
    } catch (const scene::toml::UsageError&) {
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

/// Reports emitters that snow blocks in the coarse copy.
void check_withheld(const scene::Scene& coarse, const sim::Simulation& copy,
                    std::vector<Finding>& findings) {
  const std::vector<std::uint64_t> withheld = copy.withheld();
  for (std::size_t k = 0; k < withheld.size(); ++k) {
    const sim::seeding::Emitter& emitter = coarse.emitters[k];
    const sim::Material& material =
        coarse.materials[setup::material_index(coarse, emitter.material)];
    const auto all = static_cast<double>(
        sim::seeding::count_emitted(emitter, material, coarse.solver.cell_size, copy.time()));
    const double share = static_cast<double>(withheld[k]) / std::max(1.0, all);
    if (share < 0.02) continue;
    findings.push_back(
        {Severity::warning, "emitter." + emitter.name + ".rate",
         fmt::format("in a coarse copy {} % of its snow finds no room until {} s, because snow "
                     "fills the emitter",
                     rough_text(100 * share), rough_text(copy.time())),
         "make rate lower, velocity higher or the way out wider; run.json counts it as withheld"});
  }
}

/// A collider that moves towards another squeezes the snow between them: a single particle of a
/// tumbling drum went to J_P = 0.45 within a second and multiplied the steps by seven.
bool squeezes_snow(const scene::Scene& scene) {
  const auto is_moving = [](const sim::shapes::Collider& collider) {
    return collider.velocity != sim::Vec3d::Zero() ||
           collider.angular_velocity != sim::Vec3d::Zero() || !collider.keyframes.empty();
  };
  return scene.colliders.size() > 1 &&
         std::any_of(scene.colliders.begin(), scene.colliders.end(), is_moving);
}

std::string crushing_text(const scene::Scene& scene, const Checkup& checkup) {
  const double share = checkup.impact_speed / checkup.start.max_sound_speed;
  if (share >= crushing_speed)
    return fmt::format(
        "the impact at {} m/s is {} of the speed of sound in the snow and may crush "
        "single particles; one that flies on",
        rough_text(checkup.impact_speed), rough_text(share));
  if (squeezes_snow(scene))
    return "snow that is squeezed between colliders may crush single particles; one that lives on";
  return {};
}

/// Hardened, a particle rules the steps of all for as long as it flies.
void check_crushing(const scene::Scene& scene, Checkup& checkup) {
  const sim::SolverSettings& solver = scene.solver;
  if (solver.time_step == sim::TimeStep::fixed || solver.is_implicit()) return;
  const std::string text = crushing_text(scene, checkup);
  if (text.empty()) return;
  const sim::Material* hardest = nullptr;
  double most = 1;
  for (const sim::Material& m : scene.materials) {
    const double hardening = std::min(std::exp(m.hardening * (1 - crushed_J_P)), m.max_hardening);
    if (m.model != sim::Model::snow || hardening <= most) continue;
    most = hardening;
    hardest = &m;
  }
  const double c = checkup.start.max_sound_speed * std::sqrt(most);
  const double steps = scene.frames / scene.fps * c / (solver.acoustic_cfl * solver.cell_size);
  if (!hardest || steps <= most_of_steps * checkup.steps()) return;
  checkup.crushed_steps = steps;
  checkup.findings.push_back(
      {Severity::note, "material." + hardest->name + ".max_hardening",
       fmt::format("{} rules the steps of all: up to {} steps", text, about_count_text(steps)),
       "20 bounds that, as --fast does"});
}

/// @return s per step and particle, on one thread
double foresee_frames(const scene::Scene& scene, Checkup& checkup) {
  const Forecast forecast = foresee(scene, checkup.plan.particles, scene.frames, coarse_budget);
  checkup.coarse_particles = forecast.particles;
  checkup.forecast = forecast.frames;
  if (checkup.spread.blocks > 0 && forecast.spread.blocks > 0)
    for (FrameForecast& frame : checkup.forecast) {
      const double more = checkup.spread.blocks / forecast.spread.blocks;
      const Spread together{std::min(1.0, more * frame.spread.blocks), frame.spread.alone};
      const double first = cost_of_step(checkup.spread);
      frame.cost = cost_of_step(together) / first;
      frame.max_cost = std::max(frame.cost, cost_of_step(frame.spread) / first);
    }
  checkup.findings.insert(checkup.findings.end(), forecast.findings.begin(),
                          forecast.findings.end());
  if (!forecast.divergence.empty())
    checkup.findings.push_back({Severity::warning, "", forecast.divergence,
                                "run the scene itself to see if it diverges too"});
  return forecast.seconds_per_particle_step;
}

/// A coarse copy that ran.
struct CopyRun {
  Forecast forecast;
  double particle_steps = 0;
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
  sim::Simulation simulation = setup::make_simulation(*coarse, particles, 1);
  result.spread = spread_of(simulation);
  const auto start = Clock::now();
  FrameForecast frame_forecast = foresee_frame(scene, *coarse, 1, simulation.step_limits(), {}, {});
  double seconds = 0;
  for (int frame = 1; frame <= last; ++frame) {
    // The frame's start and end both count; where time runs out the last frames are as the one
    // before.
    if (seconds_since(start) < budget.seconds && run.particle_steps < budget.particle_steps &&
        !is_interrupted()) {
      const sim::StepLimits before = simulation.step_limits();
      const auto before_frame = Clock::now();
      const sim::AdvanceReport report = simulation.advance_to(frame / scene.fps, is_interrupted);
      seconds += seconds_since(before_frame);
      run.particle_steps +=
          static_cast<double>(report.steps) * static_cast<double>(simulation.particle_count());
      if (simulation.divergence()) break;  // a broken state foretells nothing
      frame_forecast =
          foresee_frame(scene, *coarse, frame, worst_of(before, simulation.step_limits()), report,
                        rarity_of(*coarse, simulation.particles(), particle_count));
      frame_forecast.spread = spread_of(simulation);
      run.reached = frame;
    }
    frame_forecast.frame = frame;
    result.frames.push_back(frame_forecast);
  }
  check_withheld(*coarse, simulation, result.findings);
  if (simulation.divergence())
    result.divergence = "a copy with cells of " + fixed_text(coarse->solver.cell_size, 3) +
                        " m diverges: " + simulation.divergence()->what;
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
    frame.least_steps *= frame.steps / before;
    frame.most_steps *= frame.steps / before;
    frame.dt = duration / frame.steps;
  }
}

}  // namespace

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

/// Sums a number over the frames until one; those that the copy did not reach are as its last one.
template <class Number>
double sum_until(const std::vector<FrameForecast>& frames, int frame, const Number& number) {
  double sum = 0;
  for (const FrameForecast& forecast : frames)
    if (forecast.frame <= frame) sum += number(forecast);
  if (frames.empty()) return 0;
  return sum + std::max(0, frame - frames.back().frame) * number(frames.back());
}

}  // namespace

double Forecast::steps_until(int frame) const {
  return sum_until(frames, frame, [](const FrameForecast& f) { return f.steps; });
}

double Forecast::work_until(int frame) const {
  return sum_until(frames, frame, [](const FrameForecast& f) {
    return f.steps * (1 + work_of_iteration * f.iterations);
  });
}

double Checkup::steps() const {
  double sum = 0;
  for (const FrameForecast& frame : forecast) sum += frame.steps;
  return sum;
}

double Checkup::seconds_of(const FrameForecast& frame) const {
  return frame.steps * frame.cost * seconds_per_step;
}

double Checkup::seconds() const {
  double sum = 0;
  for (const FrameForecast& frame : forecast) sum += seconds_of(frame);
  return sum;
}

scene::Range Checkup::steps_range() const {
  double least = 0, most = 0;
  for (const FrameForecast& frame : forecast) {
    least += frame.least_steps;
    most += frame.most_steps;
  }
  return {least_of_steps * least, std::max(most_of_steps * most, crushed_steps)};
}

scene::Range Checkup::seconds_range() const {
  double high = 0;
  for (const FrameForecast& frame : forecast) high += frame.steps * frame.max_cost;
  const scene::Range share =
      steps() > 0 ? scene::Range{steps_range().min / steps(), steps_range().max / steps()}
                  : scene::Range{least_of_steps, most_of_steps};
  return {share.min * seconds(), dearest_step * share.max * high * seconds_per_step};
}

Checkup examine(const scene::Scene& scene, const setup::Plan& plan, int threads,
                double coarsening) {
  Checkup checkup;
  checkup.plan = plan;
  checkup.coarsening = coarsening;
  checkup.cells = plan.volume / std::pow(scene.solver.cell_size, 3);
  checkup.impact_speed = setup::impact_speed(scene);
  int used_threads = 1;
  check_units(scene, checkup.findings, coarsening);
  check_gravity(scene, checkup.findings);
  check_resolution(scene, checkup.findings, coarsening);
  check_emitters(scene, checkup.findings, coarsening);
  check_sinks(scene, checkup.impact_speed, checkup.findings);
  check_unused(scene, coarsening, checkup.findings);
  if (plan.particles <= max_seeded && plan.memory <= plan.memory_limit) {
    const setup::SeededScene seeded = setup::seed_scene(scene);
    const sim::ParticleArrays& particles = seeded.particles;
    checkup.plan.particles = static_cast<double>(particles.x.size()) + plan.emitted;
    check_overlaps(scene, seeded, checkup.findings);
    check_meetings(scene, seeded, checkup.findings);
    sim::Simulation simulation = setup::make_simulation(scene, particles, threads);
    used_threads = simulation.threads();
    checkup.start = simulation.step_limits();
    sim::DtChoice choice = simulation.choose_dt(1 / scene.fps);
    if (particles.x.empty()) choice = first_emission(scene, checkup.start);
    checkup.dt_start = choice.dt;
    checkup.limit_start = choice.limit;
    checkup.spread = spread_of(simulation);
    checkup.seconds_per_step = measure_step(simulation, 1 / scene.fps, checkup.solve);
    check_steps(scene, checkup, checkup.findings);
    check_motion(scene, checkup, checkup.findings);
  } else {
    checkup.findings.push_back(
        {Severity::note, "",
         "too large for a check of its particles: overlaps, dt and time per step are not known",
         "try neve check with --coarsen " +
             fixed_text(std::ceil(std::cbrt(plan.particles / max_seeded)), 0)});
  }
  const double particle_step = foresee_frames(scene, checkup);
  check_crushing(scene, checkup);
  // Emitted particles cannot be timed at the start: count half of them, as in the coarse copy.
  if (plan.emitted > 0 && checkup.seconds_per_step > 0)
    checkup.seconds_per_step =
        particle_step / used_threads * (checkup.plan.particles - 0.5 * plan.emitted);
  check_cameras(scene, setup::coarse_run(scene), checkup.findings);
  std::stable_sort(checkup.findings.begin(), checkup.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return checkup;
}

}  // namespace neve::app::health
