#pragma once
/// A window on the desktop, with its input events.

#include <memory>
#include <string>
#include <vector>

#include "render/gl/context.h"

namespace neve::render {

struct Modifiers {
  bool ctrl = false, shift = false, alt = false, super = false;

  bool operator==(const Modifiers&) const = default;
};

/// Keys are the character that they print without shift on the user's keyboard, as a capital
/// letter, digit or sign in ASCII; or one of these, the codes of GLFW. Left and right shift are the
/// same.
namespace key {
inline constexpr int escape = 256, enter = 257, tab = 258, backspace = 259, insert = 260, del = 261,
                     right = 262, left = 263, down = 264, up = 265, page_up = 266, page_down = 267,
                     home = 268, end = 269, f1 = 290, shift = 340, ctrl = 341, alt = 342,
                     super = 343, last = 348;
}

/// Mouse position outside the picture, for events of kind `move`.
inline constexpr float off_picture = -100000;

/// One input event. Places are pixels of the picture from its upper left corner, in any units of
/// the desktop. Pastes come from pages and scripts alone; `gone`: the sender of the earlier events
/// has left, and they are void.
struct InputEvent {
  enum class Kind { move, button, wheel, key, text, resize, drop, paste, close, gone };

  Kind kind = Kind::move;
  float x = 0, y = 0;    ///< place; of a wheel notches to the right and up; of resize the new size
  int button = 0;        ///< 0 left, 1 right, 2 middle, then the others
  int key = 0;           ///< see namespace key
  bool is_down = false;  ///< of button and key
  Modifiers held{};      ///< after it
  std::string text{};    ///< UTF-8: the typed text, the clipboard that is pasted, the file dropped
};

enum class CursorShape { arrow, text, hand, resize_x, resize_y, resize_both, hidden };

class Window {
 public:
  struct Options {
    std::string title = "neve";
    int width = 1280, height = 720;  ///< points; made smaller where the desktop is
  };

  /// Shows a window. Only the main thread may have one.
  /// @throws ContextError
  static std::unique_ptr<Window> open(const Options& options);
  virtual ~Window() = default;

  /// Context of the window, which owns it. It is current after construction.
  virtual gl::Context& context() = 0;

  /// Width of the picture, px; at least 1.
  virtual int width() const = 0;
  virtual int height() const = 0;
  /// Returns px per point.
  virtual float scale() const = 0;

  /// False if the window is minimised.
  virtual bool is_shown() const = 0;
  /// True if the desktop has lost the contents since the last swap.
  virtual bool is_damaged() const = 0;

  /// Waits for events or wake(), at most the given seconds, and returns the events in order.
  virtual std::vector<InputEvent> wait(double seconds) = 0;
  /// Ends wait(); from any thread.
  virtual void wake() = 0;

  /// Shows the content of framebuffer 0, in step with the monitor.
  virtual void swap() = 0;

  virtual void set_title(const std::string& title) = 0;
  virtual void set_cursor(CursorShape shape) = 0;
  virtual void set_clipboard(const std::string& text) = 0;
  virtual std::string clipboard() const = 0;
};

}  // namespace neve::render
