#include "app/view/picker/picker.h"

#include <algorithm>
#include <exception>
#include <thread>
#include <utility>

#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/machine.h"

namespace neve::app::view::picker {

namespace {

constexpr double look_interval = 0.2;  // s, at the folders of the runs
constexpr double round_grace = 30;     // s to end, longer than a sweep gives its runs
constexpr std::size_t max_waiting_input = 64;

}  // namespace

Picker::Picker(pick::Game& game, frontend::Frontend& front, render::Screen& screen,
               PickerOptions options)
    : game_(game),
      front_(front),
      screen_(screen),
      options_(std::move(options)),
      input_((screen.select_panels(), front)),
      state_{.game = game} {
  state_.copy = [this](const std::string& text) { front_.set_clipboard(text); };
  if (front_.takes_files())
    state_.download = [this](const std::filesystem::path& file) { download(file); };
}

int Picker::run() {
  if (game_.is_over())
    finish();
  else
    begin_round();
  while (!is_closed_ && !is_interrupted()) {
    front_.hold_input(input_.waiting() >= max_waiting_input);
    // A page that nobody sees needs no pictures; its runs continue.
    take_events(front_.wait(front_.is_ready() ? 1.0 / 60 : look_interval));
    take_line();
    follow_round();
    heed();
    if (is_closed_ || !front_.is_ready()) continue;
    if (is_due(input_.feed())) draw(seconds_passed());
  }
  return end();
}

void Picker::take_events(std::vector<frontend::InputEvent> events) {
  if (!events.empty()) settle_ = 3;
  for (const frontend::InputEvent& event : events)
    if (event.kind == frontend::InputEvent::Kind::close) is_closed_ = true;
  input_.push(std::move(events));
}

/// The answers of a terminal are those of the screen. A tile that was typed too early waits.
void Picker::take_line() {
  if (!line_ && options_.line) line_ = options_.line();
  if (!line_ || state_.wish.kind != Wish::Kind::nothing) return;
  const std::optional<pick::Click> click = pick::click_of(*line_);
  if (click && state_.phase == Phase::making) return;
  const std::string line = *line_;
  line_.reset();
  settle_ = 3;
  if (line == "q")
    state_.wish = {state_.phase == Phase::over ? Wish::Kind::done : Wish::Kind::stop, {}};
  if (line == "u" && state_.can_undo()) state_.wish = {Wish::Kind::undo, {}};
  if (click && state_.phase == Phase::asking) state_.wish = {Wish::Kind::choose, *click};
}

/// An error becomes a sentence, with the action to try again.
void Picker::attempt(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    state_.failure = error.what();
    if (!error.hint.empty()) state_.failure += "; " + error.hint;
    failure_code_ = error.code;
    state_.phase = Phase::stuck;
    retry_ = action;
    settle_ = 3;
  }
}

void Picker::begin_round() {
  attempt([this] {
    learn();
    state_.phase = Phase::making;
    state_.first.reset();
    state_.takes_two = false;
    state_.closer.reset();
    for (ShownTile& tile : state_.tiles) tile.is_new = false;
    state_.runs.runs.clear();
    state_.noise = {};
    process_.reset();
    process_.emplace(game_.begin_round(), this_program(), game_.folder() / "round.log",
                     round_grace);
    settle_ = 3;
  });
}

void Picker::follow_round() {
  if (!process_) return;
  const std::optional<int> code = process_->poll();
  if (!code && seconds_since(looked_at_) < look_interval) return;
  looked_at_ = Clock::now();
  if (code) {
    end_round(*code);
    return;
  }
  try {
    const std::optional<sweep::jobs::SweepProgress> progress = process_->progress();
    if (!progress || state_.is_stopping) return;
    look_at(*progress);
    // The sheet and the film of the round are still being made.
    if (state_.phase == Phase::making && state_.runs.have_all_ended()) ask();
  } catch (const Error&) {
    settle_ = std::max(settle_, 1);  // it is looked at again
  }
}

/// Shows tiles whose runs have ended.
void Picker::look_at(const sweep::jobs::SweepProgress& runs) {
  const sweep::jobs::SweepProgress progress = pick::tiles_of(runs);
  state_.runs = progress;
  const std::size_t count = std::min<std::size_t>(tile_count, progress.runs.size());
  for (std::size_t k = 0; k < count; ++k) {
    ShownTile& tile = state_.tiles[k];
    if (tile.is_new || !progress.runs[k].has_ended()) continue;
    std::vector<std::filesystem::path> pictures = pick::pictures_of(progress, k);
    for (std::filesystem::path& picture : pictures) picture = game_.folder() / picture;
    movies_.load(static_cast<int>(k), pictures);
    tile.is_new = true;
    tile.place = game_.tiles()[k];
  }
  settle_ = std::max(settle_, 1);
}

