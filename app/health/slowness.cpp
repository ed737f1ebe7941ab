#include "app/health/slowness.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/health/findings.h"
#include "app/scene/coarsen.h"
#include "app/setup/seed_scene.h"
#include "app/setup/snow_pieces.h"
#include "app/support/round_number.h"
#include "app/support/text.h"
#include "sim/health/diagnostics.h"
#include "sim/laws/law.h"
#include "sim/shapes/collider.h"
#include "sim/types/time_step.h"

namespace neve::app::health {

namespace {

/// Particle-steps: some seconds on one core, and half an hour.
constexpr double worth_a_word = 1e8, very_long = 2e10;
/// A step of few particles takes as long as one of so many: 7 to 25 us, measured with 29 to 301.
constexpr double min_work_of_step = 500;
/// Steps of a run that is long whatever it has in it.
constexpr double many_steps = 5e5;
/// Times the work of what is usual.
constexpr double stands_out = 4;

/// A parameter that multiplies the work of a run.
struct Slow {
  std::string address;
  double times = 1;  ///< the work of the usual value
  std::string what, hint;
};

/// "12.5", "1000", "250000"
std::string times_text(double times) {
  return times < 100 ? rough_text(times) : about_count_text(times);
}

/// Names a parameter whose default takes longer steps.
Slow below_default(const std::string& address, double value, double usual, double factor) {
  return {
      address, usual / value,
      fmt::format("{:g} makes {} times the steps of {:g}", value, times_text(usual / value), usual),
      scene::setting_text(address, usual, factor)};
}

/// Snow that starts packed is stiffer, and sets the steps for as long as it exists.
void add_of_packed(const scene::Scene& scene, std::vector<Slow>& slow) {
  const auto add = [&](const char* kind, const auto& bodies) {
    for (const auto& body : bodies) {
      const sim::Material& m = scene.materials[setup::material_index(scene, body.material)];
      if (!(body.J_P < 1) || !sim::laws::of(m).hardens) continue;
      const double times = std::sqrt(sim::health::hardening_factor(m, body.J_P));
      const std::string address = std::string(kind) + "." + body.name + ".J_P";
      slow.push_back(
          {address, times,
           fmt::format("snow packed to {:g} makes sound {} times as fast as 1 would, and "
                       "steps as much shorter",
                       body.J_P, times_text(times)),
           address + " = 1"});
    }
  };
  add("body", scene.bodies);
  add("emitter", scene.emitters);
}

/// Adds what makes sound fast: density, moduli, lumps that are stiffer, snow that starts packed.
void add_of_sound(const scene::Scene& scene, std::vector<Slow>& slow) {
  const sim::Material usual;
  const double c0 = sim::sound_speed(usual);
  for (const sim::Material& m : scene::materials_of_snow(scene)) {
    const std::string table = "material." + m.name + ".";
    const auto add = [&](const char* key, double value, double common, double times) {
      slow.push_back(
          {table + key, times,
           fmt::format("{:g} makes sound {} times as fast as {:g} would, and steps as much shorter",
                       value, times_text(times), common),
           fmt::format("{}{} = {:g}", table, key, common)});
    };
    const auto with = [&](auto member, double value) {
      sim::Material other = usual;
      other.*member = value;
      return sim::sound_speed(other) / c0;
    };
    add("youngs_modulus", m.youngs_modulus, usual.youngs_modulus,
        with(&sim::Material::youngs_modulus, m.youngs_modulus));
    add("density", m.density, usual.density, with(&sim::Material::density, m.density));
    add("poisson_ratio", m.poisson_ratio, usual.poisson_ratio,
        with(&sim::Material::poisson_ratio, std::min(m.poisson_ratio, 0.4999)));
    // Among some thousand lumps one is stiffer by three and a half deviations.
    add("variation.youngs_modulus", m.variation.youngs_modulus, 0,
        std::exp(0.5 * 3.5 * m.variation.youngs_modulus));
  }
  add_of_packed(scene, slow);
}

/// The limit that sets most steps.
sim::DtLimit ruling_limit(const Check& check) {
  std::array<double, sim::dt_limit_count> steps{};
  for (const forecast::FrameForecast& frame : check.foreseen.frames)
    steps[static_cast<std::size_t>(frame.limit)] += frame.steps;
  const auto most = std::max_element(steps.begin(), steps.end());
  return *most > 0 ? static_cast<sim::DtLimit>(most - steps.begin()) : check.limit_start;
}

/// Seconds of a run that its forecast covers.
double duration_of(const scene::Scene& scene, const Check& check) {
  return static_cast<double>(check.foreseen.frames.size()) / scene.fps;
}

/// Adds things so fast that their speed sets the steps, not sound. Snow that bursts moves without
/// anything that throws it: nothing is named then.
void add_of_motion(const scene::Scene& scene, const Check& check, std::vector<Slow>& slow) {
  const double of_sound = check.start.dt[static_cast<std::size_t>(sim::DtLimit::acoustic)];
  const double mean = duration_of(scene, check) / check.foreseen.steps().expected;
  const double times = of_sound / mean;
  if (!(times < 1e300)) return;
  // Slower things are not the reason of the steps.
  const double telling = 0.25 * scene.solver.cfl * scene.solver.cell_size / mean;
  const auto add = [&](const std::string& address, double speed) {
    if (speed < telling) return;
    slow.push_back({address, times,
                    fmt::format("at {} m/s it crosses a cell in {} s: {} times the steps that "
                                "sound asks for",
                                rough_text(speed), rough_text(scene.solver.cell_size / speed),
                                times_text(times)),
                    fmt::format("at {} m/s sound sets the steps", rough_text(speed / times))});
  };
  for (const setup::SnowPiece& piece : setup::snow_places(scene)) {
    add(piece.address + ".velocity", piece.velocity.norm());
    add(piece.address + ".angular_velocity", setup::speed_of_spin(piece));
  }
  for (const sim::shapes::Collider& collider : scene.colliders) {
    const double speed = sim::shapes::largest_speed(collider);
    add("collider." + collider.name + fastest_part(collider, speed), speed);
  }
  // A speed of the scene counts before what gravity adds: the first of equal ones is named.
  add("solver.gravity", check.impact_speed);
}

void add_of_steps(const scene::Scene& scene, const Check& check, std::vector<Slow>& slow) {
  const sim::SolverSettings &s = scene.solver, usual;
  using enum sim::DtLimit;
  const auto compare = [&](const char* address, double value, double common, double factor = 1) {
    slow.push_back(below_default(address, value, common, factor));
  };
  switch (ruling_limit(check)) {
    case acoustic:
      compare("solver.acoustic_cfl", s.acoustic_cfl, usual.acoustic_cfl);
      return add_of_sound(scene, slow);
    case cfl:
    case collider:
      compare("solver.cfl", s.cfl, usual.cfl);
      return add_of_motion(scene, check, slow);
    case strain:
      compare("solver.strain_limit", s.strain_limit, usual.strain_limit);
      return add_of_motion(scene, check, slow);
    case max_dt:
      return compare("solver.max_dt", s.max_dt, usual.max_dt * check.coarsening, check.coarsening);
    case fixed: {
      const double allowed = *std::min_element(check.start.dt.begin(), check.start.dt.end());
      if (!(allowed < 1)) return;
      slow.push_back(
          {"solver.dt", allowed / s.dt,
           fmt::format("fixed steps of {} s are {} times as many as the limits allow now",
                       rough_text(s.dt), times_text(allowed / s.dt)),
           "solver.time_step = \"adaptive\""});
      return;
    }
    default:
      return;
  }
}

/// Adds what makes each step dear.
void add_of_cost(const scene::Scene& scene, const Check& check, std::vector<Slow>& slow) {
  const auto add = [&](const std::string& address, double per_cell) {
    constexpr double usual = 8;
    slow.push_back({address + ".particles_per_cell", per_cell / usual,
                    fmt::format("{} particles per cell take {} times the work of 8",
                                rough_text(per_cell), times_text(per_cell / usual)),
                    address + ".particles_per_cell = 8"});
  };
  for (const auto& body : scene.bodies) add("body." + body.name, body.particles_per_cell);
  for (const auto& emitter : scene.emitters)
    add("emitter." + emitter.name, emitter.particles_per_cell);
  double iterations = 0;
  for (const forecast::FrameForecast& frame : check.foreseen.frames)
    iterations = std::max(iterations, frame.iterations);
  constexpr double few = 20;
  if (scene.solver.solve_tolerance < sim::SolverSettings{}.solve_tolerance)
    slow.push_back({"solver.solve_tolerance", iterations / few,
                    fmt::format("solves take {} iterations to {}", rough_text(iterations),
                                rough_text(scene.solver.solve_tolerance)),
                    fmt::format("solver.solve_tolerance = {}",
                                rough_text(sim::SolverSettings{}.solve_tolerance))});
}

}  // namespace

void check_slowness(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings) {
  const double steps = check.foreseen.steps().expected,
               explicit_steps =
                   check.foreseen.work(0, static_cast<int>(check.foreseen.frames.size())).expected,
               work = explicit_steps * std::max(min_work_of_step, check.plan.particles);
  if (!(work >= worth_a_word)) return;
  std::vector<Slow> slow;
  add_of_steps(scene, check, slow);
  add_of_cost(scene, check, slow);
  const auto worst = std::max_element(
      slow.begin(), slow.end(), [](const Slow& a, const Slow& b) { return a.times < b.times; });
  const auto is_named = [&](const std::string& address) {
    return std::any_of(findings.begin(), findings.end(),
                       [&](const Finding& finding) { return finding.address == address; });
  };
  const auto note = [&](const std::string& address, std::string what, std::string hint) {
    if (!is_named(address))
      findings.push_back({Severity::note, address, std::move(what), std::move(hint)});
  };
  if (worst != slow.end() && worst->times >= stands_out) {
    note(worst->address, worst->what, worst->hint);
  } else if (!check.foreseen.ignored.empty()) {
    // A finding of its own says so: snow that bursts has no usual steps.
  } else if (work >= very_long && check.plan.particles >= min_work_of_step) {
    if (!setup::is_too_large(scene))
      note("solver.cell_size",
           fmt::format("about {} steps of {} particles are a long run", about_count_text(steps),
                       about_count_text(check.plan.particles)),
           "--coarsen 2 takes about a sixteenth of the work, and is a first look");
  } else if (steps >= many_steps) {
    note("fps",
         fmt::format("about {} steps, because {} s are long for cells of {} m",
                     about_count_text(steps), rough_text(duration_of(scene, check)),
                     rough_text(scene.solver.cell_size)),
         fmt::format("fps = {} shows as many frames of slower motion, in a tenth of the time",
                     rough_text(10 * scene.fps)));
  }
}

}  // namespace neve::app::health
