#pragma once
/// Input events that the program has not read yet. The queue never exceeds its limit.

#include <cstddef>
#include <vector>

#include "app/view/frontend/frontend.h"

namespace neve::app::view::frontend {

/// A queue of input events. It is not protected against threads.
class EventQueue {
 public:
  static constexpr std::size_t limit = 256;
  static constexpr std::size_t text_limit = 1 << 20;  ///< bytes of all texts together

  /// Joins events: the last of successive moves and resizes is kept, wheels are added.
  /// @return false when it is full and the event was not taken
  bool push(const InputEvent& event);

  /// Releases every key and every button that is held, even if the queue is full.
  void release_all();

  /// Drops what waits, says so by `gone`, and releases every key and button that is held.
  void leave();
  /// True if the sender of the earlier events has left and the program has not been told.
  bool has_left() const;

  bool empty() const { return events_.empty(); }
  std::vector<InputEvent> take();

 private:
  bool join(const InputEvent& event);
  void note_held(const InputEvent& event);

  std::vector<InputEvent> events_;
  std::size_t text_size_ = 0;
  std::vector<int> keys_, buttons_;  ///< held
  float x_ = 0, y_ = 0;              ///< last place of the pointer
};

}  // namespace neve::app::view::frontend
