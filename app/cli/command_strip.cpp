#include "app/cli/command_line.h"
#include "app/cli/commands.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "sim/shapes/held_files.h"

namespace neve::app::cli {

int run_strip_command(const run::StripOptions& options) {
  const sim::shapes::HeldFiles files;
  const run::StripJob job = run::make_strip_job(options);
  const setup::Plan plan =
      setup::make_plan(job.run.scene, job.run.frames, job.run.quality, options.run.threads);
  setup::check_limits(job.run.scene, plan, job.run.coarsening);
  catch_interrupts();
  Progress progress(options.run.verbosity, options.run.progress);
  if (scene::background_of(job.run.scene, job.run.scene.views.front()) ==
      scene::Background::transparent)
    progress.warning(
        "output.background: a strip is opaque, and draws its tiles over the gradient; the pictures "
        "of neve render are transparent");
  const run::StripResult result = run::run_strip(job, options.run, progress);
  const std::string file = job.file.string();
  if (options.run.is_json) {
    std::vector<double> drawn = job.times;
    drawn.resize(result.tiles);
    set_answer({{"file", file}, {"times", drawn}, {"is_whole", drawn.size() == job.times.size()}});
  }
  const std::string written = std::to_string(result.tiles) + " of " +
                              std::to_string(job.times.size()) + " moments" +
                              (result.tiles > 0 ? " in " + file : ", so there is no picture");
  if (result.divergence)
    throw Error(exit_diverged, result.divergence->sentence + "; drew " + written,
                job.run.scene_file, "neve render explains the cause");
  if (result.tiles < job.times.size())
    throw Error(exit_interrupted, "interrupted; drew " + written, file);
  progress.note(written);
  return exit_ok;
}

}  // namespace neve::app::cli
