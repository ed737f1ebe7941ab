#include "app/cli/devices/screen_flags.h"

#include <cstddef>

#include "app/support/errors.h"

namespace neve::app::cli::devices {

namespace {

/// "127.0.0.1", "0.0.0.0:8080", ":8080", "[::1]:8080"
void parse_listen(const std::string& text, view::ScreenOptions& options) {
  const auto fail = [&]() -> void {
    throw UsageError("--listen", "cannot use \"" + text + "\"",
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

}  // namespace

void add_place(CLI::App& command, view::ScreenOptions& screen, std::optional<std::string>& listen) {
  command.add_flag("--window", screen.is_window, "Open a window; default with a display");
  command.add_flag("--web", screen.is_web,
                   "Serve a web page to this machine only; default without a display");
  command
      .add_option("--listen", listen,
                  "Serve the web page at this address; any address but 127.0.0.1 is reachable "
                  "from other machines")
      ->type_name("ADDRESS[:PORT]");
}

void add_scripts(CLI::App& command, view::ScreenOptions& screen) {
  command
      .add_option("--replay", screen.replay,
                  "Replay a script of input, without a window; docs/view.md describes scripts")
      ->type_name("FILE");
  command.add_option("--record", screen.record, "Record the input as a script for --replay")
      ->type_name("FILE");
}

void finish_screen(view::ScreenOptions& options, const std::optional<std::string>& listen) {
  if (listen) {
    parse_listen(*listen, options);
    options.is_web = true;
  }
  if (options.is_web && options.is_window)
    throw UsageError("--window", "and --web exclude each other", "choose one");
  if (!options.replay.empty() && (options.is_web || options.is_window || !options.record.empty()))
    throw UsageError("--replay", "cannot be combined with --window, --web or --record",
                     "remove the others");
}

}  // namespace neve::app::cli::devices
