#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/devices/place.h"
#include "app/cli/devices/terminal_lines.h"
#include "app/output/atomic_file.h"
#include "app/output/folder_lock.h"
#include "app/pick/game.h"
#include "app/pick/round_noise.h"
#include "app/record/picture_record.h"
#include "app/scene/scene_file.h"
#include "app/scene/toml/toml_source.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/json.h"
#include "app/support/text.h"
#include "app/view/picker/picker.h"

namespace neve::app::cli {

namespace {

constexpr const char* ways_to_answer = "1-9, two numbers for two, 0 for none, u to undo, q to stop";

enum class Answer { click, undo, quit };

/// A line of the terminal; nothing at its end and after Ctrl-C.
std::optional<std::string> wait_for_line(devices::TerminalLines& lines) {
  while (!lines.is_at_end() && !is_interrupted())
    if (std::optional<std::string> line = lines.next(0.2)) return line;
  return std::nullopt;
}

/// Asks until the answer is one. @param click is set for Answer::click
Answer ask(const pick::Game& game, const sweep::jobs::SweepProgress& runs,
           devices::TerminalLines& lines, pick::Click& click) {
  for (const std::string& line : game.lesson().lines) std::cerr << "  " << line << "\n";
  std::cerr << fmt::format(
      "round {} of {}: {} shows the nine tiles animated, {} shows their last frame\n",
      game.answered() + 1, game.max_rounds(), (game.folder() / "round.html").string(),
      (game.folder() / "sheet.png").string());
  const pick::RoundNoise noise = pick::noise_of_round(game.folder());
  for (std::size_t tile = 0; tile < noise.tiles.size(); ++tile)
    std::cerr << fmt::format("  tile {}: {}\n", tile + 1, noise.tiles[tile]);
  if (!noise.key.empty()) std::cerr << "  " << noise.key << "\n";
  if (const std::string failed = pick::all_failed_text(runs); !failed.empty())
    std::cerr << failed << "; 0 makes nine others\n";
  while (true) {
    std::cerr << "the best tile (" << ways_to_answer << "): " << std::flush;
    const std::optional<std::string> line = wait_for_line(lines);
    if (!line || *line == "q") return Answer::quit;
    if (*line == "u") return Answer::undo;
    const std::optional<pick::Click> found = pick::click_of(*line);
    if (!found) continue;
    click = *found;
    const std::string refusal = pick::why_not(runs, click);
    if (refusal.empty()) return Answer::click;
    std::cerr << refusal << "\n";
  }
}

/// The sheet of --refine.
std::string pair_sheet(const pick::Game& game) {
  return (game.folder() / "picked_pair.cdb" / "sheet.png").string();
}

void print_pick(const pick::Game& game, const pick::PickOptions& options,
                const std::vector<scene::Override>& values) {
  const std::string scene = (game.folder() / "picked.toml").string();
  if (options.runs.is_json) {
    Json chosen = Json::object();
    for (const scene::Override& value : values) chosen[value.address] = value.value;
    std::cout << to_text({{"out", game.folder().string()},
                          {"exit_code", exit_ok},
                          {"rounds", game.answered()},
                          {"scene", scene},
                          {"sweep", (game.folder() / "picked_sweep.toml").string()},
                          {"pair", options.refines ? Json(pair_sheet(game)) : Json()},
                          {"clicks", (game.folder() / "clicks.txt").string()},
                          {"values", chosen},
                          {"learned", game.picked_lines()}})
              << "\n";
    return;
  }
  std::cout << "picked after " << game.answered()
            << (game.answered() == 1 ? " round:\n" : " rounds:\n");
  for (const scene::Override& value : values)
    std::cout << "  " << value.address << " = " << value.value << "\n";
  for (const std::string& line : game.picked_lines()) std::cout << line << "\n";
  if (options.refines) std::cout << "coarse and at full resolution: " << pair_sheet(game) << "\n";
  std::cout << "next:\n  neve render " << shell_path(scene) << "\n  neve sweep "
            << shell_path((game.folder() / "picked_sweep.toml").string()) << "\n";
}

/// Makes the nine runs, their sheet and their page. @return exit code
int make_round(pick::Game& game, sweep::jobs::SweepProgress& runs) {
  const int code = run_sweep(game.begin_round());
  // Tiles of runs that failed say so; the other ones can be chosen.
  if (code != exit_ok && code != exit_runs_failed) return code;
  runs = pick::tiles_of(sweep::jobs::progress_of(game.folder()));
  game.write_page(runs);
  return exit_ok;
}

/// @return exit code; exit_ok when the rounds are over, the list is used up or the person stops
int play_rounds(pick::Game& game, std::vector<pick::Click> list, bool asks) {
  devices::TerminalLines lines;
  while (!game.is_over()) {
    const auto next = static_cast<std::size_t>(game.answered());
    if (next >= list.size() && !asks) return exit_ok;
    sweep::jobs::SweepProgress runs;
    if (const int code = make_round(game, runs); code != exit_ok) return code;
    pick::Click click;
    Answer answer = Answer::click;
    if (next < list.size())
      click = list[next];
    else
      answer = ask(game, runs, lines, click);
    if (is_interrupted()) return exit_resumable;
    if (answer == Answer::quit) return exit_ok;
    if (answer == Answer::click) {
      game.answer(click);
      continue;
    }
    // A person takes back an answer of the list too.
    game.undo();
    list.resize(std::min(list.size(), static_cast<std::size_t>(game.answered())));
  }
  return exit_ok;
}

/// Tells the terminal what the screen waits for, which can be typed as well.
void tell_terminal(const view::picker::PickerState& state) {
  if (state.phase == view::picker::Phase::over) {
    std::cerr << "the pick is written; q or Done ends" << std::endl;
    return;
  }
  std::cerr << fmt::format("round {} of {}: choose on the screen, or type here: {}",
                           state.game.answered() + 1, state.game.max_rounds(), ways_to_answer)
            << std::endl;
}

/// Plays the rounds on a screen. @return exit code
int play_on(devices::Place& place, pick::Game& game, const pick::PickOptions& options,
            bool has_own_clock) {
  catch_interrupts();
  devices::announce(place, options.runs.is_json, options.runs.verbosity == Verbosity::quiet);
  place.set_title("neve pick - " + std::filesystem::path(options.runs.file).filename().string());
  render::Screen screen(*place.context);
  view::picker::PickerOptions picker_options;
  picker_options.has_own_clock = has_own_clock;
  devices::TerminalLines lines;
  if (devices::TerminalLines::is_there() && !has_own_clock) {
    picker_options.line = [&lines] { return lines.next(0); };
    picker_options.tell = tell_terminal;
  }
  const int code =
      view::picker::Picker(game, place.shown(), screen, std::move(picker_options)).run();
  if (place.recording) place.recording->save();
  if (code == exit_resumable)
    std::cerr << "neve: interrupted; the same command continues from here" << std::endl;
  return code;
}

/// A screen that was asked for, or that fits: a script of clicks, or input that is no terminal,
/// has none.
bool wants_screen(const pick::PickOptions& options, const view::ScreenOptions& screen) {
  if (screen.is_web || screen.is_window || !screen.replay.empty()) return true;
  return !options.is_terminal && options.clicks.empty() && devices::TerminalLines::is_there();
}

/// Empty if none was asked for and none can be had: the terminal is left.
std::optional<devices::Place> open_screen(const view::ScreenOptions& screen,
                                          const pick::PickOptions& options) {
  const bool is_asked_for = screen.is_web || screen.is_window || !screen.replay.empty();
  try {
    return devices::open_place({screen, options.runs.backend, options.runs.out, std::nullopt});
  } catch (const Error& error) {
    if (is_asked_for) throw;
    std::cerr << "neve: no page: " << error.what() << "; asking in the terminal instead"
              << std::endl;
    return std::nullopt;
  }
}

int play(pick::Game& game, const pick::PickOptions& options, const view::ScreenOptions& screen,
         const std::vector<pick::Click>& list) {
  if (!wants_screen(options, screen))
    return play_rounds(game, list, devices::TerminalLines::is_there());
  std::optional<devices::Place> place = open_screen(screen, options);
  if (!place) return play_rounds(game, list, true);
  if (const int code = play_rounds(game, list, false); code != exit_ok) return code;
  return play_on(*place, game, options, !screen.replay.empty());
}

/// True for a file with a table [sweep], whatever else is wrong with it.
bool is_sweep_file(const std::string& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error) && !record::is_picture(file) &&
         scene::toml::parse_toml(scene::read_toml_file(file), file).find("sweep") != nullptr;
}

/// Refuses what a sweep takes and a search does not. @throws UsageError
void check_axes(const std::string& file, const std::vector<std::string>& axes) {
  if (axes.empty() && is_sweep_file(file)) pick::refuse_sweep(file);
  if (axes.empty())
    throw UsageError("pick", "no parameter to find",
                     "name one, and the two values to search between: -p "
                     "material.snow.hardening=5,20");
}

/// Nothing is made and no folder is locked: answers that it has count.
int print_rounds_ahead(pick::Game& game) {
  game.resume();
  if (!game.is_over()) return run_sweep(game.plan());
  std::cerr << fmt::format("all {} rounds are answered; --rounds N asks for more\n",
                           game.max_rounds());
  return exit_ok;
}

}  // namespace

