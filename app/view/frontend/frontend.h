#pragma once
/// Input and display device of `neve view`: a window, a web page, or a script.

#include <filesystem>
#include <string>
#include <vector>

#include "render/screen.h"
#include "render/window.h"

namespace neve::app::view::frontend {

using render::Modifiers, render::InputEvent, render::off_picture;
namespace key = render::key;

struct ScreenSize {
  int width = 1280, height = 720;  ///< px
  float scale = 1;                 ///< px per point: 2 on a screen with high resolution
};

/// A list that has more than it shows, in pixels of the screen.
struct ScrollPlace {
  float x, y, width, height;
  float notch;  ///< how far a notch of the wheel scrolls it
  bool operator==(const ScrollPlace&) const = default;
};

class Frontend {
 public:
  virtual ~Frontend() = default;

  /// Address of the device: "http://127.0.0.1:40123/?token=..." or "window".
  virtual std::string where() const = 0;

  virtual ScreenSize size() const = 0;

  /// Waits until something happened, wake() is called, is_ready() turned true, or so many seconds
  /// have passed. @return the events, in order
  virtual std::vector<InputEvent> wait(double seconds) = 0;

  /// Lets events wait in the device: wait() gives none, but `gone`. A device that takes them from a
  /// stranger bounds how many wait.
  virtual void hold_input(bool /*is_held*/) {}

  /// Ends wait(), from any thread.
  virtual void wake() = 0;

  /// True if a new picture would be seen soon; false if the page is hidden or earlier pictures are
  /// still in flight.
  virtual bool is_ready() const = 0;

  /// A page has connected and shows nothing yet: it needs the present picture, changed or not.
  virtual bool is_picture_wanted() const = 0;

  /// Shows the present picture of the screen.
  virtual void show(render::Screen& screen) = 0;

  /// Tells the progress of the simulation: scripts wait for it.
  virtual void set_progress(int /*frame*/, bool /*is_running*/) {}

  /// Tells whether a text field waits for input: a phone shows its keyboard.
  virtual void set_typing(bool /*is_wanted*/) {}

  /// Tells where a finger scrolls that moves up or down; elsewhere it drags.
  virtual void set_scrolling(const std::vector<ScrollPlace>& /*places*/) {}

  /// True if the user is at another machine, which offer() sends files to.
  virtual bool takes_files() const { return false; }
  /// Sends a file of a folder to the user. @throws IoError
  virtual void offer(const std::filesystem::path& /*folder*/,
                     const std::filesystem::path& /*file*/) {}

  /// Puts text into the user's clipboard.
  virtual void set_clipboard(const std::string& text) = 0;
  /// The last text known to be in it.
  virtual std::string clipboard() const = 0;
};

}  // namespace neve::app::view::frontend
