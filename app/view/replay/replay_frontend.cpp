#include "app/view/replay/replay_frontend.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include "app/advice/suggest.h"
#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "render/frame/compose.h"
#include "render/image/image.h"
#include "render/screen.h"

namespace neve::app::view::replay {

namespace {

/// px of the picture
struct ReplayPoint {
  float x = 0, y = 0;
};

using Step = ReplayStep::Kind;
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

  /// Turns the wheel notch by notch, as hands do.
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
    const bool is_letter = code >= 'A' && code <= 'Z';
    if (step_.held.shift && !is_letter) return {};  // another sign on each keyboard
    if (is_letter && !step_.held.shift) code += 'a' - 'A';
    return std::string(1, static_cast<char>(code));
  }

  const ReplayStep& step_;
};

/// Events of a step. The move, press and release of a click take three frames, as by hand, and the
/// panels follow in a fourth.
/// @param points where its places are now
/// @return the events before each frame; nothing for steps that are no input
std::vector<std::vector<frontend::InputEvent>> events_of(const ReplayStep& step,
                                                         const std::vector<ReplayPoint>& points) {
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

/// Panels need some frames to open; a label that needs more does not come.
constexpr int patience = 120;
constexpr double frame_seconds = 1.0 / 60;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool is_near(const panels::LabelPlace& a, const panels::LabelPlace& b) {
  return std::abs(a.x - b.x) < 1 && std::abs(a.y - b.y) < 1 && std::abs(a.width - b.width) < 1 &&
         std::abs(a.height - b.height) < 1;
}

render::Image cut(const render::Image& picture, int x, int y, int width, int height) {
  return render::compose(width, height, {0, 0, 0}, {{-x, -y, picture}});
}

std::array<int, 4> whole_pixels(const panels::LabelPlace& place) {
  return {static_cast<int>(std::floor(place.x)), static_cast<int>(std::floor(place.y)),
          static_cast<int>(std::ceil(place.width)), static_cast<int>(std::ceil(place.height))};
}

}  // namespace

ReplayFrontend::ReplayFrontend(std::vector<ReplayStep> steps, std::string file, Options options)
    : steps_(std::move(steps)), file_(std::move(file)), options_(std::move(options)) {
  panels::Labels::of_panels().clear();
}

void ReplayFrontend::give_up(const ReplayStep& step, const std::string& message,
                             const std::string& hint) const {
  const std::string where =
      file_ + ":" + std::to_string(step.line) + ":" + std::to_string(step.column);
  const std::size_t number = static_cast<std::size_t>(&step - steps_.data()) + 1;
  throw Error(exit_check_failed,
              where + ": error: step " + std::to_string(number) + " (" + name(step.kind) +
                  "): " + message + (hint.empty() ? "" : "; " + hint),
              where, hint);
}

void ReplayFrontend::give_up_label(const ReplayStep& step, const std::string& label) const {
  const panels::Labels& labels = panels::Labels::of_panels();
  const std::string all = joined(labels.names(), ", ");
  const std::string hint = advice::suggest(
      label, {"", labels.names(), true}, all.empty() ? "there are no labels" : "there are: " + all);
  const auto place = labels.find(label);
  const std::string what = !place              ? " is not on the picture"
                           : place->is_visible ? " does not come to rest"
                                               : " cannot be scrolled into sight";
  give_up(step, "\"" + label + "\"" + what, hint);
}

bool ReplayFrontend::is_picture_wanted() const {
  if (screenshot_) return true;
  if (frames_waited_ == 0) return false;
  const ReplayStep& step = steps_[next_];
  return step.kind != Step::wait_for || parse_goal(step.text)->kind == ReplayGoal::Kind::label;
}

std::vector<frontend::InputEvent> ReplayFrontend::wait(double seconds) {
  if (is_idle_) {
    std::unique_lock lock(mutex_);
    const auto longest = std::chrono::duration<double>(std::clamp(seconds, 0.0, frame_seconds));
    woken_.wait_for(lock, longest, [&] { return is_woken_; });
    is_woken_ = false;
  }
  ++frame_;
  if (options_.frames > 0 && frame_ > options_.frames) return closing();
  while (frames_.empty() && next_ < steps_.size() && begin(steps_[next_])) {
    ++next_;
    frames_waited_ = 0;
    seen_.clear();
  }
  is_idle_ = frames_.empty() || frames_.front().events.empty();
  if (frames_.empty()) {
    if (next_ == steps_.size() && options_.frames == 0) return closing();
    return {};
  }
  NextFrame next = std::move(frames_.front());
  frames_.pop_front();
  if (next.screenshot) screenshot_ = next.screenshot;
  return std::move(next.events);
}

