
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "app/cli/command_line.h"
#include "app/cli/commands.h"
#include "app/health/check.h"
#include "app/output/atomic_file.h"
#include "app/picture/collider_looks.h"
#include "app/predict/predict.h"
#include "app/record/picture_record.h"
#include "app/run/render_job.h"
#include "app/scene/coarsen.h"
#include "app/scene/override.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/json.h"
#include "app/support/text.h"
#include "render/gl/context.h"
#include "render/image/image.h"
#include "render/renderer.h"

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

const forecast::FrameForecast& busiest(const std::vector<forecast::FrameForecast>& frames) {
  return *std::ranges::max_element(
      frames, {}, [](const forecast::FrameForecast& f) { return f.steps * f.cost; });
}

Json range_json(const forecast::Cost& cost) {
  return {cost.least, cost.most};
}

Json check_json(const health::Check& check, const run::RenderJob& job,
                const forecast::FastLook& look) {
  Json json = setup::to_json(check.plan);
  json["cells"] = count_json(std::round(check.cells));
  json["cell_size"] = job.scene.solver.cell_size;
  json["coarsen"] = job.coarsening;
  json["impact_speed"] = check.impact_speed;
  json["sound_speed"] = check.start.max_sound_speed;
  json["dt"] = check.dt_start;
  json["dt_limit"] = sim::name(check.limit_start);
  json["dt_limits"] = Json::object();
  for (int k = 0; k < sim::dt_limit_count; ++k)
    if (const double dt = check.start.dt[static_cast<std::size_t>(k)]; std::isfinite(dt) && dt > 0)
      json["dt_limits"][sim::name(static_cast<sim::DtLimit>(k))] = dt;
  json["frames"] = Json::array();
  for (const forecast::FrameForecast& frame : check.foreseen.frames)
    json["frames"].push_back({{"frame", scene::number_of(job.scene, frame.frame)},
                              {"dt", frame.dt},
                              {"steps", count_json(frame.steps)},
                              {"limit", sim::name(frame.limit)}});
  const forecast::Cost steps = check.foreseen.steps(), seconds = check.seconds();
  const double frames = std::max<double>(1, static_cast<double>(check.foreseen.frames.size()));
  // An unknown number is null: 0 would be a run that takes no time.
  const bool has_steps = !check.foreseen.frames.empty(),
             has_time = has_steps && check.seconds_per_step > 0;
  const auto known = [](bool is_known, const Json& value) { return is_known ? value : Json(); };
  json["steps"] = known(has_steps, count_json(steps.expected));
  json["steps_range"] = known(has_steps, range_json(steps));
  json["steps_per_frame"] = known(has_steps, steps.expected / frames);
  json["seconds_per_frame"] = known(has_time, seconds.expected / frames);
  json["seconds_per_step"] = known(has_time, check.seconds_per_step);
  json["solve_iterations"] = known(job.scene.solver.is_implicit(), check.solve.iterations);
  json["seconds"] = known(has_time, seconds.expected);
  json["seconds_range"] = known(has_time, range_json(seconds));
  json["fast"] = {
      {"is_set", job.fast.has_value()},
      {"overrides", look.overrides},
      {"work", look.work && look.work_before ? Json(*look.work / *look.work_before) : Json()}};
  json["warnings"] = Json::array();
  for (const health::Finding& finding : check.findings)
    if (finding.severity != health::Severity::note) json["warnings"].push_back(finding.what);
  json["findings"] = Json::array();
  for (const health::Finding& finding : check.findings)
    json["findings"].push_back({{"severity", name(finding.severity)},
                                {"address", finding.address},
                                {"what", finding.what},
                                {"hint", finding.hint}});
  return json;
}

void print_limits(const health::Check& check) {
  if (check.dt_start <= 0) return;
  std::cout << "sound      " << rough_text(check.start.max_sound_speed)
            << " m/s in the stiffest particle; impact at about " << rough_text(check.impact_speed)
            << " m/s\n"
            << "first step " << rough_text(check.dt_start) << " s, set by "
            << sim::name(check.limit_start) << "; allowed:";
  for (int k = 0; k < sim::dt_limit_count; ++k)
    if (const double dt = check.start.dt[static_cast<std::size_t>(k)]; std::isfinite(dt) && dt > 0)
      std::cout << " " << sim::name(static_cast<sim::DtLimit>(k)) << " " << rough_text(dt);
  std::cout << "\n";
}

