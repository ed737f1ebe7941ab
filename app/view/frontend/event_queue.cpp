#include "app/view/frontend/event_queue.h"

#include <algorithm>
#include <utility>

namespace neve::app::view::frontend {

bool EventQueue::join(const InputEvent& event) {
  if (events_.empty()) return false;
  InputEvent& last = events_.back();
  if (last.kind != event.kind) return false;
  switch (event.kind) {
    case InputEvent::Kind::resize:
      last = event;
      return true;
    case InputEvent::Kind::move:
      if (last.held != event.held) return false;
      last = event;
      return true;
    case InputEvent::Kind::wheel:
      if (last.held != event.held) return false;
      last.x += event.x;
      last.y += event.y;
      return true;
    default:
      return false;
  }
}

void EventQueue::note_held(const InputEvent& event) {
  const bool is_key = event.kind == InputEvent::Kind::key;
  if (event.kind == InputEvent::Kind::move || event.kind == InputEvent::Kind::button) {
    x_ = event.x;
    y_ = event.y;
  }
  if (!is_key && event.kind != InputEvent::Kind::button) return;
  std::vector<int>& held = is_key ? keys_ : buttons_;
  const int which = is_key ? event.key : event.button;
  std::erase(held, which);
  if (event.is_down) held.push_back(which);
}

bool EventQueue::push(const InputEvent& event) {
  // The first text goes in at any size, so that no text waits for ever.
  const bool is_too_much = text_size_ > 0 && text_size_ + event.text.size() > text_limit;
  if (!join(event)) {
    if (events_.size() >= limit || is_too_much) return false;
    text_size_ += event.text.size();
    events_.push_back(event);
  }
  note_held(event);
  return true;
}

void EventQueue::release_all() {
  InputEvent up;
  up.kind = InputEvent::Kind::button;
  up.x = x_;
  up.y = y_;
  for (const int button : std::exchange(buttons_, {})) {
    up.button = button;
    events_.push_back(up);
  }
  up.kind = InputEvent::Kind::key;
  for (const int key : std::exchange(keys_, {})) {
    up.key = key;
    events_.push_back(up);
  }
}

void EventQueue::leave() {
  events_.clear();
  text_size_ = 0;
  events_.push_back({.kind = InputEvent::Kind::gone});
  release_all();
}

bool EventQueue::has_left() const {
  return !events_.empty() && events_.front().kind == InputEvent::Kind::gone;
}

std::vector<InputEvent> EventQueue::take() {
  text_size_ = 0;
  return std::exchange(events_, {});
}

}  // namespace neve::app::view::frontend
