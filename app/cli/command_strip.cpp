/// `neve strip`, with its command line.

#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "app/cli/command_line_parts.h"
#include "app/cli/report_error.h"
#include "app/run/strip_run.h"
#include "app/setup/argument_text.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/json.h"

namespace neve::app::cli {

namespace {

struct StripTexts {
  std::optional<std::string> at, view;
};

run::StripOptions finished_strip(const CLI::App& command, const run::RenderOptions& run,
                                 const RenderTexts& run_texts, run::StripOptions options,
                                 const StripTexts& texts) {
  const auto refuse = [](const char* flag, const std::string& what, const char* hint) {
    throw UsageError(flag, what, hint);
  };
  const auto cannot_use = [](int number) { return "cannot use " + std::to_string(number); };
  options.run = finished(run, run_texts);
  if (texts.view) options.run.views = {*texts.view};
  if (texts.at && (options.run.frames || command.count("--tiles") > 0))
    refuse("--at", "cannot be combined with --frames or --tiles", "give the times alone");
  if (texts.at) options.at = setup::parse_times(*texts.at);
  if (options.tiles && !(*options.tiles >= 1 && *options.tiles <= 200))
    refuse("--tiles", cannot_use(*options.tiles), "expected 1 to 200 moments");
  if (options.columns && (*options.columns < 0 || *options.columns > 200))
    refuse("--columns", cannot_use(*options.columns), "expected 1 to 200, or 0 for about a screen");
  if (options.width && (*options.width < 160 || *options.width > 16384))
    refuse("--width", cannot_use(*options.width), "expected 160 to 16384 pixels");
  if (command.count("--out") > 0 && std::filesystem::path(options.run.out).extension() != ".png")
    refuse("--out", "names no picture", "expected a file that ends in .png");
  check_backend(options.run.backend);
  return options;
}

int draw_strip(const run::StripOptions& options) {
  const run::StripJob job = run::make_strip_job(options);
  const setup::Plan plan =
      setup::make_plan(job.run.scene, job.run.frames, job.run.quality, options.run.threads);
  setup::check_limits(job.run.scene, plan, job.run.coarsening);
  catch_interrupts();
  Progress progress(std::cerr, options.run.verbosity, can_update_lines(STDERR_FILENO),
                    options.run.progress);
  const run::StripResult result = run::run_strip(job, options.run, progress);
  const std::string file = job.file.string();
  if (options.run.is_json) {
    std::vector<double> drawn = job.times;
    drawn.resize(result.tiles);
    std::cout << to_text({{"file", file},
                          {"times", drawn},
                          {"is_whole", drawn.size() == job.times.size()}})
              << "\n";
    finish_output();
  }
  const std::string written = std::to_string(result.tiles) + " of " +
                              std::to_string(job.times.size()) + " moments in " + file;
  if (result.divergence)
    throw Error(exit_diverged, result.divergence->sentence + "; drew " + written,
                job.run.scene_file, "neve render explains the cause");
  if (result.tiles < job.times.size())
    throw Error(exit_interrupted, "interrupted; drew " + written, file);
  progress.note(written);
  return exit_ok;
}

}  // namespace

void add_strip(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("strip", "Draw one view at several times, side by side in one picture");
  const auto run = std::make_shared<run::RenderOptions>();
  const auto run_texts = std::make_shared<RenderTexts>();
  const auto options = std::make_shared<run::StripOptions>();
  const auto texts = std::make_shared<StripTexts>();
  add_scene(*command, run, run_texts);
  command->get_option("SCENE")->description(
      "Scene file (TOML), the folder of a run, or a picture made by neve, of which a strip is made "
      "again; default: a falling snowball");
  command->add_option("--view", texts->view, "View to draw; default: the first of the scene")
      ->type_name("NAME");
  command
      ->add_option("--tiles", options->tiles,
                   "Number of moments, evenly spread over the frames; default: 6")
      ->type_name("N");
  command
      ->add_option("--frames", run_texts->frames, "Frames to spread them over: A-B, or N for 0-N")
      ->type_name("A-B");
  command->add_option("--at", texts->at, "Times in seconds instead")->type_name("T,T");
  command
      ->add_option("--columns", options->columns,
                   "Tiles beside each other; default: 0, so many that the picture has about the "
                   "shape of a screen")
      ->type_name("N");
  command
      ->add_option("--width", options->width, "Width of the whole picture in pixels; default: 1920")
      ->type_name("PX");
  command
      ->add_option("--out", run->out,
                   "Write to this file instead of out/<scene name>/strip_<view>.png")
      ->type_name("PNG");
  command->add_option("--backend", run->backend, "OpenGL backend; neve doctor lists them")
      ->type_name("NAME");
  command->add_flag("--json", run->is_json, "Print the file and its times as JSON");
  add_progress(*command, run_texts->progress, run->progress);
  CLI::Option* quiet =
      command->add_flag("--quiet,-q", run_texts->is_quiet, "Print only errors and warnings");
  command->add_flag("--verbose,-v", run_texts->is_verbose, "Print more")->excludes(quiet);
  command->final_callback([=, &action] {
    action = [=] {
      return draw_strip(finished_strip(*command, *run, *run_texts, *options, *texts));
    };
  });
}

}  // namespace neve::app::cli