void print_forecast(const scene::Scene& scene, const health::Check& check) {
  const std::vector<forecast::FrameForecast>& frames = check.foreseen.frames;
  if (frames.empty()) return;
  const forecast::FrameForecast& worst = busiest(frames);
  const forecast::Cost steps = check.foreseen.steps(), seconds = check.seconds();
  std::cout << "steps      about " << about_count_text(steps.expected) << " ("
            << about_count_text(steps.least) << " to " << about_count_text(steps.most) << ") in "
            << frames.size() << " frames: ";
  const int number = scene::number_of(scene, worst.frame);
  if (worst.frame != 1)
    std::cout << about_count_text(frames.front().steps) << " in frame "
              << scene::number_of(scene, 1) << ", ";
  std::cout << about_count_text(worst.steps)
            << (worst.frame == 1 ? ", the most, in frame " : " in frame ") << number << " ("
            << sim::name(worst.limit) << ")";
  if (check.foreseen.particles >= 1)
    std::cout << ", from a copy of " << about_count_text(check.foreseen.particles) << " particles";
  std::cout << "\n";
  if (check.seconds_per_step <= 0) return;
  std::cout << "time       about " << seconds_text(seconds.expected) << " ("
            << seconds_text(seconds.least) << " to " << seconds_text(seconds.most)
            << ") of simulation, "
            << seconds_text(worst.steps * worst.cost * check.seconds_per_step)
            << " for the busiest frame; " << rough_text(1000 * check.seconds_per_step)
            << " ms a step, measured now on this machine\n";
}

void print_check(const health::Check& check, const run::RenderJob& job,
                 const forecast::FastLook& look) {
  const double h = job.scene.solver.cell_size;
  std::cout << "scene      " << job.scene_file << scene::coarsened_words(job.scene, job.coarsening)
            << "\n"
            << "particles  " << fixed_text(check.plan.particles, 0) << " in "
            << (check.cells < 1 ? "less than a cell" : fixed_text(check.cells, 0) + " cells")
            << " of " << scene::toml::number_text(h) << " m"
            << (check.cells < 1
                    ? ""
                    : ", " + fixed_text(check.plan.particles / check.cells, 1) + " per cell")
            << "\n"
            << "memory     about " << bytes_text(check.plan.memory) << " of "
            << bytes_text(check.plan.memory_limit) << " allowed\n";
  print_limits(check);
  print_forecast(job.scene, check);
  std::cout << (job.fast ? "fast       " : "faster     ") << look.sentence() << "\n";
  if (!check.findings.empty()) std::cout << "\n";
}

void print_findings(const health::Check& check, bool has_notes) {
  for (const health::Finding& finding : check.findings)
    if (has_notes || finding.severity != health::Severity::note)
      std::cout << name(finding.severity) << ": " << health::sentence(finding) << "\n";
}

/// The gain of --fast, for who has not asked for it.
forecast::FastLook possible_look(const run::RenderOptions& options, const run::RenderJob& job) {
  if (job.fast) return *job.fast;
  return forecast::fast_look(job.scene, job.frames.last,
                             scene::addresses_of(scene::parse_overrides(options.overrides)),
                             options.coarsening.value_or(1));
}

/// Says where there is none to write.
void write_open_edges(const run::RenderOptions& options, const scene::Scene& scene) {
  const std::optional<render::Frame> frame = picture::open_edges_frame(scene);
  if (!frame) {
    std::cerr << "no mesh is open: there is no picture " << options.open_edges << "\n";
    return;
  }
  const auto context = render::gl::open_context(options.backend);
  render::Renderer renderer(*context, options.shader_dir, nullptr);
  record::SheetRecord record;
  record.what = "the open meshes of a scene";
  record.scenes = {{"scene", scene::write_scene(scene)}};
  record.again = "neve check SCENE --open-edges FILE.png";
  output::write_file(options.open_edges,
                     render::encode_png(renderer.draw(*frame), record::to_png_text(record)));
}

predict::Prediction predicted(const run::RenderJob& job, const health::Check& check,
                              const run::RenderOptions& options) {
  setup::check_limits(job.scene, check.plan, job.coarsening);
  Progress progress(options.verbosity);
  return predict::make_prediction(job.scene, job.frames.last, check.seconds().expected,
                                  options.threads, progress);
}

}  // namespace

int run_check(const run::RenderOptions& given) {
  run::RenderOptions options = given;
  options.is_start_only = true;
  const run::RenderJob job = run::make_job(options);
  const setup::Plan plan = setup::make_plan(job.scene, job.frames, job.quality, options.threads);
  catch_interrupts();
  // Half a forecast would be a wrong one.
  const NothingToKeep reading;
  const health::Check check =
      health::examine(job.scene, plan, options.threads, job.coarsening,
                      scene::addresses_of(scene::parse_overrides(options.overrides)));
  const forecast::FastLook look = possible_look(options, job);
  const bool is_quiet = options.verbosity == Verbosity::quiet;
  std::optional<predict::Prediction> prediction;
  if (options.predicts) prediction = predicted(job, check, options);
  if (options.is_json) {
    Json json = check_json(check, job, look);
    if (prediction) json["prediction"] = predict::to_json(*prediction);
    set_answer(std::move(json));
  } else if (!is_quiet) {
    print_check(check, job, look);
  }
  if (prediction && !options.is_json) std::cout << predict::text_of(*prediction) << "\n";
  if (!options.is_json) print_findings(check, !is_quiet);
  std::cout.flush();
  if (!options.open_edges.empty()) write_open_edges(options, job.scene);
  setup::check_limits(job.scene, check.plan, job.coarsening);
  const bool has_error = std::ranges::find(check.findings, health::Severity::error,
                                           &health::Finding::severity) != check.findings.end();
  return has_error ? exit_check_failed : exit_ok;
}

}  // namespace neve::app::cli