void Picker::end_round(int code) {
  const std::string error = process_->error();
  process_.reset();
  state_.is_stopping = false;
  settle_ = 3;
  if (then_) {
    std::exchange(then_, nullptr)();
    return;
  }
  attempt([&] {
    // Tiles of runs that failed say so; the other ones can be chosen.
    if (code != exit_ok && code != exit_runs_failed)
      throw Error(code,
                  error.empty() ? "the runs ended with exit code " + std::to_string(code) : error);
    if (state_.phase != Phase::making) return;
    look_at(sweep::jobs::progress_of(game_.folder()));
    ask();
  });
  if (state_.phase == Phase::stuck) retry_ = [this] { begin_round(); };
}

/// Asks when all nine runs have ended. @throws Error where the page cannot be written
void Picker::ask() {
  game_.write_page(state_.runs);
  state_.noise = pick::noise_of_round(game_.folder());
  state_.phase = Phase::asking;
  state_.note = pick::all_failed_text(state_.runs);
  if (!state_.note.empty()) state_.note += "; None of them makes nine others";
  settle_ = 3;
  if (options_.tell) options_.tell(state_);
}

void Picker::heed() {
  const Wish wish = std::exchange(state_.wish, Wish{});
  switch (wish.kind) {
    case Wish::Kind::nothing:
      return;
    case Wish::Kind::choose:
      if (state_.phase == Phase::asking) choose(wish.click);
      break;
    case Wish::Kind::undo:
      after_runs([this] { undo(); });
      break;
    case Wish::Kind::stop:
      if (state_.phase == Phase::stuck)
        is_closed_ = true;
      else
        after_runs([this] { finish(); }, state_.phase == Phase::asking);
      break;
    case Wish::Kind::try_again:
      std::exchange(retry_, nullptr)();
      break;
    case Wish::Kind::more_rounds:
      begin_round();
      break;
    case Wish::Kind::done:
      is_closed_ = true;
      break;
  }
  settle_ = 3;
}

void Picker::choose(const pick::Click& click) {
  state_.note = pick::why_not(state_.runs, click);
  if (!state_.note.empty()) return;
  const bool is_last = game_.answered() + 1 >= game_.max_rounds();
  answer_ = click;
  const auto go_on = [this] {
    attempt([this] {
      take_answer();
      if (game_.is_over())
        finish();
      else
        begin_round();
    });
  };
  after_runs(go_on, is_last);
}

/// An answer counts whatever is done next: the person may stop before the runs have ended.
/// @throws Error where it cannot be written; it is still to be taken then
void Picker::take_answer() {
  if (!answer_) return;
  game_.answer(*answer_);
  answer_.reset();
}

/// Acts at once, or when the runs that are being made have ended.
/// @param is_sheet_wanted  of the present round, which is the last one
void Picker::after_runs(const std::function<void()>& action, bool is_sheet_wanted) {
  state_.note.clear();
  if (!process_) {
    action();
    return;
  }
  then_ = action;
  state_.is_stopping = true;
  if (!is_sheet_wanted) process_->stop();
}

void Picker::download(const std::filesystem::path& file) {
  try {
    front_.offer(game_.folder(), file);
    state_.note.clear();
  } catch (const Error& error) {
    state_.note = error.what();
  }
}

void Picker::undo() {
  attempt([this] {
    game_.undo();
    begin_round();
  });
}

void Picker::finish() {
  attempt([this] {
    take_answer();
    learn();
    state_.values = game_.write_pick().value_or(std::vector<scene::Override>{});
    state_.learned = game_.picked_lines();
    state_.phase = Phase::over;
    state_.closer.reset();
    const pick::search::Point place = game_.result();
    for (int k = 0; k < tile_count; ++k)
      if (const ShownTile& tile = state_.tiles[static_cast<std::size_t>(k)];
          place.size() > 0 && tile.place.size() > 0 && tile.place == place)
        state_.closer = k;
    if (options_.tell) options_.tell(state_);
  });
}

/// The map costs too much for every picture.
void Picker::learn() {
  state_.map.reset();
  if (game_.lesson().has_favourite()) state_.map = game_.map();
}

int Picker::end() {
  if (process_) process_->stop();
  while (process_ && !process_->poll()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (state_.phase != Phase::stuck) take_answer();
  if (is_interrupted()) return state_.phase == Phase::over ? exit_ok : exit_resumable;
  if (state_.phase != Phase::stuck) return exit_ok;
  throw Error(failure_code_, state_.failure, game_.folder().string(),
              "solve this and repeat the command: it continues, and nothing is lost");
}

}  // namespace neve::app::view::picker
