#pragma once
/// State that the screen of `neve pick` shows, and what a person wants next.

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/pick/game.h"
#include "app/pick/round_noise.h"
#include "app/view/picker/layout.h"
#include "app/view/picker/tile_movies.h"

namespace neve::app::view::picker {

enum class Phase {
  making,  ///< the runs of a round
  asking,  ///< for the best of its tiles
  stuck,   ///< something failed and can be tried again
  over     ///< the pick is written
};

/// One action for each picture: the last one wins.
struct Wish {
  enum class Kind { nothing, choose, undo, stop, try_again, more_rounds, done };
  Kind kind = Kind::nothing;
  pick::Click click{};
};

/// A tile as it is on the screen. Until its run is made it shows that of the round before.
struct ShownTile {
  bool is_new = false;          ///< it shows its own run
  pick::search::Point place{};  ///< of the run that it shows; empty without one
};

struct PickerState {
  const pick::Game& game;
  Phase phase = Phase::making;
  std::array<ShownTile, tile_count> tiles{};
  sweep::jobs::SweepProgress runs{};      ///< of the present round
  pick::RoundNoise noise{};               ///< of its tiles, once all have ended
  bool takes_two = false;                 ///< the next two clicks are one answer
  std::optional<int> first{};             ///< of two
  int pointed = -1;                       ///< tile under the pointer
  std::optional<int> closer{};            ///< tile that is shown alone
  std::string note{};                     ///< answer to the last action
  std::string failure{};                  ///< sentence of Phase::stuck
  bool is_stopping = false;               ///< runs are being ended
  std::vector<scene::Override> values{};  ///< of the pick, in Phase::over
  std::vector<std::string> learned{};     ///< told of the pick, in Phase::over
  bool is_scrolling = false;              ///< a finger moves the words
  std::optional<render::Plot> map{};      ///< of what was learned
  Layout layout{};
  Wish wish{};
  std::function<void(const std::string&)> copy{};
  /// Sends a written file to the user's machine; empty where it is this one.
  std::function<void(const std::filesystem::path&)> download{};

  bool can_undo() const { return game.answered() > 0 && !is_stopping; }
  int done() const { return runs.counts().finished; }
  sweep::jobs::RunProgress run(int tile) const;
};

/// Chooses a tile, or notes it as the first of two. @param is_pair  shift is held
void click_tile(PickerState& state, int tile, bool is_pair);

/// Panels; each draws into its own ImGui window.
void draw_bar(PickerState& state);
/// Draws the answers of the bar as large buttons, on a phone.
void draw_buttons(PickerState& state);
void draw_tiles(PickerState& state);
/// The axes, with the tiles and what is liked on them.
void draw_axes(PickerState& state);
/// The map of what was learned, which there is; as wide as the window.
void draw_map(const PickerState& state);
/// These draw the words beside or below the tiles: what was learned, or the pick.
void draw_words(PickerState& state);
void draw_result(PickerState& state);

void use_keys(PickerState& state);

/// The current ImGui text size.
float em();

}  // namespace neve::app::view::picker
