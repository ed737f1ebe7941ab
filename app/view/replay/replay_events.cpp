#include "app/view/replay/replay_events.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

namespace neve::app::view::replay {

namespace {

using Kind = frontend::InputEvent::Kind;
using Frames = std::vector<std::vector<frontend::InputEvent>>;

/// Adds frame by frame.
class Hand {
 public:
  explicit Hand(const ReplayStep& step) : step_(step) {}

  void click(ReplayPoint at) {
    move(at);
    for (int k = 0; k < step_.times; ++k) {
      button(true);
      button(false);
    }
    rest();
  }

  void drag(const std::vector<ReplayPoint>& points) {
    move(points[0]);
    button(true);
    for (std::size_t k = 1; k < points.size(); ++k) {
      const ReplayPoint a = points[k - 1], b = points[k];
      for (int i = 1; i <= step_.steps; ++i) {
        const float part = static_cast<float>(i) / static_cast<float>(step_.steps);
        move({a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)});
      }
    }
    button(false);
    rest();
  }

  void move(ReplayPoint to) {
    next({.kind = Kind::move, .x = to.x, .y = to.y, .held = step_.held});
  }

  /// Notch by notch, as wheels turn.
  void wheel() {
    const float notches = std::max(std::abs(step_.wheel_x), std::abs(step_.wheel_y));
    const int count = std::max(1, static_cast<int>(std::ceil(notches)));
    const auto share = 1 / static_cast<float>(count);
    for (int k = 0; k < count; ++k)
      next({.kind = Kind::wheel,
            .x = share * step_.wheel_x,
            .y = share * step_.wheel_y,
            .held = step_.held});
    rest();
  }

  void key() {
    press(step_.key, printed_by(step_.key));
    for (int k = 1; k < step_.frames; ++k) rest();
    release(step_.key);
    rest();
  }

  /// A keyboard sends the keys that print the text too.
  void type(std::string_view text) {
    while (!text.empty()) {
      std::size_t size = 1;
      while (size < text.size() && (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80) ++size;
      const std::string letter(text.substr(0, size));
      const int code = code_of(letter);
      if (code == 0) {
        next({.kind = Kind::text, .text = letter});
      } else {
        press(code, letter);
        release(code);
      }
      text.remove_prefix(size);
    }
    rest();
  }

  void once(frontend::InputEvent event) {
    next(std::move(event));
    rest();
  }

  /// The keys that are held around all of it.
  void hold(bool is_down) {
    frontend::Modifiers held = is_down ? frontend::Modifiers{} : step_.held;
    const auto turn = [&](bool is_held, bool& state, int code) {
      if (!is_held) return;
      state = is_down;
      next({.kind = Kind::key, .key = code, .is_down = is_down, .held = held});
    };
    turn(step_.held.ctrl, held.ctrl, frontend::key::ctrl);
    turn(step_.held.shift, held.shift, frontend::key::shift);
    turn(step_.held.alt, held.alt, frontend::key::alt);
    turn(step_.held.super, held.super, frontend::key::super);
  }

  Frames frames;

 private:
  void next(frontend::InputEvent event) { frames.push_back({std::move(event)}); }
  void rest() { frames.emplace_back(); }

  void button(bool is_down) {
    next({.kind = Kind::button, .button = step_.button, .is_down = is_down, .held = step_.held});
  }

  void press(int code, const std::string& printed) {
    next({.kind = Kind::key, .key = code, .is_down = true, .held = step_.held});
    if (!printed.empty()) frames.back().push_back({.kind = Kind::text, .text = printed});
  }

  void release(int code) { next({.kind = Kind::key, .key = code, .held = step_.held}); }

  static int code_of(const std::string& letter) {
    const char c = letter[0];
    if (letter.size() > 1) return 0;
    if (c == ' ' || (c >= '0' && c <= '9')) return c;
    if (c >= 'a' && c <= 'z') return c - 'a' + 'A';
    if (c >= 'A' && c <= 'Z') return c;
    return c == '\n' ? frontend::key::enter : 0;
  }

  /// Text that a key types into a text field.
  std::string printed_by(int code) const {
    if (step_.held.ctrl || step_.held.alt || step_.held.super || code < ' ' || code > 126)
      return {};
    if (code >= 'A' && code <= 'Z' && !step_.held.shift) code += 'a' - 'A';
    return std::string(1, static_cast<char>(code));
  }

  const ReplayStep& step_;
};

}  // namespace

std::vector<std::vector<frontend::InputEvent>> events_of(const ReplayStep& step,
                                                         const std::vector<ReplayPoint>& points) {
  using Step = ReplayStep::Kind;
  Hand hand(step);
  hand.hold(true);
  switch (step.kind) {
    case Step::click:
      hand.click(points.at(0));
      break;
    case Step::drag:
      hand.drag(points);
      break;
    case Step::move:
      hand.move(points.at(0));
      break;
    case Step::wheel:
      if (!points.empty()) hand.move(points[0]);
      hand.wheel();
      break;
    case Step::key:
      hand.key();
      break;
    case Step::type:
      hand.type(step.text);
      break;
    case Step::paste:
      hand.once({.kind = Kind::paste, .text = step.text});
      break;
    case Step::wait:
      hand.frames.resize(static_cast<std::size_t>(step.frames));
      break;
    default:
      break;
  }
  hand.hold(false);
  return std::move(hand.frames);
}

}  // namespace neve::app::view::replay
