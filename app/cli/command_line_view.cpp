/// The command line of `neve view`.

#include <memory>
#include <optional>

#include "app/cli/command_line_parts.h"
#include "app/cli/commands.h"
#include "app/cli/devices/screen_flags.h"
#include "app/setup/argument_text.h"
#include "app/support/errors.h"

namespace neve::app::cli {

namespace {

view::ViewOptions finished_view(view::ViewOptions options, const run::RenderOptions& run,
                                const RenderTexts& run_texts,
                                const std::optional<std::string>& listen) {
  options.run = finished(run, run_texts);
  devices::finish_screen(options.screen, listen);
  if (options.screen.pictures < 0)
    throw UsageError("--frames", "cannot use " + std::to_string(options.screen.pictures),
                     "expected the number of pictures to show before the end");
  return options;
}

}  // namespace

void add_view(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "view", "Inspect and change a running simulation, in a window or in a browser");
  const auto options = std::make_shared<view::ViewOptions>();
  const auto run = std::make_shared<run::RenderOptions>();
  const auto run_texts = std::make_shared<RenderTexts>();
  const auto listen = std::make_shared<std::optional<std::string>>();
  add_scene(*command, run, run_texts);
  devices::add_place(*command, options->screen, *listen);
  add_repeatable(*command, "--view", run->views, "NAME", "View to show first");
  command->add_flag("--run", options->is_running, "Start simulating at once");
  command->add_option("--size", run_texts->size, "Size of the window, or initial size of the page")
      ->type_name("WxH");
  command
      ->add_option("--out", run->out,
                   "Folder for pictures, scenes and sweeps instead of out/<scene name>-view")
      ->type_name("DIR");
  command
      ->add_option("--backend", run->backend, "OpenGL backend of the page; neve doctor lists them")
      ->type_name("NAME");
  devices::add_scripts(*command, options->screen);
  command->add_option("--frames", options->screen.pictures, "End after N pictures; 0: never")
      ->type_name("N");
  command->add_option("--shader-dir", run->shader_dir, "Read shaders from this folder")
      ->type_name("DIR");
  command->add_flag("--json", run->is_json, "Print the address, or the error, as JSON");
  command->add_flag("--quiet,-q", run_texts->is_quiet,
                    "Print only errors, warnings and the address");
  command->final_callback([=, &action] {
    action = [=] { return run_view(finished_view(*options, *run, *run_texts, *listen)); };
  });
}

}  // namespace neve::app::cli
