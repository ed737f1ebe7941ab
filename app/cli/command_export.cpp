#include "app/cli/command_line.h"
#include "app/cli/commands.h"
#include "app/exports/encode.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "sim/shapes/held_files.h"

namespace neve::app::cli {

int run_export(const ExportCommand& command) {
  const sim::shapes::HeldFiles files;
  run::ExportOptions options{command.run, {}, command.at};
  for (const scene::ExportFormat format : command.formats) {
    options.exports.push_back(command.common);
    options.exports.back().format = format;
    // An export without a name has its number, as in a scene file.
    options.exports.back().name = std::to_string(options.exports.size());
  }
  const run::ExportJob job = run::make_export_job(options);
  const setup::Plan plan =
      setup::make_plan(job.run.scene, job.run.frames, setup::Quality::draft, options.run.threads);
  setup::check_limits(job.run.scene, plan, job.run.coarsening);
  for (const scene::Export& e : job.run.scene.exports)
    exports::check_capacity(e, exports::empty_table(job.run.scene, e, {}), plan.particles);
  catch_interrupts();
  Progress progress(options.run.verbosity, options.run.progress);
  const run::ExportResult result = run::run_export(job, options.run.threads, progress);
  const std::string folder = job.run.folder.string();
  if (options.run.is_json) {
    Json json;
    json["out"] = folder;
    json["is_whole"] = result.is_whole;
    json["exports"] = result.exports;
    set_answer(std::move(json));
  }
  const std::string written = std::to_string(result.moments) +
                              (result.moments == 1 ? " moment" : " moments") + " in " + folder;
  if (result.divergence)
    throw Error(exit_diverged, result.divergence->sentence + "; wrote " + written,
                job.run.scene_file, "neve render explains the cause");
  if (!result.is_whole) throw Error(exit_interrupted, "interrupted; wrote " + written, folder);
  progress.note(written);
  return exit_ok;
}

}  // namespace neve::app::cli
