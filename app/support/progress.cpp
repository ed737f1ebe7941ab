#include "app/support/progress.h"

#include <fcntl.h>
#include <unistd.h>

#include <fmt/chrono.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <iostream>

#include "app/support/errors.h"
#include "app/support/film_rate.h"
#include "app/support/text.h"
#include "app/support/version.h"

namespace neve::app {

namespace {

constexpr std::size_t window = 8;  // frames; an average since the start would mislead
constexpr auto update_interval = std::chrono::milliseconds(200);
constexpr auto line_interval = std::chrono::seconds(10);
constexpr auto event_interval = std::chrono::seconds(1);
constexpr auto work_window = std::chrono::seconds(120);

}  // namespace

std::string time_text() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string progress_text(const ProgressState& state) {
  // Inside a frame the time is later than that of its number.
  const double fps = state.time > 0 ? std::max(state.frame, 1) / state.time : 1;
  std::string text = "frame " + std::to_string(state.first_number + state.frame) + "/" +
                     std::to_string(state.first_number + state.last_frame) +
                     "  t = " + time_text(state.time, fps) + "  " + std::to_string(state.steps) +
                     " steps";
  if (state.seconds_per_frame >= 0) {
    const int left = state.last_frame - state.frame;
    text += "  " + fixed_text(state.seconds_per_frame, 2) + " s/frame  " +
            duration_text(left * state.seconds_per_frame) + " left";
  }
  return text;
}

std::string runs_text(const RunCounts& counts) {
  std::string text = std::to_string(counts.finished) + "/" + std::to_string(counts.all) + " runs";
  if (counts.failed > 0) text += "  " + std::to_string(counts.failed) + " failed";
  if (counts.running > 0) text += "  " + std::to_string(counts.running) + " running";
  if (counts.seconds_left >= 0) text += "  " + duration_text(counts.seconds_left) + " left";
  return text;
}

void WorkClock::note(double done, Clock::time_point now) {
  seen_.emplace_back(now, done);
  while (seen_.size() > 2 && now - seen_[1].first > work_window) seen_.pop_front();
}

double WorkClock::seconds_for(double left) const {
  if (seen_.size() < 2) return -1;
  const std::chrono::duration<double> span = seen_.back().first - seen_.front().first;
  const double done = seen_.back().second - seen_.front().second;
  return done > 0 && span.count() > 1 ? left * span.count() / done : -1;
}

void append_line(const std::string& file, const std::string& line) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC, 0666);
  if (fd < 0) return;
  const std::string text = printable_text(line) + "\n";
  [[maybe_unused]] const ssize_t written = ::write(fd, text.data(), text.size());
  ::close(fd);
}

bool can_update_lines(int fd) {
  const char* terminal = std::getenv("TERM");
  const char* no_color = std::getenv("NO_COLOR");
  if (no_color && *no_color) return false;
  return ::isatty(fd) == 1 && terminal && std::strcmp(terminal, "dumb") != 0;
}

Progress::Progress(std::ostream& out, Verbosity verbosity, bool updates,
                   const ProgressOptions& options)
    : out_(out),
      verbosity_(verbosity),
      updates_(updates && !options.is_json),
      is_json_(options.is_json),
      shown_at_(Clock::now()) {
  if (!options.log.empty()) open_log(options.log);
}

Progress::Progress(Verbosity verbosity, const ProgressOptions& options)
    : Progress(std::cerr, verbosity, can_update_lines(STDERR_FILENO), options) {}

void Progress::open_log(const std::string& file) {
  const auto fail = [&](int reason) {
    throw IoError(file + ": error: cannot be written: " +
                      (reason == ENXIO ? "nobody reads this pipe" : std::strerror(reason)),
                  file, "give --log a file in a folder that exists");
  };
  // Opened so, a pipe without a reader does not wait for one.
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC, 0666);
  if (fd < 0) fail(errno);
  errno = 0;
  log_.open(file, std::ios::app);
  const int reason = errno;
  ::close(fd);
  if (!log_) fail(reason);
  log(std::string("neve ") + version);
  if (!log_) fail(errno);
}

Progress::~Progress() {
  clear();
}

void Progress::start(int last_frame, int first_number) {
  const std::lock_guard lock(mutex_);
  state_ = {};
  state_.last_frame = last_frame;
  state_.first_number = first_number;
  finished_at_.assign(1, Clock::now());
  if (is_json_) print_event({{"event", "start"}, {"last_frame", first_number + last_frame}});
}

