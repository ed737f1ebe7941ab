#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/output/atomic_file.h"
#include "app/output/folder_lock.h"
#include "app/output/sequence.h"
#include "app/pick/clicks.h"
#include "app/pick/files.h"
#include "app/pick/learned.h"
#include "app/pick/page.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/command_text.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/json.h"
#include "app/support/out_folder.h"
#include "app/sweep/read/read_sweep.h"
#include "app/sweep/store/results.h"

namespace neve::app::cli {

namespace {

namespace fs = std::filesystem;

std::string text_of_file(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = output::read_file(file);
  return {bytes.begin(), bytes.end()};
}

/// A search in its folder: rounds that are answered, and how to make the next one.
class PickGame {
 public:
  explicit PickGame(const pick::PickOptions& options) : options_(options) {
    const sweep::read::Sweep sweep =
        sweep::read::read_sweep(options.runs.file, {options.runs.axes, options.runs.overrides});
    if (!sweep.file.empty())
      throw scene::toml::UsageError("pick", options.runs.file + " is a sweep",
                                    "give its scene, and the axes with -p");
    scene_ = {options.runs.file, sweep.fixed, pick::axes_of(sweep)};
    // Complains about settings before anything is written.
    pick::picked_scene(scene_, pick::search::Point::Constant(dimension(), 0.5));
    folder_ = options.runs.out.empty() ? out_folder() / (sweep.name + ".pick")
                                       : fs::path(options.runs.out);
    own_clicks_ = folder_ / "clicks.txt";
  }

  const fs::path& folder() const { return folder_; }
  int answered() const { return static_cast<int>(rounds_.size()); }
  bool is_over() const { return answered() >= options_.rounds; }

  /// Takes up what the folder has. @throws UsageError for the folder of another search
  void resume() {
    std::error_code error;
    if (!fs::exists(own_clicks_, error)) return;
    const std::string text = text_of_file(own_clicks_);
    if (!text.starts_with(pick::clicks_text({}, comment())))
      throw scene::toml::UsageError(folder_.string(),
                                    "has another search: " + text.substr(2, text.find('\n') - 2),
                                    "choose another folder with --out, or remove the old one");
    for (const pick::Click& click : pick::parse_clicks(text, own_clicks_.string()))
      if (!is_over()) take(click);
  }

  /// The answers so far must be the beginning of the list. @throws UsageError
  void check_is_beginning_of(const std::vector<pick::Click>& list) const {
    for (std::size_t k = 0; k < rounds_.size(); ++k)
      if (k >= list.size() || rounds_[k].chosen != list[k])
        throw scene::toml::UsageError(
            options_.clicks,
            fmt::format("{} has other clicks from round {} on", folder_.string(), k + 1),
            "choose another folder with --out, or remove the old one");
  }

  /// Makes the nine runs, their sheet and their page. @return exit code
  int make_round() {
    tiles_ = pick::search::next_tiles(rounds_, dimension(), options_.seed);
    output::make_folder(folder_);
    const fs::path file = folder_ / fmt::format("round_{}.toml", answered() + 1);
    output::write_file(file, pick::round_sweep(scene_, folder_, answered() + 1, tiles_));
    sweep::plan::SweepOptions runs = options_.runs;
    runs.file = file.string();
    runs.axes.clear();
    runs.overrides.clear();
    runs.out = folder_.string();
    runs.is_json = false;
    const int code = run_sweep(runs);
    // Tiles of runs that failed say so; the other ones can be chosen.
    if (code != exit_ok && code != exit_runs_failed) return code;
    write_page();
    return exit_ok;
  }

  void answer(const pick::Click& click) {
    take(click);
    write_clicks();
  }

  void undo() {
    if (rounds_.empty()) return;
    rounds_.pop_back();
    write_clicks();
  }

  std::vector<std::string> learned_lines() const {
    const Learned learned = learn();
    return learned.favourite.size() == 0
               ? std::vector<std::string>{}
               : pick::taste_lines(scene_.axes, learned.tastes, learned.favourite);
  }

