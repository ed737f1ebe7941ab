/// The command line of `neve view`.

#include <memory>
#include <optional>

#include "app/cli/command_line_parts.h"
#include "app/cli/commands.h"
#include "app/cli/devices/screen_flags.h"
#include "app/scene/toml/error.h"
#include "app/setup/argument_text.h"
#include "app/timeline/origin.h"

namespace neve::app::cli {

namespace {

view::ViewOptions finished_view(view::ViewOptions options, const run::RenderOptions& run,
                                const RenderTexts& run_texts,
                                const std::optional<std::string>& listen,
                                const std::optional<std::string>& at) {
  options.run = finished(run, run_texts);
  if (at) options.at = setup::parse_time(*at, "--at");
  if (options.at && !timeline::is_folder(options.run.scene))
    throw scene::toml::UsageError(
        "--at", "shows a moment that a run has kept",
        "expected the folder of a run, as in neve view out/snowball_drop");
  devices::finish_screen(options.screen, listen);
  if (options.screen.pictures < 0)
    throw scene::toml::UsageError("--frames",
                                  "cannot use " + std::to_string(options.screen.pictures),
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
  const auto at = std::make_shared<std::optional<std::string>>();
  add_origin(*command, run, run_texts);
  devices::add_place(*command, options->screen, *listen);
  add_repeatable(*command, "--view", run->views, "NAME", "View to show first");
  command->add_flag("--run", options->is_running, "Start simulating at once");
  command
      ->add_option(
          "--at", *at,
          "Show a run at this time in seconds, as in 0.25s, or at the nearest moment before "
          "it that the run has kept; default: its last")
      ->type_name("T");
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
    action = [=] { return run_view(finished_view(*options, *run, *run_texts, *listen, *at)); };
  });
}

}  // namespace neve::app::cli
