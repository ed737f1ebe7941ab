#pragma once
/// Scripts of input: a JSON list of steps, for tests, for the pictures of the documentation and for
/// bug reports. docs/view.md lists the steps.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/view/frontend/frontend.h"

namespace neve::app::view::replay {

/// A place on the picture: px, or on a widget by its label.
struct ReplayPlace {
  std::string label{};       ///< empty: x and y are px
  float x = 0.5f, y = 0.5f;  ///< with a label: part of its width and height, from the upper left
};

struct ReplayStep {
  enum class Kind {
    click,       ///< place, button, times, held
    drag,        ///< places, button, steps from one to the next, held
    move,        ///< place
    wheel,       ///< amount; place if any, held
    key,         ///< key, held, frames until it is let go
    type,        ///< text
    paste,       ///< text
    wait,        ///< frames
    wait_for,    ///< text, seconds
    screenshot,  ///< text: file; crop
    resize,      ///< size
    drop,        ///< text: file
    quit,
  };

  Kind kind = Kind::quit;
  int at_frame = 0;  ///< frame of the panels before which it does not start; 0: at once
  std::vector<ReplayPlace> places{};
  int button = 0;
  int times = 1;
  int steps = 10;
  int frames = 1;
  int key = 0;
  float wheel_x = 0, wheel_y = 0;  ///< notches to the right and up
  frontend::Modifiers held{};
  std::string text{};
  double seconds = 120;  ///< of real time, until waiting is given up
  frontend::ScreenSize size{};
  std::string crop_label{};                  ///< the part of the picture that a widget covers
  std::optional<std::array<int, 4>> crop{};  ///< x, y, width, height in px

  int line = 0, column = 0;  ///< where it is in its file
};

/// Goal of wait_for.
struct ReplayGoal {
  enum class Kind { frame, running, paused, label };
  Kind kind = Kind::frame;
  int frame = 0;
  std::string label;
};

/// "simulation frame 12", "simulation running", "simulation paused" or "label NAME"; nothing for
/// another text.
std::optional<ReplayGoal> parse_goal(const std::string& text);

/// @param file only named in errors
/// @throws SceneError with line and column
std::vector<ReplayStep> parse_replay(std::string_view text, const std::string& file);

/// Real time that a script takes at least, s: a frame of the panels for each step, 60 a second
/// where it waits for them. Its wait for the simulation is not known.
double min_seconds(const std::vector<ReplayStep>& steps);

/// Writes steps as parse_replay reads them, one a line; omits defaults.
std::string replay_text(const std::vector<ReplayStep>& steps);

const char* name(ReplayStep::Kind kind);

inline constexpr const char* button_names[] = {"left", "right", "middle"};

}  // namespace neve::app::view::replay
