#pragma once
/// The screen of `neve pick`: rounds of nine moving tiles, made while it stays responsive, and the
/// answers of a person.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/pick/game.h"
#include "app/support/clock.h"
#include "app/view/frontend/frontend.h"
#include "app/view/frontend/imgui_input.h"
#include "app/view/picker/picker_state.h"
#include "render/screen.h"

namespace neve::app::view::picker {

struct PickerOptions {
  bool has_own_clock = false;  ///< 1/60 s pass from picture to picture: scripts
  /// A line that was typed into a terminal, which answers as well; empty if there is none.
  std::function<std::optional<std::string>()> line{};
  /// Tells a terminal that a round waits for its answer, or that the pick is written.
  std::function<void(const PickerState&)> tell{};
};

class Picker {
 public:
  /// @param game  resumed; outlives this object
  Picker(pick::Game& game, frontend::Frontend& front, render::Screen& screen,
         PickerOptions options);

  /// Plays rounds until the person is done, the screen is closed or Ctrl-C.
  /// @return exit code; exit_ok when the rounds are over or the person stops
  int run();

 private:
  void take_events(std::vector<frontend::InputEvent> events);
  void take_line();
  void attempt(const std::function<void()>& action);
  void begin_round();
  void follow_round();
  void look_at(const sweep::jobs::SweepProgress& runs);
  void end_round(int code);
  void ask();
  void heed();
  void choose(const pick::Click& click);
  void take_answer();
  void after_runs(const std::function<void()>& action, bool is_sheet_wanted = false);
  void undo();
  void download(const std::filesystem::path& file);
  void finish();
  void learn();
  int end();

  int moment() const;
  bool is_due(bool is_more);
  double seconds_passed();
  void draw(double passed);
  void draw_panels();
  render::Image picture(render::PicturePlace& place);

  pick::Game& game_;
  frontend::Frontend& front_;
  render::Screen& screen_;
  PickerOptions options_;
  frontend::ImGuiInput input_;
  PickerState state_;
  TileMovies movies_;
  std::optional<sweep::jobs::BackgroundSweep> process_;
  std::function<void()> then_;         ///< when the process has ended
  std::optional<pick::Click> answer_;  ///< given, and not yet in clicks.txt: runs are being ended
  std::function<void()> retry_;        ///< of Phase::stuck
  int failure_code_ = 0;               ///< of Phase::stuck
  std::optional<std::string> line_;    ///< typed and not yet used
  bool is_closed_ = false;
  double clock_ = 0;  ///< s of the movies
  int settle_ = 3;    ///< pictures that ImGui still needs to come to rest
  float styled_scale_ = 0;
  Clock::time_point drawn_at_ = Clock::now(), looked_at_{};
};

}  // namespace neve::app::view::picker
