#pragma once
/// A search in its folder: rounds that are answered, how the next one is made, and its result.
/// Terminal, window and page are ways to answer it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/pick/clicks.h"
#include "app/pick/files.h"
#include "app/pick/learned.h"
#include "app/pick/pick_options.h"
#include "app/pick/round_runs.h"
#include "app/pick/search/rounds.h"

namespace neve::app::pick {

/// The knowledge from all answers so far.
struct Lesson {
  search::Preference taste;
  search::Point favourite;  ///< empty before the first choice
  std::vector<AxisTaste> tastes;
  std::vector<std::string> lines;  ///< a sentence for each axis

  bool has_favourite() const { return favourite.size() > 0; }
};

/// @throws UsageError for a sweep file in the place of a scene, always
[[noreturn]] void refuse_sweep(const std::string& file);

class Game {
 public:
  /// Reads the scene; writes nothing. @throws UsageError, SceneError
  explicit Game(const PickOptions& options);

  const std::filesystem::path& folder() const { return folder_; }
  const std::vector<PickAxis>& axes() const { return scene_.axes; }
  const std::vector<search::Round>& rounds() const { return rounds_; }
  int max_rounds() const { return options_.rounds; }
  int answered() const { return static_cast<int>(rounds_.size()); }
  bool is_over() const { return answered() >= options_.rounds; }

  /// Takes up what the folder has. @throws UsageError for the folder of another search
  void resume();
  /// The answers so far must be the beginning of the list. @throws UsageError
  void check_is_beginning_of(const std::vector<Click>& list) const;

  /// Places of the nine tiles that wait for an answer; empty before begin_round().
  const std::vector<search::Point>& tiles() const { return tiles_; }
  /// Chooses the tiles and writes their sweep file. @return the sweep to make
  sweep::plan::SweepOptions begin_round();
  /// The next round, with the number of those that are left: for a plan. Writes nothing.
  sweep::plan::SweepOptions plan();
  /// Writes the page of the tiles, once they are made.
  void write_page(const sweep::jobs::SweepProgress& runs) const;

  /// clicks.txt has the answer, or nothing has changed. @throws IoError
  void answer(const Click& click);
  /// Takes the last answer back. @throws IoError
  void undo();

  const Lesson& lesson() const;
  render::Plot map() const;  ///< of a lesson with a favourite

  /// The place of the pick; an empty one before the first choice.
  search::Point result() const;
  std::vector<scene::Override> settings(const search::Point& place) const {
    return settings_at(scene_.axes, place);
  }
  /// Tells what was learned, a sentence for each axis, about the pick and not the favourite.
  std::vector<std::string> picked_lines() const;
  /// Writes scene, sweep, words and map of the pick. @return its values; empty without a choice
  std::optional<std::vector<scene::Override>> write_pick() const;
  /// Writes and returns the sweep of the pick, as coarse as its tiles and at full resolution.
  sweep::plan::SweepOptions begin_refinement() const;

 private:
  int dimension() const { return static_cast<int>(scene_.axes.size()); }
  /// Returns the sweep of the next round with the text of its file, which is not written.
  sweep::plan::SweepOptions next_round();
  void take(const Click& click);
  std::vector<std::string> comment() const;
  /// Tiles that this program would not choose were made by another one. @throws UsageError
  void check_tiles(int round, const std::vector<search::Point>& tiles) const;
  void write_clicks() const;

  const PickOptions options_;
  SearchScene scene_;
  std::filesystem::path folder_, own_clicks_;
  std::vector<search::Round> rounds_;
  std::vector<search::Point> tiles_;      ///< of the round that is not answered
  mutable std::optional<Lesson> lesson_;  ///< of these rounds, once it was asked for
};

}  // namespace neve::app::pick
