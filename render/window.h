#pragma once
/// A window on the desktop, with its input events.

#include <memory>
#include <string>
#include <vector>

#include "render/gl/context.h"

namespace neve::render {

/// Places are pixels of the picture from its upper left corner, in any units of the desktop.
struct WindowEvent {
  enum class Kind { move, leave, button, wheel, key, text, resize, drop, close };

  Kind kind = Kind::move;
  float x = 0, y = 0;  ///< place; of a wheel notches to the right and up; of resize the new size
  int button = 0;      ///< 0 left, 1 right, 2 middle, then the others
  /// Character that the key prints without shift on the user's keyboard, as a capital letter, digit
  /// or sign in ASCII; or GLFW's code of a key that prints nothing. Left and right shift are the
  /// same.
  int key = 0;
  bool is_down = false;
  bool ctrl = false, shift = false, alt = false, super = false;  ///< held after it
  std::string text{};  ///< UTF-8: the typed text; the file that was dropped
};

enum class CursorShape { arrow, text, cross, hand, resize_x, resize_y, resize_both, hidden };

class Window {
 public:
  struct Options {
    std::string title = "neve";
    int width = 1280, height = 720;  ///< points; made smaller where the desktop is
  };

  /// Shows the window. Only the main thread may have one.
  /// @throws ContextError
  explicit Window(const Options& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Context of the window, which owns it. It is current after construction.
  gl::Context& context();

  /// Width of the picture, px; at least 1.
  int width() const;
  int height() const;
  /// px per point
  float scale() const;

  /// False if the window is minimised.
  bool is_shown() const;
  /// True if the desktop has lost the contents since the last swap.
  bool is_damaged() const;

  /// Waits for events or wake(), at most the given seconds, and returns the events in order.
  std::vector<WindowEvent> wait(double seconds);
  /// Ends wait(); from any thread.
  static void wake();

  /// Shows the content of framebuffer 0, in step with the monitor.
  void swap();

  void set_title(const std::string& title);
  void set_cursor(CursorShape shape);
  void set_clipboard(const std::string& text);
  std::string clipboard() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace neve::render
