#include "app/health/diagnosis.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/health/findings.h"
#include "app/health/softness.h"
#include "app/scene/coarsen.h"
#include "app/scene/toml/value.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/snow_pieces.h"
#include "app/support/text.h"
#include "sim/health/diagnostics.h"
#include "sim/health/limits.h"
#include "sim/laws/law.h"
#include "sim/types/time_step.h"

namespace neve::app::health {

namespace {

using sim::Vec3d;
using sim::health::Law;
using sim::health::limits_of;

/// Sound in snow of the paper, m/s: what other numbers are compared with.
double usual_sound_speed() {
  return sim::sound_speed(sim::Material{});
}

/// Returns the limit on settings and last steps beyond which a diagnosis sees a cause.
double cause(Law law) {
  return limits_of(law).cause;
}
/// Returns that limit on the state that the run started from.
double at_start(Law law) {
  return limits_of(law).at_start;
}

/// Data for all hypotheses.
struct Case {
  const scene::Scene& scene;
  const sim::Divergence& d;
  double coarsening;
  double h;
  bool is_fixed;
  double dt;       ///< of the steps before the end of the frame shortened one
  double stretch;  ///< what semi-implicit steps make of the limits that sound sets; infinite: none
  const sim::Material& material;

  Case(const scene::Scene& s, const sim::Divergence& divergence, double coarsened)
      : scene(s),
        d(divergence),
        coarsening(coarsened),
        h(s.solver.cell_size),
        is_fixed(s.solver.time_step == sim::TimeStep::fixed),
        dt(longest_step()),
        stretch(sim::acoustic_stretch(s.solver)),
        material(s.materials[static_cast<std::size_t>(divergence.material)]) {}

