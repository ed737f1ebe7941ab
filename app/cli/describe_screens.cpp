/// Options of the commands that have a screen: a window, a page or a script.

#include "app/cli/commands.h"
#include "app/options/common.h"
#include "app/options/languages.h"
#include "app/support/errors.h"
#include "app/timeline/origin.h"

namespace neve::app::cli {

namespace {

using options::Command;

/// "127.0.0.1", "0.0.0.0:8080", ":8080", "[::1]:8080", "::1"
void read_address(const std::string& text, view::ScreenOptions& screen) {
  const std::size_t bracket = text.find(']'), colon = text.rfind(':');
  const bool has_brackets = bracket != std::string::npos;
  // Several colons are of an address without a port.
  const bool has_port =
      colon != std::string::npos && (has_brackets ? colon > bracket : text.find(':') == colon);
  const std::string port = has_port ? text.substr(colon + 1) : "";
  const std::optional<int> number = number_of<int>(port);
  if ((has_brackets && text.front() != '[') ||
      (has_port && !(number && *number >= 0 && *number <= 65535)))
    throw UsageError("--listen", "cannot use \"" + text + "\"",
                     "expected an address, a :PORT, or both, as in 127.0.0.1:8080");
  screen.listen = has_brackets ? text.substr(1, bracket - 1)
                  : has_port   ? text.substr(0, colon)
                               : text;
  screen.port = number.value_or(0);
  screen.is_web = true;
}

std::string address_text(const view::ScreenOptions& screen) {
  const bool has_colons = screen.listen.find(':') != std::string::npos;
  return (has_colons ? "[" + screen.listen + "]" : screen.listen) +
         (screen.port > 0 ? ":" + std::to_string(screen.port) : "");
}

/// The place of the screen.
void describe_place(Command& visit, view::ScreenOptions& screen) {
  visit("--window", screen.is_window, "Open a window; default with a display")
      .excludes({"--web", "--listen"}, "choose one");
  visit("--web", screen.is_web, "Serve a web page to this machine only; default without a display");
  visit.custom(
      "--listen", "ADDRESS[:PORT]", "127.0.0.1:8080",
      [&screen](const std::string& text) { read_address(text, screen); },
      [&screen] { return address_text(screen); },
      "Serve the web page at this address; any address but 127.0.0.1 is reachable from other "
      "machines");
  visit("--public-url", screen.public_url, options::text("URL", "https://hub/user/x/proxy/8080/"),
        "Address at which a proxy shows the web page; with --listen :PORT, which the proxy reaches")
      .excludes({"--window", "--replay"}, "remove one");
  visit.check([&screen] { screen.is_web = screen.is_web || !screen.public_url.empty(); });
}

void describe_scripts(Command& visit, view::ScreenOptions& screen) {
  visit("--replay", screen.replay, options::text("FILE", "script.json"),
        "Replay a script of input, without a window; docs/view.md describes scripts")
      .excludes({"--window", "--web", "--listen", "--record"}, "remove the others");
  visit("--record", screen.record, options::text("FILE", "script.json"),
        "Record the input as a script for --replay");
}

}  // namespace

void describe_view(Command& visit, view::ViewOptions& o) {
  visit.about("view", "Inspect and change a running simulation, in a window or in a browser");
  describe_scene(visit, o.run, run::origin_help);
  visit("--at", o.at, options::time(),
        "Show a run at this time in seconds, as in 0.25s, or at the nearest kept moment before it; "
        "default: the last moment");
  describe_place(visit, o.screen);
  visit("--view", o.run.views, options::text("NAME", "smoke"), "View to show first").once();
  visit("--run", o.is_running, "Start simulating at once");
  visit(
      "--live", o.is_live,
      "Choose cells and steps, as --coarsen and --fast do, with which simulated time keeps up with "
      "the clock on this machine, and say which; a look of some seconds")
      .excludes({"--coarsen", "--fast"}, "--live chooses both");
  visit("--size", o.run.size, options::size(), "Size of the window, or initial size of the page");
  visit("--out", o.run.out, options::folder(),
        "Folder for pictures, scenes and sweeps instead of out/<scene name>-view");
  options::describe_backend(visit, o.run.backend,
                            "OpenGL backend of the page; neve doctor lists them");
  describe_scripts(visit, o.screen);
  visit("--frames", o.screen.pictures,
        options::number<int>("N", 0, 1e9, "the number of pictures to show before the end, or 0"),
        "End after N pictures; 0: never");
  visit("--shader-dir", o.run.shader_dir, options::existing_folder("the files of shaders/"),
        "Read shaders from this folder");
  visit("--json", o.run.is_json, "Print the address, or the error, as JSON");
  options::describe_verbosity(visit, o.run.verbosity, nullptr,
                              "Print only errors, warnings and the address");
  visit.check([&o] {
    if (o.at && !timeline::is_folder(o.run.scene))
      throw UsageError("--at", "shows a moment that a run has kept",
                       "expected the folder of a run, as in neve view out/snowball_drop");
  });
}

void describe_pick(Command& visit, PickCommand& o) {
  sweep::plan::SweepOptions& runs = o.pick.runs;
  visit.about("pick", "Tune by eye: choose the best of nine animated tiles, round by round");
  visit("SCENE", runs.file, options::scene_file(), "Scene file (TOML)").required();
  visit("-p,--parameter", runs.axes,
        options::text("ADDRESS=LOW,HIGH", "material.snow.hardening=5,20"),
        "A parameter to find between two values, as in material.snow.hardening=5,20; a range of a "
        "factor of ten or more is searched in ratios (repeatable, at most 8)");
  visit("--set", runs.overrides, options::text("ADDRESS=VALUE", "material.snow.hardening=5"),
        "Change a parameter of all runs (repeatable)");
  visit("--rounds", o.pick.rounds, options::number<int>("N", 1, 100, "1 to 100"),
        "Number of rounds")
      .with_default();
  visit("--clicks", o.pick.clicks, options::text("FILE", "clicks.txt"),
        "Replay a list of choices, one round a line: a tile from 1 to 9, two of them, or 0 for "
        "none; then ask for more, in a terminal");
  describe_place(visit, o.screen);
  visit("--terminal", o.pick.is_terminal, "Ask in the terminal; DIR/round.html shows the tiles")
      .excludes({"--window", "--web", "--listen", "--replay"}, "choose one");
  describe_scripts(visit, o.screen);
  visit("--seed", o.pick.seed, options::number<std::uint64_t>("N", 0, 1.8e19, "a whole number"),
        "Seed of the tiles; the same clicks with the same seed give the same pick, bit for bit")
      .with_default();
  visit("--seeds", runs.seeds, sweep::plan::seeds(),
        "Make N runs of each tile, with the scene's seed and those after it: tiles say how often "
        "the snow breaks, and which of them are too close to call; N times the cost");
  visit("--frames", runs.frames, options::frames(),
        "Frames of each run: A-B, or N for all up to N");
  visit("--size", runs.size, options::size(), "Size of a tile; default: 480 pixels wide");
  sweep::plan::describe_tiles(visit, runs);
  visit("--coarsen", runs.coarsening, options::coarsening(),
        "Make cells N times as large in all tiles; the picked scene keeps its cell_size");
  visit("--fast", runs.is_fast,
        "Take longer steps in all tiles for a quick look; the picked scene keeps its own");
  visit("--refine", o.pick.refines,
        "With --coarsen N: at the end make the pick at full resolution as well, with all --seeds, "
        "and "
        "show both beside each other in DIR/picked_pair.cdb/sheet.png");
  visit("--dry-run", runs.is_dry_run,
        "Print the runs of the next round, and the cost of all rounds; start nothing");
  visit("--out", runs.out, options::folder("round.html"),
        "Output folder instead of out/<name of the scene>.pick");
  options::describe_threads(visit, runs.threads, "Number of cores; 0: all");
  options::describe_backend(visit, runs.backend);
  options::describe_caps(visit, runs.caps);
  visit("--json", runs.is_json, options::json_help);
  options::describe_verbosity(visit, runs.verbosity, nullptr,
                              "Print only errors, warnings and questions");
  visit.check([&o] {
    if (o.pick.refines && !(o.pick.runs.coarsening.value_or(1) > 1))
      throw UsageError("--refine", "makes the pick at full resolution, as all tiles are already",
                       "add --coarsen 2 for the tiles, or remove --refine");
  });
}

}  // namespace neve::app::cli
