#include <algorithm>
#include <cmath>
#include <iostream>

#include "app/cli/commands.h"
#include "app/health/checkup.h"
#include "app/run/render_job.h"
#include "app/scene/coarsen.h"
#include "app/scene/override.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/json.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

const char* name(health::Severity severity) {
  switch (severity) {
    case health::Severity::note:
      return "note";
    case health::Severity::warning:
      return "warning";
    case health::Severity::error:
      return "error";
  }
  return "";
}

std::string seconds_text(double seconds) {
  return seconds < 0.95 ? fixed_text(seconds, 2) + " s" : duration_text(seconds);
}

const health::FrameForecast& busiest(const health::Checkup& checkup) {
  return *std::max_element(checkup.forecast.begin(), checkup.forecast.end(),
                           [](const health::FrameForecast& a, const health::FrameForecast& b) {
                             return a.steps * a.cost < b.steps * b.cost;
                           });
}

Json range_json(const scene::Range& range) {
  return {range.min, range.max};
}

Json checkup_json(const health::Checkup& checkup, const run::RenderJob& job,
                  const health::FastLook& look) {
  Json json = setup::to_json(checkup.plan);
  json["cells"] = count_json(std::round(checkup.cells));
  json["cell_size"] = job.scene.solver.cell_size;
  json["coarsen"] = job.coarsening;
  json["impact_speed"] = checkup.impact_speed;
  json["sound_speed"] = checkup.start.max_sound_speed;
  json["dt"] = checkup.dt_start;
  json["dt_limit"] = sim::name(checkup.limit_start);
  json["dt_limits"] = Json::object();
  for (int k = 0; k < sim::dt_limit_count; ++k)
    if (const double dt = checkup.start.dt[static_cast<std::size_t>(k)];
        std::isfinite(dt) && dt > 0)
      json["dt_limits"][sim::name(static_cast<sim::DtLimit>(k))] = dt;
  json["frames"] = Json::array();
  for (const health::FrameForecast& frame : checkup.forecast)
    json["frames"].push_back({{"frame", frame.frame},
                              {"dt", frame.dt},
                              {"steps", count_json(frame.steps)},
                              {"limit", sim::name(frame.limit)}});
  json["steps"] = count_json(checkup.steps());
  json["steps_range"] = range_json(checkup.steps_range());
  const double frames = std::max<double>(1, static_cast<double>(checkup.forecast.size()));
  json["steps_per_frame"] = checkup.steps() / frames;
  json["seconds_per_frame"] = checkup.seconds() / frames;
  json["seconds_per_step"] = checkup.seconds_per_step;
  json["solve_iterations"] =
      job.scene.solver.is_implicit() ? Json(checkup.solve.iterations) : Json();
  json["seconds"] = checkup.seconds();
  json["seconds_range"] = range_json(checkup.seconds_range());
  json["fast"] = {
      {"is_set", job.fast.has_value()},
      {"overrides", look.overrides},
      {"work", look.work && look.work_before ? Json(*look.work / *look.work_before) : Json()}};
  json["warnings"] = Json::array();
  for (const health::Finding& finding : checkup.findings)
    if (finding.severity != health::Severity::note) json["warnings"].push_back(finding.what);
  json["findings"] = Json::array();
  for (const health::Finding& finding : checkup.findings)
    json["findings"].push_back({{"severity", name(finding.severity)},
                                {"address", finding.address},
                                {"what", finding.what},
                                {"hint", finding.hint}});
  return json;
}

void print_limits(const health::Checkup& checkup) {
  if (checkup.dt_start <= 0) return;
  std::cout << "sound      " << rough_text(checkup.start.max_sound_speed)
            << " m/s in the stiffest particle; impact at about " << rough_text(checkup.impact_speed)
            << " m/s\n"
            << "first step " << rough_text(checkup.dt_start) << " s, ruled by "
            << sim::name(checkup.limit_start) << "; allowed:";
  for (int k = 0; k < sim::dt_limit_count; ++k)
    if (const double dt = checkup.start.dt[static_cast<std::size_t>(k)];
        std::isfinite(dt) && dt > 0)
      std::cout << " " << sim::name(static_cast<sim::DtLimit>(k)) << " " << rough_text(dt);
  std::cout << "\n";
}

