/// The command line of `neve pick`.

#include <memory>
#include <optional>

#include "app/cli/command_line_parts.h"
#include "app/cli/devices/screen_flags.h"
#include "app/scene/scene_file.h"
#include "app/setup/argument_text.h"
#include "app/support/errors.h"

namespace neve::app::cli {

namespace {

/// Values of neve pick that CLI11 hands over as text.
struct PickTexts {
  std::optional<std::string> frames, size, coarsening, listen;
  view::ScreenOptions screen;
  bool is_quiet = false;
};

pick::PickOptions finished_pick(pick::PickOptions options, const PickTexts& texts) {
  sweep::plan::SweepOptions& runs = options.runs;
  runs.file = scene::path_of_scene(runs.file);
  if (texts.frames) runs.frames = setup::parse_frames(*texts.frames);
  if (texts.size) runs.size = setup::parse_size(*texts.size);
  if (texts.coarsening) runs.coarsening = setup::parse_coarsening(*texts.coarsening);
  if (texts.is_quiet) runs.verbosity = Verbosity::quiet;
  constexpr int most_rounds = 100;
  if (options.rounds < 1 || options.rounds > most_rounds)
    throw UsageError("--rounds", "cannot use " + std::to_string(options.rounds),
                     "expected 1 to " + std::to_string(most_rounds));
  check_threads(runs.threads);
  check_backend(runs.backend);
  return options;
}

/// @throws UsageError
view::ScreenOptions finished_place(const PickTexts& texts, bool is_terminal) {
  view::ScreenOptions screen = texts.screen;
  devices::finish_screen(screen, texts.listen);
  if (is_terminal && (screen.is_web || screen.is_window || !screen.replay.empty()))
    throw UsageError("--terminal", "cannot be combined with --window, --web or --replay",
                     "choose one");
  return screen;
}

}  // namespace

void add_pick(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "pick",
      "Find the snow that is meant by choosing the best of nine moving tiles, round by round");
  const auto options = std::make_shared<pick::PickOptions>();
  const auto texts = std::make_shared<PickTexts>();
  sweep::plan::SweepOptions& runs = options->runs;
  command->add_option("SCENE", runs.file, "Scene file (TOML)")->required()->type_name("");
  add_repeatable(*command, "-p,--parameter", runs.axes, "ADDRESS=LOW,HIGH",
                 "A parameter to find between two values, as in material.snow.hardening=5,20; in "
                 "ratios where they are a factor of ten or more apart (repeatable, at most 8)");
  add_repeatable(*command, "--set", runs.overrides, "ADDRESS=VALUE",
                 "Change a parameter of all runs (repeatable)");
  command->add_option("--rounds", options->rounds, "Number of rounds")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option(
          "--clicks", options->clicks,
          "Replay a list of choices, one round a line: a tile from 1 to 9, two of them, or "
          "0 for none; then ask, if there is a terminal")
      ->type_name("FILE");
  devices::add_place(*command, texts->screen, texts->listen);
  command->add_flag("--terminal", options->is_terminal,
                    "Ask in the terminal; DIR/round.html shows the tiles");
  devices::add_scripts(*command, texts->screen);
  command
      ->add_option("--seed", options->seed,
                   "Seed of the tiles; the same clicks with the same "
                   "seed give the same pick, bit for bit")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--frames", texts->frames, "Frames of each run: A-B, or N for 0-N")
      ->type_name("A-B");
  command->add_option("--size", texts->size, "Size of a tile; default: 480 pixels wide")
      ->type_name("WxH");
  command
      ->add_option("--coarsen", texts->coarsening,
                   "Make cells N times as large in all tiles; the picked scene keeps its own")
      ->type_name("N");
  command->add_option("--out", runs.out, "Output folder instead of out/<name of the scene>.pick")
      ->type_name("DIR");
  command->add_option("--threads", runs.threads, "Number of cores; 0: all")->type_name("N");
  command->add_option("--backend", runs.backend, "OpenGL backend; neve doctor lists them")
      ->type_name("NAME");
  add_caps(*command);
  command->add_flag("--json", runs.is_json, "Print the result, or the error, as JSON");
  command->add_flag("--quiet,-q", texts->is_quiet, "Print only errors, warnings and questions");
  command->final_callback([=, &action] {
    if (command->count("--out") > 0 && options->runs.out.empty())
      throw UsageError("--out", "names no folder", "expected the path of a folder");
    action = [=] {
      return run_pick(finished_pick(*options, *texts),
                      finished_place(*texts, options->is_terminal));
    };
  });
}

}  // namespace neve::app::cli