  double longest_step() const {
    double longest = d.dt;
    for (const sim::StepRecord& step : d.last_steps) longest = std::max(longest, step.dt);
    return longest;
  }
  /// The rule of energy names no particle: any material of the snow may be the cause.
  template <class Badness>
  sim::Material worst(const Badness& badness) const {
    if (d.rule != "energy") return material;
    const std::vector<sim::Material> all = scene::materials_of_snow(scene);
    return *std::ranges::max_element(all, {}, badness);
  }
  std::string at(const char* key) const { return "material." + material.name + "." + key; }
  /// Advice on the fixed step.
  std::string dt_text(double seconds) const {
    return scene::setting_text("solver.dt", seconds, coarsening);
  }
  /// The first remembered step at which sound crossed so many cells; null if none did.
  const sim::StepRecord* sound_beyond(double cells) const {
    for (const sim::StepRecord& step : d.last_steps)
      if (step.max_sound_speed * step.dt > stretch * cells * h) return &step;
    return nullptr;
  }
  /// Speed of the snow before trouble began, m/s.
  double speed_before_failure() const {
    return std::max(d.start.max_speed, setup::impact_speed(scene));
  }
  bool is_crushed() const { return d.rule == "J_P" || d.rule == "packed"; }
  bool is_hardened() const {
    return d.rule == "acoustic_cfl" || d.rule == "time_step" || d.rule == "not_finite";
  }
  /// Sound speed of snow at rest, m/s.
  double start_sound() const { return d.start.max_sound_speed; }
};

using Hypothesis = std::optional<Diagnosis>;

Hypothesis bypass(const Case& c) {
  const std::vector<sim::Stage>& skipped = c.scene.solver.bypass;
  if (skipped.empty()) return std::nullopt;
  std::vector<std::string> stages;
  for (const sim::Stage stage : skipped) stages.emplace_back(name(stage));
  return Diagnosis{Cause::bypass, "solver.bypass skips " + joined(stages, ", "),
                   "set solver.bypass = []; an incomplete step has no diagnosis", "solver.bypass"};
}

Hypothesis initial_state(const Case& c) {
  const sim::StartState& s = c.d.start;
  const bool is_strange =
      s.worst_particle >= 0 &&
      (s.min_J_E < at_start(Law::small_J_E) || s.max_J_E > at_start(Law::large_J_E) ||
       s.min_J_P < at_start(Law::compaction) || s.max_J_P > at_start(Law::dilation));
  // NaN leaves no mark on the extremes; a particle that is named and breaks the first steps does.
  const bool is_no_number = s.worst_particle >= 0 && c.d.rule == "not_finite" && c.d.step <= 2;
  if (!is_strange && !is_no_number) return std::nullopt;
  return Diagnosis{
      Cause::initial_state,
      is_strange
          ? fmt::format(
                "particle {} did not start at rest: det F_E from {} to {}, J_P from {} to {}",
                s.worst_particle, rough_text(s.min_J_E), rough_text(s.max_J_E),
                rough_text(s.min_J_P), rough_text(s.max_J_P))
          : fmt::format("particle {} did not start with finite numbers", s.worst_particle),
      "start with F_E = I and J_P = 1", ""};
}

/// No matter how stiff it is.
Hypothesis begins_dense(const Case& c) {
  const auto birth = dense_birth(c.scene);
  if (!birth || !c.is_crushed() || c.d.material != static_cast<int>(birth->material))
    return std::nullopt;
  return Diagnosis{Cause::initial_state, evidence_text(*birth), advice_text(*birth),
                   birth->address};
}

Hypothesis units(const Case& c) {
  const double g = c.scene.solver.gravity.norm(), largest = setup::largest_extent(c.scene);
  const bool is_strong = g > cause(Law::gravity), is_large = setup::is_too_large(c.scene);
  if (!is_strong && !is_large) return std::nullopt;
  const std::string gravity = fmt::format("gravity of {} m/s2", rough_text(g)),
                    body = fmt::format("a body {} m across", rough_text(largest));
  return Diagnosis{
      Cause::units,
      fmt::format("{} like centimetres; snow hits something at {} m/s, its sound runs at {} m/s",
                  is_strong && is_large ? gravity + " and " + body + " look"
                                        : (is_strong ? gravity : body) + " looks",
                  rough_text(setup::impact_speed(c.scene)), rough_text(c.start_sound())),
      is_strong && is_large ? "write lengths in metres, gravity as 9.81 m/s2"
      : is_strong           ? "write gravity as 9.81 m/s2"
                            : "write lengths in metres",
      is_strong ? "solver.gravity" : setup::snow_places(c.scene).front().address + ".shape"};
}

Hypothesis raised_limits(const Case& c) {
  const sim::SolverSettings& s = c.scene.solver;
  if (c.is_fixed) return std::nullopt;
  struct Limit {
    const char* key;
    double value, holds;
    sim::DtLimit ruling;
  };
  for (const Limit& limit :
       {Limit{"acoustic_cfl", s.acoustic_cfl, cause(Law::acoustic_cfl), sim::DtLimit::acoustic},
        Limit{"cfl", s.cfl, cause(Law::speed_cfl), sim::DtLimit::cfl},
        Limit{"strain_limit", s.strain_limit, cause(Law::strain_step), sim::DtLimit::strain}}) {
    const bool has_ruled =
        std::any_of(c.d.last_steps.begin(), c.d.last_steps.end(),
                    [&](const sim::StepRecord& step) { return step.limit == limit.ruling; });
    // One that is far too high never rules: another one does, or max_dt.
    if (limit.ruling == sim::DtLimit::acoustic && !(c.stretch < 1e9)) continue;
    if (limit.value <= limit.holds || !(has_ruled || limit.value > 2 * limit.holds)) continue;
    const sim::SolverSettings usual;
    const double default_value = limit.ruling == sim::DtLimit::acoustic ? usual.acoustic_cfl
                                 : limit.ruling == sim::DtLimit::cfl    ? usual.cfl
                                                                        : usual.strain_limit;
    const std::string address = std::string("solver.") + limit.key;
    return Diagnosis{Cause::raised_limits,
                     fmt::format("{} = {} is above the stable value, {}", address,
                                 rough_text(limit.value), rough_text(limit.holds)),
                     fmt::format("{} = {}", address, rough_text(default_value)), address};
  }
  return std::nullopt;
}

/// The last guess: between its default and its usual end of stability acoustic_cfl holds for some
/// materials and splines only (docs/time_step.md).
Hypothesis raised_acoustic_limit(const Case& c) {
  const double value = c.scene.solver.acoustic_cfl, usual = sim::SolverSettings{}.acoustic_cfl;
  const bool has_ruled =
      std::any_of(c.d.last_steps.begin(), c.d.last_steps.end(),
                  [](const sim::StepRecord& step) { return step.limit == sim::DtLimit::acoustic; });
  if (c.is_fixed || !has_ruled || value <= usual) return std::nullopt;
  return Diagnosis{Cause::raised_limits,
                   fmt::format("solver.acoustic_cfl = {} is above the default, {}; not every "
                               "material and spline is stable there",
                               rough_text(value), rough_text(usual)),
                   fmt::format("solver.acoustic_cfl = {}", rough_text(usual)),
                   "solver.acoustic_cfl"};
}

/// A fixed dt that does not even hold for snow at rest, and whose fault that is.
Hypothesis too_long_at_rest(const Case& c) {
  if (!c.is_fixed) return std::nullopt;
  const double sound = c.start_sound() / c.stretch * c.dt / c.h;
  const double speed = c.d.start.max_speed * c.dt / c.h;
  if (sound < at_start(Law::acoustic_cfl) && speed < at_start(Law::speed_cfl)) return std::nullopt;
  const double holds =
      0.5 * c.h / std::max(c.start_sound() / c.stretch, 1.25 * c.d.start.max_speed);
  const std::string remedy = fmt::format("{} or time_step = \"adaptive\"", c.dt_text(holds));
  if (sound >= speed) {
    const std::string crossed =
        fmt::format("sound runs at {} m/s and crosses {} cells in a step of {} s",
                    rough_text(c.start_sound()), rough_text(sound), rough_text(c.dt));
    const double without = usual_sound_speed() * c.dt / c.h;
    if (without < at_start(Law::acoustic_cfl) && c.material.density < cause(Law::low_density))
      return Diagnosis{
          Cause::density,
          fmt::format("density is {} kg/m3, so {}", rough_text(c.material.density), crossed),
          fmt::format("in g/cm3 it would be {} kg/m3; snow has 50 to 917. Otherwise {}",
                      rough_text(1000 * c.material.density), remedy),
          c.at("density")};
    if (without < at_start(Law::acoustic_cfl) &&
        c.material.youngs_modulus > cause(Law::high_stiffness))
      return Diagnosis{Cause::stiffness,
                       fmt::format("youngs_modulus is {} Pa, so {}",
                                   rough_text(c.material.youngs_modulus), crossed),
                       "the paper's snow has 1.4e5 Pa. Otherwise " + remedy,
                       c.at("youngs_modulus")};
    return Diagnosis{Cause::time_step, crossed, remedy, "solver.dt"};
  }
  return Diagnosis{
      Cause::time_step,
      fmt::format("snow at {} m/s crosses {} cells in a step of {} s",
                  rough_text(c.d.start.max_speed), rough_text(speed), rough_text(c.dt)),
      remedy, "solver.dt"};
}

/// The surface of a collider where it is nearest to the culprit. NaN counts as far.
struct NearSurface {
  const scene::Collider* collider;
  sim::shapes::Surface surface;
};

std::vector<NearSurface> surfaces_near(const Case& c, double cells) {
  std::vector<NearSurface> near;
  if (!c.d.x.allFinite()) return near;
  for (const scene::Collider& collider : c.scene.colliders) {
    const sim::shapes::Surface surface = sim::shapes::surface_at(collider, c.d.time, c.d.x);
    if (surface.distance < cells * c.h) near.push_back({&collider, surface});
  }
  return near;
}

std::string motion_address(const scene::Collider& collider) {
  return "collider." + collider.name + (collider.keyframes.empty() ? ".velocity" : ".keyframes");
}

/// The largest speed at which a collider came by the culprit in the last steps, in m/s: one that is
/// fast is beyond it, or at rest at its last keyframe, when the snow breaks.
double speed_beside_culprit(const Case& c, const scene::Collider& collider) {
  double fastest = 0;
  const auto look = [&](double time, double dt) {
    const sim::shapes::Surface surface = sim::shapes::surface_at(collider, time, c.d.x);
    const double speed = surface.velocity.norm();
    if (surface.distance < 6 * c.h + speed * dt) fastest = std::max(fastest, speed);
  };
  if (!c.d.x.allFinite()) return 0;
  look(c.d.time, c.dt);
  for (const sim::StepRecord& step : c.d.last_steps)
    for (const double part : {0.0, 0.5, 1.0}) look(step.time - part * step.dt, step.dt);
  return fastest;
}

Hypothesis collider_speed(const Case& c) {
  for (const scene::Collider& collider : c.scene.colliders) {
    const double speed = speed_beside_culprit(c, collider);
    const double mach = speed / std::max(1e-9, c.start_sound());
    if (mach < cause(Law::collider_mach) && speed * c.dt < cause(Law::collider_cfl) * c.h) continue;
    if (speed < 2 * c.d.start.max_speed) continue;
    return Diagnosis{Cause::collider_speed,
                     fmt::format("collider {} hits the snow at {} m/s, {} times the speed of its "
                                 "sound, and {} cells in a step",
                                 collider.name, rough_text(speed), rough_text(mach),
                                 rough_text(speed * c.dt / c.h)),
                     fmt::format("move it at less than {} m/s, or accelerate it gently",
                                 rough_text(0.5 * c.start_sound())),
                     motion_address(collider)};
  }
  return std::nullopt;
}

Hypothesis colliders_closing(const Case& c) {
  const std::vector<NearSurface> near = surfaces_near(c, 4);
  for (const NearSurface& a : near)
    for (const NearSurface& b : near) {
      if (a.collider == b.collider || a.surface.normal.dot(b.surface.normal) > -0.3) continue;
      const double closing = (b.surface.velocity - a.surface.velocity).dot(b.surface.normal);
      if (closing <= 0) continue;
      const double gap = std::max(0.0, a.surface.distance) + std::max(0.0, b.surface.distance);
      return Diagnosis{
          Cause::colliders_closing,
          fmt::format(
              "colliders {} and {} close on the snow at {} m/s and leave it a gap of about {} "
              "m, {} cells",
              a.collider->name, b.collider->name, rough_text(closing), rough_text(gap),
              rough_text(gap / c.h)),
          fmt::format(
              "stop them before the snow is as dense as ice: packed to {} kg/m3 it has no room",
              rough_text(c.material.density / std::max(0.02, c.d.J_P))),
          motion_address(*b.collider)};
    }
  return std::nullopt;
}

Hypothesis hardened_beyond_fixed_step(const Case& c) {
  if (!c.is_fixed) return std::nullopt;
  const sim::StepRecord* step = c.sound_beyond(cause(Law::acoustic_cfl));
  if (!step) return std::nullopt;
  const double factor = sim::health::hardening_factor(c.material, step->min_J_P);
  return Diagnosis{
      Cause::hardening,
      fmt::format(
          "snow was packed to J_P = {} and hardened {} times (hardening = {}): sound, {} m/s "
          "at the start, reached {} m/s and crossed {} cells in a step",
          rough_text(step->min_J_P), rough_text(factor), rough_text(c.material.hardening),
          rough_text(c.start_sound()), rough_text(step->max_sound_speed),
          rough_text(step->max_sound_speed * step->dt / c.h)),
      fmt::format("time_step = \"adaptive\", or {}, or a smaller hardening",
                  c.dt_text(0.5 * c.h / step->max_sound_speed)),
      "solver.dt"};
}

Hypothesis incompressible(const Case& c) {
  const sim::Material m =
      c.worst([](const sim::Material& material) { return material.poisson_ratio; });
  const double nu = m.poisson_ratio;
  if (nu < cause(Law::poisson_ratio)) return std::nullopt;
  return Diagnosis{
      Cause::incompressible,
      fmt::format("poisson_ratio is {}: lambda is {} times mu, so the snow cannot be compressed",
                  scene::toml::number_text(nu), rough_text(2 * nu / (1 - 2 * nu))),
      "use 0.2 for snow, 0.3 to 0.4 for rubber", "material." + m.name + ".poisson_ratio"};
}

Hypothesis shock(const Case& c) {
  const double speed = c.speed_before_failure(), mach = speed / std::max(1e-9, c.start_sound());
  if (!(c.is_crushed() || c.is_hardened()) || mach < cause(Law::impact_mach)) return std::nullopt;
  return Diagnosis{
      Cause::shock,
      fmt::format("snow hits something at {} m/s, {} times the speed of its sound, and is crushed "
                  "to J_P = {}",
                  rough_text(speed), rough_text(mach), rough_text(c.d.J_P)),
      fmt::format("stay below {} m/s, or make the snow stiffer: {} = {}",
                  rough_text(c.start_sound()), c.at("youngs_modulus"),
                  rough_text(stiffness_that_holds(c.material, c.scene.solver, c.d.J_P, speed))),
      c.at("youngs_modulus")};
}

/// Nothing crushes elastic snow: only its energy tells.
Hypothesis elastic_shock(const Case& c) {
  if (c.d.rule != "energy") return std::nullopt;
  const setup::Impact impact = setup::hardest_impact(c.scene);
  const double sound = c.start_sound() * impact.share_of_sound;
  const std::vector<setup::SnowPiece> places = setup::snow_places(c.scene);
  const auto hit = std::ranges::find(places, impact.address, &setup::SnowPiece::address);
  if (hit == places.end() || sim::laws::of(*hit->material).is_plastic ||
      impact.speed < cause(Law::impact_mach) * sound)
    return std::nullopt;
  const std::string at = "material." + hit->material->name + ".youngs_modulus";
  return Diagnosis{
      Cause::shock,
      fmt::format("{} hits something at {} m/s, {} times the speed of its sound", impact.address,
                  rough_text(impact.speed), rough_text(impact.speed / sound)),
      fmt::format(
          "stay below {} m/s, or make it stiffer: {} = {}", rough_text(sound), at,
          rough_text(hit->material->youngs_modulus * std::pow(2 * impact.speed / sound, 2))),
      at};
}

/// " and hardening = 10", where the law hardens.
std::string hardening_text(const char* joint, const sim::Material& m) {
  const sim::laws::Parameter* rate = sim::laws::of(m).rate;
  return rate ? fmt::format(" {} {} = {}", joint, rate->key, rough_text(rate->of(m))) : "";
}

Hypothesis too_soft(const Case& c) {
  if (!c.is_crushed()) return std::nullopt;
  const double speed = std::max(c.d.start.max_speed, load_speed(c.scene));
  const sim::Material usual;
  const std::string stiffer =
      fmt::format("{} = {}", c.at("youngs_modulus"),
                  rough_text(stiffness_that_holds(c.material, c.scene.solver, c.d.J_P, speed)));
  return Diagnosis{
      Cause::too_soft,
      fmt::format("snow of youngs_modulus = {}{} is too soft for its impact at {} m/s: it was "
                  "packed to {} kg/m3",
                  rough_text(c.material.youngs_modulus), hardening_text("and", c.material),
                  rough_text(speed), rough_text(c.material.density / c.d.J_P)),
      c.material.min_J_P < usual.min_J_P
          ? fmt::format("{}, or {} = {}, where snow yields without hardening further", stiffer,
                        c.at("min_J_P"), rough_text(usual.min_J_P))
          : stiffer,
      c.at("youngs_modulus")};
}

Hypothesis hardening(const Case& c) {
  const double factor = sim::health::hardening_factor(c.material, c.d.J_P);
  if (!c.is_hardened() || !(factor > cause(Law::hardening))) return std::nullopt;
  return Diagnosis{
      Cause::hardening,
      fmt::format("snow was packed to J_P = {} and hardened {} times: hardening = {}, "
                  "critical_compression = {}",
                  rough_text(c.d.J_P), rough_text(factor), rough_text(c.material.hardening),
                  rough_text(c.material.critical_compression)),
      "a smaller hardening (the paper: 5 to 10) or a larger critical_compression "
      "(0.019 to 0.025)",
      c.at("hardening")};
}

/// A step is chosen by the sound before it: snow that is packed in it may end much stiffer.
Hypothesis hardened_within_a_step(const Case& c) {
  constexpr double much = 2;  // times the speed of sound before
  const auto& steps = c.d.last_steps;
  if (c.is_fixed || !c.is_hardened() || steps.size() < 2) return std::nullopt;
  const double before = steps[steps.size() - 2].max_sound_speed, after = c.d.sound_speed;
  if (!(sim::health::hardening_factor(c.material, c.d.J_P) > 1) || !(after > much * before))
    return std::nullopt;
  constexpr double usual_bound = 20;
  const bool goes_back = c.scene.solver.on_divergence == sim::OnDivergence::retry;
  const std::string bounded =
      c.material.max_hardening > usual_bound
          ? ", or " + c.at("max_hardening") + " = " + rough_text(usual_bound)
          : "";
  return Diagnosis{
      Cause::hardening,
      fmt::format(
          "one step of {} s packed snow to J_P = {}, and its sound became {} times as fast{}",
          rough_text(c.d.dt), rough_text(c.d.J_P), rough_text(after / before),
          hardening_text("with", c.material)),
      goes_back ? fmt::format("a smaller solver.acoustic_cfl than {}{}",
                              rough_text(c.scene.solver.acoustic_cfl), bounded)
                : "solver.on_divergence = \"retry\", which takes such steps again with half of dt" +
                      bounded,
      goes_back ? "solver.acoustic_cfl" : "solver.on_divergence"};
}

Hypothesis doubts_of_the_law(const Case& c) {
  const std::vector<Finding> doubts = law_findings(c.material);
  if (doubts.empty()) return std::nullopt;
  return Diagnosis{Cause::law, doubts.front().what, doubts.front().hint, doubts.front().address};
}

/// Single precision: F_E is known to 6e-8, which is a stress. Steps make energy out of rounding if
/// that is as large as what moves the snow.
Hypothesis rounding(const Case& c) {
  if (c.scene.solver.precision != sim::Precision::single) return std::nullopt;
  constexpr double epsilon = 6e-8, notable = 0.1;
  const std::vector<sim::Material> all = scene::materials_of_snow(c.scene);
  const sim::Material& m =
      *std::ranges::max_element(all, {}, [](const sim::Material& a) { return a.youngs_modulus; });
  const double sound = sim::sound_speed(m), stress = epsilon * m.density * sound * sound;
  const double speed = c.speed_before_failure();
  if (!(stress > notable * m.density * speed * speed)) return std::nullopt;
  return Diagnosis{
      Cause::rounding,
      fmt::format("single precision knows F_E to 6e-8: in snow of youngs_modulus {} Pa "
                  "that is a stress of {} Pa, and its motion is worth {} Pa",
                  rough_text(m.youngs_modulus), rough_text(stress),
                  rough_text(m.density * speed * speed)),
      "solver.precision = \"double\", or softer snow", "solver.precision"};
}

/// Weights reach two cells. Forces and transfers of a thinner body are coarse, and may make notable
/// energy.
Hypothesis thin(const Case& c) {
  constexpr double reach = 2, resolved = 6;  // cells
  if (c.d.rule != "energy" || c.scene.bodies.empty()) return std::nullopt;
  const auto thickness_of = [](const sim::seeding::Body& body) { return thickness(body.shape); };
  const sim::seeding::Body& body = *std::ranges::min_element(c.scene.bodies, {}, thickness_of);
  const double size = thickness(body.shape);
  if (!(size > 0 && size < reach * c.h)) return std::nullopt;
  return Diagnosis{
      Cause::thin,
      fmt::format("{} is {} cells thick: weights reach {} cells and do not resolve it",
                  display_name("body", body.name), rough_text(size / c.h), rough_text(reach)),
      scene::setting_text("solver.cell_size", size / resolved, c.coarsening), "solver.cell_size"};
}

Hypothesis far_flight(const Case& c) {
  if (c.d.rule != "overflow") return std::nullopt;
  return Diagnosis{
      Cause::far_flight,
      fmt::format("particle {} flew to {} m from the origin, where the lattice ends, at "
                  "{} m/s, in a healthy state",
                  c.d.particle, rough_text(c.d.x.norm()), rough_text(c.d.v.norm())),
      "put a collider in its way, end the scene earlier, or move it closer to the "
      "origin",
      "frames"};
}

Diagnosis unexplained(const Case& c) {
  double sound = 0;
  for (const sim::StepRecord& step : c.d.last_steps)
    sound = std::max(sound, step.max_sound_speed * step.dt / c.h);
  return {
      Cause::unexplained,
      fmt::format("no known cause: in the last {} steps sound crossed at most {} cells in a step",
                  c.d.last_steps.size(), rough_text(sound)),
      "neve check examines the numbers of the scene; neve render --validate checks the steps", ""};
}

}  // namespace

Diagnosis diagnose(const scene::Scene& scene, const sim::Divergence& divergence,
                   double coarsening) {
  const Case c(scene, divergence, coarsening);
  for (const auto hypothesis : {bypass,
                                begins_dense,
                                initial_state,
                                units,
                                raised_limits,
                                too_long_at_rest,
                                collider_speed,
                                colliders_closing,
                                incompressible,
                                hardened_beyond_fixed_step,
                                shock,
                                elastic_shock,
                                too_soft,
                                hardening,
                                hardened_within_a_step,
                                far_flight,
                                raised_acoustic_limit,
                                doubts_of_the_law,
                                rounding,
                                thin})
    if (Hypothesis found = hypothesis(c)) {
      found->coarsening = coarsening;
      return *found;
    }
  Diagnosis unknown = unexplained(c);
  unknown.coarsening = coarsening;
  return unknown;
}

std::string sentence(const sim::Divergence& d, const Diagnosis& diagnosis) {
  // One advice on dt is enough; that of the cause looks at where trouble began. The engine's own is
  // in seconds of the run, not in those of the scene file.
  const bool is_engines = diagnosis.cause == Cause::unexplained && diagnosis.coarsening == 1;
  return fmt::format("{}. Cause: {}. Try: {}", is_engines ? d.sentence : d.what, diagnosis.evidence,
                     diagnosis.remedy);
}

}  // namespace neve::app::health