std::vector<frontend::InputEvent> ReplayFrontend::closing() const {
  if (next_ < steps_.size())
    give_up(steps_[next_],
            "not reached after " + std::to_string(options_.frames) + " frames of the panels",
            "raise --frames");
  return {{.kind = frontend::InputEvent::Kind::close}};
}

bool ReplayFrontend::begin(const ReplayStep& step) {
  if (frame_ < step.at_frame) return false;
  switch (step.kind) {
    case Step::wait_for: {
      if (is_reached(*parse_goal(step.text))) return true;
      if (!is_in_time(step))
        give_up(step, "no " + step.text + " within " + rough_text(step.seconds) + " s", {});
      ++frames_waited_;
      return false;
    }
    case Step::screenshot:
      frames_ = {{}, {{}, &step}};
      return true;
    case Step::resize:
      options_.size = step.size;
      frames_.push_back({{{.kind = frontend::InputEvent::Kind::resize,
                           .x = static_cast<float>(step.size.width),
                           .y = static_cast<float>(step.size.height)}}});
      return true;
    case Step::drop: {
      const std::string path = (options_.folder / step.text).lexically_normal().string();
      frames_.push_back({{{.kind = frontend::InputEvent::Kind::drop, .text = path}}});
      return true;
    }
    case Step::quit:
      frames_.push_back({{{.kind = frontend::InputEvent::Kind::close}}});
      next_ = steps_.size() - 1;  // later steps are left out
      return true;
    default:
      return begin_on_places(step);
  }
}

bool ReplayFrontend::begin_on_places(const ReplayStep& step) {
  std::vector<ReplayPoint> points;
  bool is_found = true;
  std::string missing;
  for (const ReplayPlace& place : step.places) {
    panels::LabelPlace label;
    if (place.label.empty()) {
      points.push_back({place.x, place.y});
    } else if (find(place.label, label)) {
      points.push_back({label.x + place.x * label.width, label.y + place.y * label.height});
    } else {
      is_found = false;
      missing = place.label;
    }
  }
  if (!is_found && ++frames_waited_ > patience) give_up_label(step, missing);
  if (!is_found) return false;
  for (std::vector<frontend::InputEvent>& events : events_of(step, points))
    frames_.push_back({std::move(events)});
  return true;
}

/// True for a label in sight, where it was a frame ago: panels that open move at first.
bool ReplayFrontend::find(const std::string& label, panels::LabelPlace& place) {
  const std::optional<panels::LabelPlace> found = panels::Labels::of_panels().find(label);
  if (!found) return false;
  if (!found->is_visible) {
    panels::Labels::of_panels().scroll_to(label);
    return false;
  }
  const auto before = seen_.find(label);
  const bool is_at_rest = before != seen_.end() && is_near(before->second, *found);
  seen_[label] = place = *found;
  return is_at_rest;
}

bool ReplayFrontend::is_reached(const ReplayGoal& goal) const {
  switch (goal.kind) {
    case ReplayGoal::Kind::frame:
      return simulation_frame_ >= goal.frame;
    case ReplayGoal::Kind::running:
      return is_simulation_running_;
    case ReplayGoal::Kind::paused:
      return simulation_frame_ && !is_simulation_running_;
    case ReplayGoal::Kind::label:
      return panels::Labels::of_panels().find(goal.label).has_value();
  }
  return false;
}

bool ReplayFrontend::is_in_time(const ReplayStep& step) {
  if (frames_waited_ == 0) waiting_since_ = now();
  return now() - waiting_since_ < step.seconds;
}

void ReplayFrontend::wake() {
  const std::lock_guard lock(mutex_);
  is_woken_ = true;
  woken_.notify_all();
}

void ReplayFrontend::set_progress(int frame, bool is_running) {
  simulation_frame_ = frame;
  is_simulation_running_ = is_running;
}

void ReplayFrontend::show(render::Screen& screen) {
  if (!screenshot_) return;
  const ReplayStep& step = *std::exchange(screenshot_, nullptr);
  render::Image picture = screen.pixels();
  std::optional<std::array<int, 4>> crop = step.crop;
  if (!step.crop_label.empty()) {
    const auto place = panels::Labels::of_panels().find(step.crop_label);
    if (!place || !place->is_visible) give_up_label(step, step.crop_label);
    crop = whole_pixels(*place);
  }
  if (crop) {
    const auto [x, y, width, height] = *crop;
    if (x + width > picture.width || y + height > picture.height)
      give_up(step,
              "the part reaches beyond the picture of " + std::to_string(picture.width) + "x" +
                  std::to_string(picture.height) + " px",
              {});
    picture = cut(picture, x, y, width, height);
  }
  const std::filesystem::path path = options_.folder / step.text;
  output::make_folder(path.parent_path());
  output::write_file(path, render::encode_png(picture));
}

}  // namespace neve::app::view::replay
