#pragma once
/// Turns input into a script.

#include <optional>
#include <vector>

#include "app/view/frontend/frontend.h"
#include "app/view/panels/labels.h"
#include "app/view/replay/replay_script.h"

namespace neve::app::view::replay {

/// Places are written by the label of the widget there, where one is, so that the script still
/// works with another layout of the panels; a press, moves and a release become a click or a drag.
class InputRecorder {
 public:
  /// @param events of one frame of the panels
  /// @param seconds since the first one
  void note(const std::vector<frontend::InputEvent>& events, double seconds);

  /// Progress of the simulation; the steps that follow wait for it.
  void set_progress(int frame, bool is_running);
  void set_size(const frontend::ScreenSize& size);

  /// Finished steps.
  const std::vector<ReplayStep>& steps() const { return steps_; }

 private:
  void note(const frontend::InputEvent& event);
  void note_rest();
  void note_move(const frontend::InputEvent& event);
  void press(const frontend::InputEvent& event);
  void release();
  void note_key(const frontend::InputEvent& event);
  void note_text(const std::string& text);
  void note_wheel(const frontend::InputEvent& event);
  /// Adds a step that began at `start`, after the steps that it waits for.
  void add(ReplayStep step, double start);
  /// The last step, when it is of this kind and ended less than so long ago.
  ReplayStep* last(ReplayStep::Kind kind, double seconds);

  std::vector<ReplayStep> steps_;
  double now_ = 0;         ///< s
  double last_step_ = 0;   ///< s, when the last step ended
  double last_move_ = -1;  ///< s; < 0: none since the last step
  float x_ = 0, y_ = 0;    ///< of the mouse, px
  frontend::ScreenSize size_{};

  int button_ = -1;  ///< that is down, or -1
  double pressed_at_ = 0;
  frontend::Modifiers pressed_held_{};
  std::vector<ReplayPlace> path_;  ///< of the mouse since the press, px
  double path_end_ = 0;            ///< s
  ReplayPlace pressed_on_;
  /// The place of its label, px: what is dragged may take its label along, and a script looks for
  /// the label once, before it drags. Absent: it is on none.
  std::optional<panels::LabelPlace> pressed_label_;

  int simulation_frame_ = -1, awaited_frame_ = 0;
  bool is_running_ = false;
};

}  // namespace neve::app::view::replay