bool Progress::is_due(Clock::time_point now) const {
  return now - shown_at_ >= (updates_   ? Clock::duration(update_interval)
                             : is_json_ ? Clock::duration(event_interval)
                                        : Clock::duration(line_interval));
}

void Progress::step(double time) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  // Frame 0 took no steps, and says nothing of the time that others take.
  if (state_.steps == 0) {
    finished_at_.assign(1, now);
    state_.seconds_per_frame = -1;
  }
  ++state_.steps;
  state_.time = time;
  if (is_due(now)) show_frame(now);
}

void Progress::line(const std::string& text) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (is_due(now)) show(now, text, {{"event", "progress"}, {"text", text}});
}

void Progress::runs(const RunCounts& counts) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (!is_due(now)) return;
  show(now, runs_text(counts),
       {{"event", "runs"},
        {"finished", counts.finished},
        {"failed", counts.failed},
        {"running", counts.running},
        {"all", counts.all},
        {"seconds_left", counts.seconds_left < 0 ? Json() : Json(counts.seconds_left)}});
}

void Progress::frame(int frame, double time) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  state_.frame = frame;
  state_.time = time;
  finished_at_.push_back(now);
  if (finished_at_.size() > window + 1) finished_at_.pop_front();
  const std::chrono::duration<double> span = finished_at_.back() - finished_at_.front();
  state_.seconds_per_frame = span.count() / static_cast<double>(finished_at_.size() - 1);
  log(progress_text(state_));
  // A program wants to know of every frame.
  if (updates_ || is_json_ || now - shown_at_ >= line_interval) show_frame(now);
}

void Progress::show_frame(Clock::time_point now) {
  const double each = state_.seconds_per_frame;
  const int left = state_.last_frame - state_.frame;
  show(now, progress_text(state_),
       {{"event", "frame"},
        {"frame", state_.first_number + state_.frame},
        {"last_frame", state_.first_number + state_.last_frame},
        {"time", state_.time},
        {"steps", state_.steps},
        {"seconds_per_frame", each < 0 ? Json() : Json(each)},
        {"seconds_left", each < 0 ? Json() : Json(left * each)}});
}

void Progress::show(Clock::time_point now, const std::string& text, const Json& event) {
  shown_at_ = now;
  if (verbosity_ == Verbosity::quiet) return;
  if (is_json_) {
    print_event(event);
  } else if (updates_) {
    out_ << "\r\033[K" << text << std::flush;
    has_line_ = true;
  } else {
    out_ << text << std::endl;
  }
}

void Progress::clear_line() {
  if (has_line_) out_ << "\r\033[K" << std::flush;
  has_line_ = false;
}

void Progress::print_event(const Json& event) {
  out_ << to_text(event, -1) << std::endl;
}

/// @param text of the event, without "neve: warning: "
void Progress::print(const std::string& message, const char* event, const std::string& text) {
  if (is_json_) return print_event({{"event", event}, {"text", text}});
  clear_line();
  out_ << printable_text(message) << std::endl;
}

void Progress::log(const std::string& message) {
  if (!log_.is_open() || !log_) return;
  errno = 0;
  log_ << time_text() << "  " << printable_text(message) << std::endl;
  if (log_ || !is_log_begun_) {
    is_log_begun_ = true;
    return;
  }
  print(std::string("neve: warning: --log cannot be written any more: ") + std::strerror(errno),
        "warning", "--log cannot be written any more");
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  clear_line();
}

void Progress::note(const std::string& message) {
  const std::lock_guard lock(mutex_);
  log(message);
  if (verbosity_ != Verbosity::quiet) print(message, "note", message);
}

void Progress::detail(const std::string& message) {
  const std::lock_guard lock(mutex_);
  log(message);
  if (verbosity_ == Verbosity::verbose) print(message, "note", message);
}

void Progress::warning(const std::string& message) {
  const std::lock_guard lock(mutex_);
  log("warning: " + message);
  print("neve: warning: " + message, "warning", message);
}

void Progress::say(const std::string& message) {
  const std::lock_guard lock(mutex_);
  log(message);
  print("neve: " + message, "note", message);
}

}  // namespace neve::app