int run_pick(const PickCommand& command) {
  const pick::PickOptions& options = command.pick;
  const view::ScreenOptions& screen = command.screen;
  check_axes(options.runs.file, options.runs.axes);
  pick::Game game(options);
  if (options.runs.is_dry_run) return print_rounds_ahead(game);
  if (options.clicks.empty() && !wants_screen(options, screen) &&
      !devices::TerminalLines::is_there())
    throw UsageError("pick", "there is no terminal to ask for the best tile",
                     "run neve pick in a terminal, or give --web for a page, --window, or --clicks "
                     "FILE with one "
                     "choice a line: a tile from 1 to 9, two of them, or 0 for none");
  std::vector<pick::Click> list;
  if (!options.clicks.empty())
    list = pick::parse_clicks(pick::text_of_file(options.clicks), options.clicks);
  if (!options.clicks.empty() && list.empty())
    throw UsageError("--clicks", options.clicks + " holds no choice",
                     "expected one a line: a tile from 1 to 9, two of them, or 0 for none");
  output::make_folder(game.folder());
  const auto lock = output::FolderLock::try_lock(game.folder(), "neve pick",
                                                 output::FolderLock::Kind::alone, ".pick.lock");
  if (!lock)
    throw IoError("in use by " + output::FolderLock::holder_of(game.folder(), ".pick.lock"),
                  game.folder().string(), "wait for it, or choose another folder with --out");
  game.resume();
  if (!options.clicks.empty()) game.check_is_beginning_of(list);
  if (const int code = play(game, options, screen, list); code != exit_ok) return code;
  const auto values = game.write_pick();
  if (!values) {
    std::cerr << "nothing was chosen; the same command continues from here\n";
    return exit_ok;
  }
  // The plan of the pair takes a second, and nobody waits for it after an interrupt.
  if (options.refines && is_interrupted()) {
    std::cerr << "neve: interrupted; the same command continues from here\n";
    return exit_resumable;
  }
  const int code = options.refines ? run_sweep(game.begin_refinement()) : exit_ok;
  print_pick(game, options, *values);
  return code;
}

}  // namespace neve::app::cli