void print_forecast(const health::Checkup& checkup) {
  if (checkup.forecast.empty()) return;
  const health::FrameForecast& worst = busiest(checkup);
  const scene::Range steps = checkup.steps_range(), seconds = checkup.seconds_range();
  std::cout << "steps      about " << about_count_text(checkup.steps()) << " ("
            << about_count_text(steps.min) << " to " << about_count_text(steps.max) << ") in "
            << checkup.forecast.size() << " frames: ";
  if (worst.frame != 1)
    std::cout << about_count_text(checkup.forecast.front().steps) << " in frame 1, ";
  std::cout << about_count_text(worst.steps)
            << (worst.frame == 1 ? ", the most, in frame " : " in frame ") << worst.frame << " ("
            << sim::name(worst.limit) << ")";
  if (checkup.coarse_particles >= 1)
    std::cout << ", from a copy of " << about_count_text(checkup.coarse_particles) << " particles";
  std::cout << "\n";
  if (checkup.seconds_per_step <= 0) return;
  std::cout << "time       about " << seconds_text(checkup.seconds()) << " ("
            << seconds_text(seconds.min) << " to " << seconds_text(seconds.max)
            << ") of simulation, " << seconds_text(checkup.seconds_of(worst))
            << " for the busiest frame; " << rough_text(1000 * checkup.seconds_per_step)
            << " ms a step, measured now on this machine\n";
}

void print_checkup(const health::Checkup& checkup, const run::RenderJob& job,
                   const health::FastLook& look) {
  const double h = job.scene.solver.cell_size;
  std::cout << "scene      " << job.scene_file
            << (job.coarsening > 1 ? ", coarsened " + scene::coarsening_text(job.coarsening) : "")
            << "\n"
            << "particles  " << fixed_text(checkup.plan.particles, 0) << " in "
            << fixed_text(checkup.cells, 0) << " cells of " << scene::toml::number_text(h) << " m, "
            << fixed_text(checkup.plan.particles / std::max(checkup.cells, 1e-9), 1)
            << " per cell\n"
            << "memory     about " << bytes_text(checkup.plan.memory) << " of "
            << bytes_text(checkup.plan.memory_limit) << " allowed\n";
  print_limits(checkup);
  print_forecast(checkup);
  std::cout << (job.fast ? "fast       " : "faster     ") << look.sentence() << "\n";
  if (!checkup.findings.empty()) std::cout << "\n";
}

void print_findings(const health::Checkup& checkup, bool has_notes) {
  for (const health::Finding& finding : checkup.findings)
    if (has_notes || finding.severity != health::Severity::note)
      std::cout << name(finding.severity) << ": " << health::sentence(finding) << "\n";
}

/// The gain of --fast, for who has not asked for it.
health::FastLook possible_look(const run::RenderOptions& options, const run::RenderJob& job) {
  if (job.fast) return *job.fast;
  return health::fast_look(job.scene, job.frames.last,
                           scene::addresses_of(scene::parse_overrides(options.overrides)));
}

}  // namespace

int run_check(const run::RenderOptions& options) {
  const run::RenderJob job = run::make_job(options);
  const setup::Plan plan = setup::make_plan(job.scene, job.frames, job.quality, options.threads);
  catch_interrupts();
  const health::Checkup checkup = health::examine(job.scene, plan, options.threads, job.coarsening);
  const health::FastLook look = possible_look(options, job);
  // A forecast that was cut short is another one.
  if (is_interrupted()) throw Error(exit_interrupted, "interrupted before the end of the forecast");
  const bool is_quiet = options.verbosity == Verbosity::quiet;
  if (options.is_json)
    std::cout << to_text(checkup_json(checkup, job, look)) << "\n";
  else if (!is_quiet)
    print_checkup(checkup, job, look);
  if (!options.is_json) print_findings(checkup, !is_quiet);
  std::cout.flush();
  setup::check_limits(job.scene, checkup.plan, job.coarsening);
  const bool has_error =
      std::any_of(checkup.findings.begin(), checkup.findings.end(),
                  [](const health::Finding& f) { return f.severity == health::Severity::error; });
  return has_error ? exit_check_failed : exit_ok;
}

}  // namespace neve::app::cli
