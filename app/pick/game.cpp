#include "app/pick/game.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "app/options/languages.h"
#include "app/output/atomic_file.h"
#include "app/pick/page.h"
#include "app/record/picture_files.h"
#include "app/record/run_json.h"
#include "app/scene/read.h"
#include "app/setup/curves.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/sweep/read/read_sweep.h"

namespace neve::app::pick {

namespace fs = std::filesystem;

namespace {

constexpr const char* another_folder = "choose another folder with --out, or remove the old one";

/// A parameter has one range. @param axes "ADDRESS=LOW,HIGH"
void refuse_repeated(const std::vector<std::string>& axes) {
  std::set<std::string> seen;
  for (const std::string& axis : axes) {
    const std::string address = axis.substr(0, axis.find('='));
    if (!seen.insert(address).second)
      throw UsageError("-p " + axis, address + " is given twice",
                       "give its two ends once, as in -p " + address + "=LOW,HIGH");
  }
}

}  // namespace

void refuse_sweep(const std::string& file) {
  throw UsageError("pick", file + " is a sweep", "give its scene, and the axes with -p");
}

Game::Game(const PickOptions& options) : options_(options) {
  std::vector<std::string> axes;
  for (const std::string& axis : options.runs.axes) axes.push_back(with_two_ends(axis));
  refuse_repeated(options.runs.axes);
  const sweep::read::Sweep sweep =
      sweep::read::read_sweep(options.runs.file, {axes, options.runs.overrides});
  if (!sweep.file.empty()) refuse_sweep(options.runs.file);
  scene_ = {options.runs.file, sweep.fixed, axes_of(sweep)};
  folder_ =
      options.runs.out.empty() ? out_folder() / (sweep.name + ".pick") : fs::path(options.runs.out);
  setup::refuse_followers(scene::read_scene_file(scene_.file),
                          settings_at(scene_.axes, search::Point::Constant(dimension(), 0)));
  // Complains about settings, and both ends of the axes, before anything is written.
  for (const double end : {0., 1.})
    picked_scene(scene_, search::Point::Constant(dimension(), end), folder_ / "picked.toml");
  own_clicks_ = folder_ / "clicks.txt";
}

void Game::resume() {
  std::error_code error;
  if (!fs::exists(own_clicks_, error)) return;
  const std::string text = text_of_file(own_clicks_);
  if (!text.starts_with(clicks_text({}, comment())))
    throw UsageError(folder_.string(),
                     fmt::format("has another search: {}; this one is: {}",
                                 text.substr(2, text.find('\n') - 2), comment().front()),
                     another_folder);
  const std::vector<Click> clicks = parse_clicks(text, own_clicks_.string());
  // The pick of fewer would replace that of all, and the next answer would drop the others.
  if (static_cast<int>(clicks.size()) > options_.rounds)
    throw UsageError("--rounds",
                     fmt::format("{} has the answers of {} rounds, more than {}", folder_.string(),
                                 clicks.size(), options_.rounds),
                     fmt::format("give --rounds {} or more, or {}", clicks.size(), another_folder));
  for (const Click& click : clicks) {
    take(click);
    check_tiles(answered(), rounds_.back().tiles);
  }
}

void Game::check_tiles(int round, const std::vector<search::Point>& tiles) const {
  const fs::path file = folder_ / fmt::format("round_{}.toml", round);
  std::error_code error;
  if (!fs::exists(file, error) || text_of_file(file) == round_sweep(scene_, folder_, round, tiles))
    return;
  throw UsageError(file.string(), "has other tiles than this program chooses in that round",
                   another_folder);
}

void Game::check_is_beginning_of(const std::vector<Click>& list) const {
  for (std::size_t k = 0; k < rounds_.size(); ++k)
    if (k >= list.size() || rounds_[k].chosen != list[k])
      throw UsageError(options_.clicks,
                       fmt::format("{} has other clicks from round {} on", folder_.string(), k + 1),
                       another_folder);
}

sweep::plan::SweepOptions Game::begin_round() {
  sweep::plan::SweepOptions runs = next_round();
  output::make_folder(folder_);
  output::write_file(runs.file, runs.text);
  runs.text.clear();
  runs.is_json = false;
  return runs;
}

sweep::plan::SweepOptions Game::next_round() {
  if (tiles_.empty()) tiles_ = search::next_tiles(rounds_, dimension(), options_.seed);
  sweep::plan::SweepOptions runs = options_.runs;
  runs.file = (folder_ / fmt::format("round_{}.toml", answered() + 1)).string();
  runs.text = round_sweep(scene_, folder_, answered() + 1, tiles_);
  runs.axes.clear();
  runs.overrides.clear();
  runs.out = folder_.string();
  return runs;
}

sweep::plan::SweepOptions Game::plan() {
  sweep::plan::SweepOptions runs = next_round();
  runs.is_dry_run = true;
  runs.rounds = options_.rounds - answered();
  // The pick, for --refine: which it will be is as open as which points of a sweep are the best.
  runs.refine = options_.refines ? 1 : 0;
  return runs;
}

void Game::write_page(const sweep::jobs::SweepProgress& runs) const {
  RoundPage page;
  page.round = answered() + 1;
  page.rounds = options_.rounds;
  page.fps = runs.manifest.fps;
  for (std::size_t k = 0; k < runs.runs.size(); ++k) {
    std::vector<std::string>& pictures = page.tiles.emplace_back();
    for (const fs::path& file : pictures_of(runs, k)) pictures.push_back(file.generic_string());
  }
  page.noise = noise_of_round(folder_);
  page.has_favourite = lesson().has_favourite();
  if (page.has_favourite) {
    page.learned = lesson().lines;
    page.map = map_svg(map());
  }
  output::write_file(folder_ / "round.html", page_html(page));
}

void Game::answer(const Click& click) {
  const std::vector<search::Point> tiles = tiles_;
  take(click);
  try {
    write_clicks();
  } catch (...) {
    rounds_.pop_back();
    lesson_.reset();
    tiles_ = tiles;
    throw;
  }
}

void Game::undo() {
  if (rounds_.empty()) return;
  const search::Round last = std::move(rounds_.back());
  rounds_.pop_back();
  try {
    write_clicks();
  } catch (...) {
    rounds_.push_back(last);
    throw;
  }
  lesson_.reset();
  tiles_ = last.tiles;
}

void Game::take(const Click& click) {
  if (tiles_.empty()) tiles_ = search::next_tiles(rounds_, dimension(), options_.seed);
  rounds_.push_back({std::exchange(tiles_, {}), click});
  lesson_.reset();
}

const Lesson& Game::lesson() const {
  if (lesson_) return *lesson_;
  lesson_ = Lesson{search::learn(rounds_, dimension()), {}, {}, {}};
  lesson_->favourite = search::favourite(rounds_, lesson_->taste);
  if (lesson_->has_favourite()) {
    lesson_->tastes = axis_tastes(scene_.axes, lesson_->taste, lesson_->favourite);
    lesson_->lines = taste_lines(scene_.axes, lesson_->tastes, lesson_->favourite);
  }
  return *lesson_;
}

render::Plot Game::map() const {
  return taste_map(scene_.axes, lesson().taste, rounds_, lesson().tastes, lesson().favourite);
}

search::Point Game::result() const {
  return lesson().has_favourite() ? search::result_of(rounds_, lesson().taste) : search::Point();
}

std::vector<std::string> Game::picked_lines() const {
  const search::Point place = result();
  if (place.size() == 0) return {};
  return taste_lines(scene_.axes, axis_tastes(scene_.axes, lesson().taste, place), place);
}

std::optional<std::vector<scene::Override>> Game::write_pick() const {
  const search::Point place = result();
  if (place.size() == 0) return std::nullopt;
  const fs::path picked = folder_ / "picked.toml";
  output::write_file(picked, picked_scene(scene_, place, picked));
  std::vector<std::size_t> order;
  for (const AxisTaste& taste : lesson().tastes) order.push_back(taste.axis);
  output::write_file(folder_ / "picked_sweep.toml",
                     picked_sweep(scene_, "picked.toml", place, order));
  output::write_file(folder_ / "learned.txt", fmt::format("{}\n", fmt::join(picked_lines(), "\n")));
  output::write_file(folder_ / "map.svg", map_svg(map()));
  return settings(place);
}

sweep::plan::SweepOptions Game::begin_refinement() const {
  const fs::path file = folder_ / "picked_pair.toml";
  output::write_file(
      file, picked_pair("picked.toml", scene::read_scene_file((folder_ / "picked.toml").string()),
                        *options_.runs.coarsening));
  sweep::plan::SweepOptions runs = options_.runs;
  runs.file = file.string();
  runs.axes.clear();
  runs.overrides.clear();
  runs.coarsening.reset();
  runs.is_fast = false;
  runs.out = (folder_ / "picked_pair.cdb").string();
  runs.is_json = false;
  return runs;
}

/// Says which search the clicks are of.
std::vector<std::string> Game::comment() const {
  // Clicks are of what the tiles showed: the snow of the scene with the files that it names, and
  // how it was seen.
  const scene::Scene scene = scene::read_scene_file(scene_.file);
  const std::string shown = scene::write_scene(scene) + record::file_lines(scene);
  std::string what = fmt::format("{} ({})", scene_.file, record::hash_of(shown));
  for (const PickAxis& axis : scene_.axes)
    what += fmt::format(", {} {} to {}{}", axis.address, axis.text(0), axis.text(1),
                        axis.is_logarithmic ? " in ratios" : "");
  for (const scene::Override& change : scene_.fixed)
    what += ", " + change.address + " = " + change.value;
  if (const auto& frames = options_.runs.frames)
    what += ", frames " + options::frames().write(*frames);
  if (options_.runs.is_fast) what += ", fast";
  if (!options_.runs.view.empty()) what += ", view " + options_.runs.view;
  if (options_.runs.coarsening) what += fmt::format(", coarsened by {}", *options_.runs.coarsening);
  if (options_.runs.seeds > 0) what += fmt::format(", {} seeds a tile", options_.runs.seeds);
  return {fmt::format("{}, seed {}", what, options_.seed),
          "One round a line: the tile chosen, two of them, or 0 for none."};
}

void Game::write_clicks() const {
  std::vector<Click> clicks;
  for (const search::Round& round : rounds_) clicks.push_back(round.chosen);
  output::write_file(own_clicks_, clicks_text(clicks, comment()));
}

}  // namespace neve::app::pick
