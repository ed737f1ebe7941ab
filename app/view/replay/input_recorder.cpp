#include "app/view/replay/input_recorder.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "app/view/frontend/key_names.h"

namespace neve::app::view::replay {

namespace {

using Kind = frontend::InputEvent::Kind;
using Step = ReplayStep::Kind;

constexpr double frames_per_second = 60;
/// Shorter pauses are the speed of a hand; longer ones are time to think.
constexpr double shortest_pause = 0.25, longest_pause = 5;
/// A mouse at rest shows tooltips.
constexpr double tooltip_time = 0.5;
constexpr float click_radius = 4;
constexpr std::size_t path_limit = 400;

int frames_of(double seconds) {
  return std::max(1, static_cast<int>(std::lround(seconds * frames_per_second)));
}

float distance(const ReplayPlace& a, const ReplayPlace& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// @param place  of the label
/// @return a part of the widget, unless it is outside
std::optional<ReplayPlace> on_widget(const std::string& label,
                                     const std::optional<panels::LabelPlace>& place, float x,
                                     float y) {
  if (!place || place->width <= 0 || place->height <= 0) return std::nullopt;
  const ReplayPlace on{label, (x - place->x) / place->width, (y - place->y) / place->height};
  if (on.x < 0 || on.x > 1 || on.y < 0 || on.y > 1) return std::nullopt;
  return on;
}

ReplayPlace place_at(float x, float y) {
  const std::string label = panels::Labels::of_panels().name_at(x, y);
  return on_widget(label, panels::Labels::of_panels().find(label), x, y)
      .value_or(ReplayPlace{{}, x, y});
}

bool prints(int key, const std::string& text) {
  if (text.size() != 1) return false;
  const char c = text[0];
  return key == (c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
}

bool is_modifier(int key) {
  return key >= frontend::key::shift && key <= frontend::key::super;
}

}  // namespace

void InputRecorder::note(const std::vector<frontend::InputEvent>& events, double seconds) {
  now_ = seconds;
  if (!events.empty()) note_rest();
  for (const frontend::InputEvent& event : events) note(event);
}

void InputRecorder::note(const frontend::InputEvent& event) {
  switch (event.kind) {
    case Kind::move:
      note_move(event);
      break;
    case Kind::button:
      if (event.is_down && button_ < 0) press(event);
      if (!event.is_down && button_ == event.button) release();
      break;
    case Kind::wheel:
      note_wheel(event);
      break;
    case Kind::key:
      note_key(event);
      break;
    case Kind::text:
      note_text(event.text);
      break;
    case Kind::paste:
      add({.kind = Step::paste, .text = event.text}, now_);
      break;
    case Kind::drop:
      add({.kind = Step::drop, .text = event.text}, now_);
      break;
    case Kind::close:
      add({.kind = Step::quit}, now_);
      break;
    case Kind::resize:  // set_size knows more
    case Kind::gone:    // releases follow
      break;
  }
}

void InputRecorder::note_rest() {
  if (button_ >= 0 || last_move_ < 0 || now_ - last_move_ < tooltip_time) return;
  const double rested_at = std::exchange(last_move_, -1);
  add({.kind = Step::move, .places = {place_at(x_, y_)}}, rested_at);
}

void InputRecorder::note_move(const frontend::InputEvent& event) {
  // The mouse may leave the picture; a script has no use for that.
  if (event.x < -10'000 || event.y < -10'000) return;
  x_ = event.x;
  y_ = event.y;
  if (button_ < 0) {
    last_move_ = now_;
    return;
  }
  // The panels saw one place a frame.
  if (path_.size() > 1 && path_end_ == now_) path_.pop_back();
  path_.push_back({{}, x_, y_});
  path_end_ = now_;
  if (path_.size() <= path_limit) return;
  for (std::size_t k = 1; k + 1 < path_.size(); ++k)
    path_.erase(path_.begin() + static_cast<std::ptrdiff_t>(k));
}

void InputRecorder::press(const frontend::InputEvent& event) {
  button_ = event.button;
  pressed_at_ = now_;
  pressed_held_ = event.held;
  pressed_on_ = place_at(x_, y_);
  pressed_label_ = panels::Labels::of_panels().find(pressed_on_.label);
  path_ = {{{}, x_, y_}};
  path_end_ = now_;
}

void InputRecorder::release() {
  const bool is_drag = std::any_of(path_.begin(), path_.end(), [&](const ReplayPlace& place) {
    return distance(place, path_[0]) > click_radius;
  });
  ReplayStep step{.kind = is_drag ? Step::drag : Step::click,
                  .button = std::exchange(button_, -1),
                  .held = pressed_held_};
  last_move_ = -1;
  if (!is_drag) {
    ReplayStep* before = last(Step::click, 0.3);
    const bool is_again = before && before->button == step.button && before->times < 9 &&
                          before->places[0].label == pressed_on_.label &&
                          distance(before->places[0], pressed_on_) < click_radius;
    step.places = {pressed_on_};
    if (!is_again) return add(std::move(step), pressed_at_);
    ++before->times;
    last_step_ = now_;
    return;
  }
  step.steps = 1;
  step.places = {pressed_on_};
  for (std::size_t k = 1; k < path_.size(); ++k)
    step.places.push_back(
        on_widget(pressed_on_.label, pressed_label_, path_[k].x, path_[k].y).value_or(path_[k]));
  add(std::move(step), pressed_at_);
}

void InputRecorder::note_wheel(const frontend::InputEvent& event) {
  ReplayStep* before = last(Step::wheel, 0.3);
  const ReplayPlace place = place_at(x_, y_);
  if (before && before->places[0].label == place.label &&
      std::abs(before->wheel_y + event.y) <= 100 && before->wheel_x * event.x >= 0 &&
      before->wheel_y * event.y >= 0) {
    before->wheel_x += event.x;
    before->wheel_y += event.y;
    last_step_ = now_;
    return;
  }
  last_move_ = -1;
  add({.kind = Step::wheel,
       .places = {place},
       .wheel_x = event.x,
       .wheel_y = event.y,
       .held = event.held},
      now_);
}

void InputRecorder::note_key(const frontend::InputEvent& event) {
  if (is_modifier(event.key) || frontend::key_name(event.key).empty()) return;
  if (event.is_down) return add({.kind = Step::key, .key = event.key, .held = event.held}, now_);
  ReplayStep* before = last(Step::key, 60);
  if (!before || before->key != event.key) return;
  before->frames = frames_of(now_ - last_step_);
  last_step_ = now_;
}

/// The key that printed a text is typed with it.
void InputRecorder::note_text(const std::string& text) {
  const ReplayStep* key = last(Step::key, 0.1);
  if (key && prints(key->key, text) && !key->held.ctrl && !key->held.alt && !key->held.super)
    steps_.pop_back();
  ReplayStep* before = last(Step::type, 1);
  if (!before) return add({.kind = Step::type, .text = text}, now_);
  before->text += text;
  last_step_ = now_;
}

void InputRecorder::set_progress(int frame, bool is_running) {
  simulation_frame_ = frame;
  is_running_ = is_running;
  awaited_frame_ = std::min(awaited_frame_, frame);  // it may have been reset
}

void InputRecorder::set_size(const frontend::ScreenSize& size) {
  const bool is_same = !steps_.empty() && size.width == size_.width &&
                       size.height == size_.height && size.scale == size_.scale;
  if (is_same) return;
  size_ = size;
  if (ReplayStep* before = last(Step::resize, 1)) {
    before->size = size;
    return;
  }
  add({.kind = Step::resize, .size = size}, now_);
}

ReplayStep* InputRecorder::last(ReplayStep::Kind kind, double seconds) {
  const bool is_it = !steps_.empty() && steps_.back().kind == kind && now_ - last_step_ < seconds;
  return is_it ? &steps_.back() : nullptr;
}

void InputRecorder::add(ReplayStep step, double start) {
  const double pause = start - last_step_;
  if (is_running_ && simulation_frame_ > awaited_frame_) {
    awaited_frame_ = simulation_frame_;
    steps_.push_back(
        {.kind = Step::wait_for, .text = "simulation frame " + std::to_string(simulation_frame_)});
  } else if (pause > shortest_pause && !steps_.empty()) {
    steps_.push_back({.kind = Step::wait, .frames = frames_of(std::min(pause, longest_pause))});
  }
  steps_.push_back(std::move(step));
  last_step_ = now_;
}

}  // namespace neve::app::view::replay