  /// Writes scene, sweep, words and map of the pick. @return its values; nothing without a choice
  std::optional<std::vector<scene::Override>> write_pick() const {
    const Learned learned = learn();
    if (learned.favourite.size() == 0) return std::nullopt;
    const pick::search::Point result = pick::search::result_of(rounds_, learned.taste);
    output::write_file(folder_ / "picked.toml", pick::picked_scene(scene_, result));
    std::vector<std::size_t> order;
    for (const pick::AxisTaste& taste : learned.tastes) order.push_back(taste.axis);
    output::write_file(folder_ / "picked_sweep.toml",
                       pick::picked_sweep(scene_, "picked.toml", result, order));
    output::write_file(folder_ / "learned.txt",
                       fmt::format("{}\n", fmt::join(learned_lines(), "\n")));
    output::write_file(folder_ / "map.svg", map_of(learned));
    return pick::settings_at(scene_.axes, result);
  }

 private:
  struct Learned {
    pick::search::Preference taste;
    pick::search::Point favourite;  ///< empty before the first choice
    std::vector<pick::AxisTaste> tastes;
  };

  int dimension() const { return static_cast<int>(scene_.axes.size()); }

  void take(const pick::Click& click) {
    if (tiles_.empty()) tiles_ = pick::search::next_tiles(rounds_, dimension(), options_.seed);
    rounds_.push_back({tiles_, click});
    tiles_.clear();
  }

  /// Says which search the clicks are of.
  std::vector<std::string> comment() const {
    std::string what = scene_.file;
    for (const pick::PickAxis& axis : scene_.axes)
      what += fmt::format(", {} {} to {}{}", axis.address, axis.text(0), axis.text(1),
                          axis.is_logarithmic ? " in ratios" : "");
    for (const scene::Override& change : scene_.fixed)
      what += ", " + change.address + " = " + change.value;
    if (options_.runs.coarsening)
      what += fmt::format(", coarsened by {}", *options_.runs.coarsening);
    return {fmt::format("{}, seed {}", what, options_.seed),
            "One round a line: the tile chosen, two of them, or 0 for none."};
  }

  void write_clicks() const {
    std::vector<pick::Click> clicks;
    for (const pick::search::Round& round : rounds_) clicks.push_back(round.chosen);
    output::write_file(own_clicks_, pick::clicks_text(clicks, comment()));
  }

  Learned learn() const {
    Learned learned{pick::search::learn(rounds_, dimension()), {}, {}};
    learned.favourite = pick::search::favourite(rounds_, learned.taste);
    if (learned.favourite.size() > 0)
      learned.tastes = pick::axis_tastes(scene_.axes, learned.taste, learned.favourite);
    return learned;
  }

  std::string map_of(const Learned& learned) const {
    return pick::taste_map(scene_.axes, learned.taste, rounds_, learned.tastes, learned.favourite);
  }

  void write_page() const {
    const sweep::store::Manifest manifest = sweep::store::read_manifest(folder_);
    pick::RoundPage page;
    page.round = answered() + 1;
    page.rounds = options_.rounds;
    page.fps = manifest.fps;
    const std::vector<sweep::store::RunResult> results =
        sweep::store::read_results(folder_, manifest);
    for (std::size_t k = 0; k < results.size(); ++k) {
      std::vector<std::string>& pictures = page.tiles.emplace_back();
      for (const int frame : results[k].frames)
        pictures.push_back(
            output::frame_path(fs::path("runs") / manifest.runs[k].folder, manifest.view, frame)
                .generic_string());
    }
    const Learned learned = learn();
    page.has_favourite = learned.favourite.size() > 0;
    if (page.has_favourite) {
      page.learned = learned_lines();
      page.map = map_of(learned);
    }
    output::write_file(folder_ / "round.html", pick::page_html(page));
  }

