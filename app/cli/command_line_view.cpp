/// The command line of `neve view`.

#include <memory>
#include <optional>

#include "app/cli/command_line_parts.h"
#include "app/cli/commands.h"
#include "app/scene/toml/error.h"
#include "app/setup/argument_text.h"

namespace neve::app::cli {

namespace {

/// "127.0.0.1", "0.0.0.0:8080", ":8080", "[::1]:8080"
void parse_listen(const std::string& text, view::ViewOptions& options) {
  const auto fail = [&]() -> void {
    throw scene::toml::UsageError("--listen", "cannot use \"" + text + "\"",
                                  "expected an address, a :PORT, or both, as in 127.0.0.1:8080");
  };
  std::string port;
  const std::size_t bracket = text.find(']');
  const std::size_t colon = text.rfind(':');
  if (bracket != std::string::npos) {
    if (text.front() != '[') fail();
    options.listen = text.substr(1, bracket - 1);
    if (colon != std::string::npos && colon > bracket) port = text.substr(colon + 1);
  } else if (colon == std::string::npos) {
    options.listen = text;
  } else {
    options.listen = text.substr(0, colon);
    port = text.substr(colon + 1);
    if (port.empty()) fail();
  }
  if (port.empty()) return;
  if (port.size() > 5 || port.find_first_not_of("0123456789") != std::string::npos) fail();
  options.port = std::stoi(port);
  if (options.port < 1 || options.port > 65535) fail();
}

view::ViewOptions finished_view(view::ViewOptions options, const run::RenderOptions& run,
                                const RenderTexts& run_texts,
                                const std::optional<std::string>& listen) {
  options.run = finished(run, run_texts);
  if (listen) {
    parse_listen(*listen, options);
    options.is_web = true;
  }
  if (options.is_web && options.is_window)
    throw scene::toml::UsageError("--window", "and --web exclude each other", "choose one");
  if (!options.replay.empty() && (options.is_web || options.is_window || !options.record.empty()))
    throw scene::toml::UsageError("--replay", "cannot be combined with --window, --web or --record",
                                  "remove the others");
  if (options.pictures < 0)
    throw scene::toml::UsageError("--frames", "cannot use " + std::to_string(options.pictures),
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
  command->add_flag("--window", options->is_window, "Open a window; default with a display");
  command->add_flag("--web", options->is_web,
                    "Serve a web page to this machine only; default without a display");
  command
      ->add_option("--listen", *listen,
                   "Serve the web page at this address; any address but 127.0.0.1 is reachable "
                   "from other machines")
      ->type_name("ADDRESS[:PORT]");
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
  command
      ->add_option("--replay", options->replay,
                   "Replay a script of input, without a window; docs/view.md describes scripts")
      ->type_name("FILE");
  command->add_option("--record", options->record, "Record the input as a script for --replay")
      ->type_name("FILE");
  command->add_option("--frames", options->pictures, "End after N pictures; 0: never")
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
