#include "app/health/check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "app/forecast/step_cost.h"
#include "app/health/findings.h"
#include "app/health/mesh_findings.h"
#include "app/health/slowness.h"
#include "app/health/softness.h"
#include "app/scene/coarsen.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/curves.h"
#include "app/setup/seed_scene.h"
#include "app/setup/snow_pieces.h"
#include "app/support/text.h"
#include "sim/dust_cost.h"
#include "sim/health/diagnostics.h"
#include "sim/laws/law.h"
#include "sim/shapes/variation.h"

namespace neve::app::health {

namespace {

/// Two copies of about a second each. The time matters only where a machine is busy or snow is
/// spread out, so that a forecast is the same every time.
constexpr forecast::ForecastBudget coarse_budget{8, 3e7, 1500, 3e7};
/// Above this number of particles, seeding alone takes too long for a check.
constexpr double max_seeded = 3e6;

/// Step of the first emitted snow, for a scene that starts empty.
sim::DtChoice first_emission(const scene::Scene& scene, sim::StepLimits& start) {
  sim::StateLimits limits;
  for (const setup::SnowPiece& piece : setup::snow_places(scene)) {
    limits.max_speed = std::max(limits.max_speed, piece.velocity.norm());
    const sim::Material& m = *piece.material;
    const double stiffest = sim::shapes::max_factor(m.variation.youngs_modulus);
    limits.max_sound_speed =
        std::max(limits.max_sound_speed, std::sqrt(stiffest) * setup::sound_speed(piece));
    sim::laws::include_hardening(m, limits, stiffest);
  }
  start = {sim::limits_on_dt(scene.solver, limits), limits.max_speed, limits.max_sound_speed, 0};
  return sim::choose_dt(scene.solver, limits, 1 / scene.fps);
}

/// A collider that moves towards another squeezes the snow between them: a single particle of a
/// tumbling drum went to J_P = 0.45 within a second and multiplied the steps by seven.
bool squeezes_snow(const scene::Scene& scene) {
  const auto is_moving = [](const sim::shapes::Collider& collider) {
    return collider.velocity != sim::Vec3d::Zero() ||
           collider.angular_velocity != sim::Vec3d::Zero() || !collider.keyframes.empty() ||
           collider.body.moves();
  };
  return scene.colliders.size() > 1 &&
         std::any_of(scene.colliders.begin(), scene.colliders.end(), is_moving);
}

std::string crushing_text(const scene::Scene& scene, const Check& check) {
  const double sound = check.sound_at_hardest(),
               share = sound > 0 ? check.hardest.speed / sound : 0;
  // Which particles an impact crushes is chance, and no copy tells it: a ball of dry snow that hits
  // a post at 0.39 takes 61 000 steps with one seed and 8000 with another.
  constexpr double crushing_speed = 0.3;
  if (share >= crushing_speed && has_something_to_hit(scene))
    return fmt::format(
        "the impact at {} m/s is {} of the speed of sound in the snow and may crush single "
        "particles; such a particle",
        rough_text(check.hardest.speed), rough_text(share));
  if (squeezes_snow(scene))
    return "snow that is squeezed between colliders may crush single particles; such a particle";
  return {};
}

/// Hardened, a particle rules the steps of all for as long as it flies.
void check_crushing(const scene::Scene& scene, Check& check) {
  const sim::SolverSettings& solver = scene.solver;
  if (solver.time_step == sim::TimeStep::fixed || solver.is_implicit()) return;
  const std::string text = crushing_text(scene, check);
  if (text.empty()) return;
  const sim::Material* hardest = nullptr;
  double most = 1;
  const std::vector<sim::Material> materials = scene::materials_of_snow(scene);
  for (const sim::Material& m : materials) {
    const double hardening = forecast::crushed_hardening(m);
    if (hardening <= most) continue;
    most = hardening;
    hardest = &m;
  }
  const double c = check.start.max_sound_speed * std::sqrt(most);
  const double steps = scene::duration(scene) * c / (solver.acoustic_cfl * solver.cell_size);
  constexpr double worth_a_word = 2;  // times the steps without it
  if (!hardest || steps <= worth_a_word * check.foreseen.steps().expected) return;
  check.foreseen.crushed_steps = steps;
  check.findings.push_back(
      {Severity::note, "material." + hardest->name + ".max_hardening",
       fmt::format("{} shortens every step as long as it exists: up to {} steps", text,
                   about_count_text(steps)),
       "20 bounds their number, as --fast does"});
}

void check_copy(const scene::Scene& scene, const forecast::Forecast& foreseen,
                std::vector<Finding>& findings) {
  for (const forecast::Withheld& withheld : foreseen.withheld) {
    const auto reason = clogging(scene, withheld.emitter, withheld.share);
    if (!reason || reason->is_by_rate) continue;
    findings.push_back(
        {Severity::warning, "emitter." + withheld.emitter + ".rate",
         fmt::format("in a coarse copy {} % of its snow finds no room until {} s, because {}",
                     rough_text(100 * withheld.share), rough_text(withheld.time), reason->cause),
         reason->remedy + "; run.json counts this snow as withheld"});
  }
  if (!foreseen.ignored.empty())
    findings.push_back({Severity::warning, "solver.on_divergence",
                        foreseen.ignored + ": snow that bursts takes many short steps",
                        "solver.on_divergence = \"stop\" ends the run there and names the cause"});
  if (!foreseen.divergence.empty())
    findings.push_back({Severity::warning, "", foreseen.divergence,
                        "run the scene itself to see if it diverges too"});
}

double dust_steps(const scene::Scene& scene, double speed, int frames) {
  if (!scene::dusty_material(scene) && !scene::has_spray_drag(scene)) return 0;
  return frames *
         sim::dust_steps_of_frame(scene.solver.dust, scene.solver.cell_size, speed, 1 / scene.fps);
}

}  // namespace

forecast::Cost Check::seconds() const {
  // The measured steps have the bodies in them, and no dust: snow that rests sheds none. A step of
  // dust takes as long as one or two of the snow, by a profile of powder_avalanche.
  const forecast::Cost dust = dust_steps * forecast::Cost{1.5, 0, 3};
  return seconds_per_step * (foreseen.steps_of_start() + dust);
}

Check examine(const scene::Scene& given, const setup::Plan& plan, int threads, double coarsening,
              const std::vector<std::string>& set) {
  const scene::Scene scene = setup::with_curves(given, 0);
  Check check;
  check.plan = plan;
  check.coarsening = coarsening;
  check.cells = plan.volume / std::pow(scene.solver.cell_size, 3);
  check.impact_speed = load_speed(scene);
  check.hardest = setup::hardest_impact(scene);
  check.dust_steps = dust_steps(scene, check.impact_speed, plan.frames.last);
  int used_threads = 1;
  forecast::Spread spread;
  check_units(scene, check.findings, coarsening);
  check_gravity(scene, check.findings);
  check_meshes(scene, check.findings);
  note_terrain(scene, check.findings);
  check_resolution(scene, check.findings, coarsening);
  check_emitters(scene, check.findings, coarsening);
  check_rounding(scene, check.findings, coarsening);
  check_sinks(scene, check.impact_speed, check.findings);
  check_unused(given, coarsening, check.findings);
  check_idle(given, set, check.findings);
  check_dust(scene, check.impact_speed, check.findings);
  // A check draws nothing.
  const double memory = static_cast<double>(plan.memory) - plan.pictures,
               excess = std::max(plan.particles / max_seeded,
                                 memory / static_cast<double>(plan.memory_limit));
  if (excess <= 1) {
    const setup::SeededScene seeded = setup::seed_scene(scene);
    const sim::ParticleArrays& particles = seeded.particles;
    check.plan.particles = static_cast<double>(particles.x.size()) + plan.emitted;
    check_overlaps(scene, seeded, check.findings);
    check_meetings(scene, seeded, check.findings);
    sim::Simulation simulation = setup::make_simulation(scene, particles, threads);
    used_threads = simulation.threads();
    check.start = simulation.step_limits();
    sim::DtChoice choice = simulation.choose_dt(1 / scene.fps);
    if (particles.x.empty()) choice = first_emission(scene, check.start);
    check.dt_start = choice.dt;
    check.limit_start = choice.limit;
    spread = forecast::spread_of(simulation, scene.solver);
    const forecast::StepTime step = forecast::measure_steps(simulation, 1 / scene.fps);
    check.seconds_per_step = step.seconds;
    check.solve = step.solve;
    check_steps(scene, check, check.findings);
    check_motion(scene, check, check.findings);
  } else {
    check.findings.push_back(
        {Severity::note, "",
         "too large for a check of its particles: overlaps, dt and time per step are not known",
         setup::is_too_large(scene)
             ? "lengths in metres make it smaller"
             : "try neve check with --coarsen " +
                   fixed_text(std::ceil(coarsening * std::cbrt(excess)), 0)});
  }
  check.foreseen =
      forecast::foresee(scene, check.plan.particles, scene::last_frame(scene), coarse_budget);
  check.foreseen.include_spread(spread);
  check_copy(scene, check.foreseen, check.findings);
  check_crushing(scene, check);
  check_slowness(scene, check, check.findings);
  // Emitted particles cannot be timed at the start: count half of them, as in the coarse copy.
  if (plan.emitted > 0 && check.seconds_per_step > 0)
    check.seconds_per_step = check.foreseen.seconds_per_particle_step / used_threads *
                             (check.plan.particles - 0.5 * plan.emitted);
  const std::vector<setup::CoarseMoment> moments = setup::coarse_run(scene);
  check_cameras(scene, moments, check.findings);
  check_moving_bodies(scene, moments, check.coarsening, check.findings);
  std::stable_sort(check.findings.begin(), check.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return check;
}

}  // namespace neve::app::health