  const pick::PickOptions options_;
  pick::SearchScene scene_;
  fs::path folder_, own_clicks_;
  std::vector<pick::search::Round> rounds_;
  std::vector<pick::search::Point> tiles_;  ///< of the round that is not answered
};

enum class Answer { click, undo, quit };

/// Asks until the answer is one. @param click is set for Answer::click
Answer ask(const PickGame& game, const pick::PickOptions& options, pick::Click& click) {
  for (const std::string& line : game.learned_lines()) std::cerr << "  " << line << "\n";
  std::cerr << fmt::format("round {} of {}: {} has the nine tiles, moving; {} their last frame\n",
                           game.answered() + 1, options.rounds,
                           (game.folder() / "round.html").string(),
                           (game.folder() / "sheet.png").string());
  while (true) {
    std::cerr << "the best tile (1-9, two numbers for two, 0 for none, u to undo, q to stop): "
              << std::flush;
    std::string line;
    if (!std::getline(std::cin, line) || line == "q") return Answer::quit;
    if (line == "u") return Answer::undo;
    if (const std::optional<pick::Click> found = pick::click_of(line)) {
      click = *found;
      return Answer::click;
    }
  }
}

void print_pick(const PickGame& game, const pick::PickOptions& options,
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
                          {"clicks", (game.folder() / "clicks.txt").string()},
                          {"values", chosen},
                          {"learned", game.learned_lines()}})
              << "\n";
    return;
  }
  std::cout << "picked after " << game.answered()
            << (game.answered() == 1 ? " round:\n" : " rounds:\n");
  for (const scene::Override& value : values)
    std::cout << "  " << value.address << " = " << value.value << "\n";
  for (const std::string& line : game.learned_lines()) std::cout << line << "\n";
  std::cout << "next:\n  neve render " << setup::shell_word(scene) << "\n  neve sweep "
            << setup::shell_word((game.folder() / "picked_sweep.toml").string()) << "\n";
}

/// @return exit code; exit_ok when the rounds are over, the list is used up or the person stops
int play_rounds(PickGame& game, const pick::PickOptions& options, std::vector<pick::Click> list,
                bool asks) {
  while (!game.is_over()) {
    const auto next = static_cast<std::size_t>(game.answered());
    if (next >= list.size() && !asks) return exit_ok;
    if (const int code = game.make_round(); code != exit_ok) return code;
    pick::Click click;
    Answer answer = Answer::click;
    if (next < list.size())
      click = list[next];
    else
      answer = ask(game, options, click);
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

}  // namespace

int run_pick(const pick::PickOptions& options) {
  const bool asks = isatty(STDIN_FILENO) != 0;
  PickGame game(options);
  if (options.clicks.empty() && !asks)
    throw scene::toml::UsageError(
        "pick", "there is no terminal to ask for the best tile",
        "call it in a terminal, or give --clicks FILE with one choice a line: a tile from 1 to 9, "
        "two of them, or 0 for none");
  std::vector<pick::Click> list;
  if (!options.clicks.empty())
    list = pick::parse_clicks(text_of_file(options.clicks), options.clicks);
  output::make_folder(game.folder());
  const auto lock = output::FolderLock::try_lock(game.folder(), "neve pick",
                                                 output::FolderLock::Kind::alone, ".pick.lock");
  if (!lock)
    throw IoError("in use by " + output::FolderLock::holder_of(game.folder(), ".pick.lock"),
                  game.folder().string(), "wait for it, or choose another folder with --out");
  game.resume();
  if (!options.clicks.empty()) game.check_is_beginning_of(list);
  if (const int code = play_rounds(game, options, list, asks); code != exit_ok) return code;
  const auto values = game.write_pick();
  if (!values) {
    std::cerr << "nothing was chosen; the same command continues from here\n";
    return exit_ok;
  }
  print_pick(game, options, *values);
  return exit_ok;
}

}  // namespace neve::app::cli
