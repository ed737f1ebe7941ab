#pragma once
/// Passes input events to Dear ImGui, in portions that it understands.

#include <deque>
#include <string>
#include <vector>

#include "app/view/frontend/frontend.h"

struct ImGuiIO;

namespace neve::app::view::frontend {

/// Dear ImGui looks at its input once per frame. It notices one change of each key or button, and
/// it does not know the order of the rest: a click that starts and ends between two frames would
/// be lost, and a click before a move would land behind it. So events wait here and every frame
/// gets as many as keep their meaning. Newer versions of Dear ImGui do the same by themselves.
class ImGuiInput {
 public:
  /// The ImGui context that is current now gets its clipboard from the front, which must live
  /// longer than this; this must live longer than the context is used.
  explicit ImGuiInput(Frontend& front);
  ImGuiInput(const ImGuiInput&) = delete;
  ImGuiInput& operator=(const ImGuiInput&) = delete;

  /// Events of the kinds resize, drop and close are left out; impossible places, buttons and keys
  /// are too. `gone` drops what waits and releases every key and button. A paste becomes ctrl+V
  /// with that text in the clipboard: who sends pastes sends no ctrl+V for them.
  void push(std::vector<InputEvent> events);

  /// Hands over the events that fit into one frame, to the current ImGui context, just before it
  /// starts.
  /// @return whether more is waiting for the next
  bool feed();

  /// Events that wait for a frame.
  std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Waiting {
    InputEvent event{};
    bool ends_paste = false;  ///< the next one finds the next text
  };
  struct Portion;
  static bool fits(const InputEvent& event, const Portion& portion);
  bool is_news(const Waiting& waiting) const;
  void apply(const InputEvent& event, ImGuiIO& io);
  void set_modifiers(const Modifiers& held, ImGuiIO& io);
  void push_paste(const InputEvent& event);
  void release_all();
  const char* clipboard_text();

  Frontend& front_;
  std::deque<Waiting> waiting_;
  std::vector<std::string> pasted_;  ///< texts of pastes that are waiting, oldest first
  std::string clipboard_;            ///< keeps the text handed out last
  std::vector<bool> is_key_down_, is_button_down_;
  Modifiers held_{};
};

/// True if a key (see namespace key) went down in this frame of the current ImGui context, again
/// and again while it is held if it repeats.
bool is_key_pressed(int key, bool is_repeating = false);
bool is_key_down(int key);

}  // namespace neve::app::view::frontend
