#pragma once
/// The one way a run reports how far it is, on stderr.

#include <chrono>
#include <cstddef>
#include <deque>
#include <fstream>
#include <mutex>
#include <ostream>
#include <string>
#include <utility>

#include "app/support/json.h"

namespace neve::app {

enum class Verbosity { quiet, normal, verbose };

/// The form of progress on the screen, and the log that it goes to as well.
struct ProgressOptions {
  bool is_json = false;  ///< one JSON object a line instead of text, for programs that watch
  std::string log;       ///< file to append all messages to, with times; empty: none
};

/// Contents of a progress line.
struct ProgressState {
  int frame = 0, last_frame = 0;  ///< counted from 0
  double time = 0;                ///< s, simulated, also inside a frame
  std::size_t steps = 0;          ///< since the start
  double seconds_per_frame = -1;  ///< over the trailing window, negative: not known yet
  int first_number = 0;           ///< of frame 0
};

/// "frame 12/48  t = 0.500 s  320 steps  0.42 s/frame  15 s left"
std::string progress_text(const ProgressState& state);

/// The time now, "2026-11-23T06:10:00Z".
std::string time_text();

/// "8 s", "3 min 20 s", "2 h 05 min"
std::string duration_text(double seconds);

/// Adds a line to a log, as far as it can be written: a pipe has to have a reader.
void append_line(const std::string& file, const std::string& line);

/// Estimates the remaining time from the finished units of work.
class WorkClock {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param done so far, of the same unit as the rest
  void note(double done, Clock::time_point now = Clock::now());
  /// Returns s by the rate in a trailing window; negative if not known yet. @param left units
  double seconds_for(double left) const;

 private:
  std::deque<std::pair<Clock::time_point, double>> seen_;
};

/// Contents of the progress line of a sweep.
struct RunCounts {
  int finished = 0, failed = 0, running = 0, all = 0;
  double seconds_left = -1;  ///< negative: not known yet
};

/// "12/64 runs  2 failed  2 running  3 min 20 s left"
std::string runs_text(const RunCounts& counts);

/// True if a stream supports an updating line: a terminal that is not dumb, without NO_COLOR.
bool can_update_lines(int fd);

/// Any thread may call it.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param updates one line that is rewritten; otherwise a plain line every 10 s
  /// @throws IoError for a log that cannot be opened
  Progress(std::ostream& out, Verbosity verbosity, bool updates,
           const ProgressOptions& options = {});
  /// The same on standard error, with a line that is rewritten where that is a terminal.
  explicit Progress(Verbosity verbosity, const ProgressOptions& options = {});
  ~Progress();

  /// @param first_number  of frame 0, in lines and events
  void start(int last_frame, int first_number);
  /// A step was made; cheap. @param time  s, that it ends at
  void step(double time);
  /// A frame was finished.
  void frame(int frame, double time);

  /// The line of something that counts otherwise than in frames; cheap.
  void line(const std::string& text);
  /// The line of a sweep; cheap.
  void runs(const RunCounts& counts);

  /// A message between the lines; not in quiet runs.
  void note(const std::string& message);
  /// A message for --verbose.
  void detail(const std::string& message);
  /// A warning; always printed.
  void warning(const std::string& message);
  /// Words that are printed always, as they are: the end of an interrupted run.
  void say(const std::string& message);
  /// Removes the updating line.
  void clear();

 private:
  // Callers hold the mutex.
  void show(Clock::time_point now, const std::string& text, const Json& event);
  void show_frame(Clock::time_point now);
  bool is_due(Clock::time_point now) const;
  void clear_line();
  void print(const std::string& message, const char* event, const std::string& text);
  void print_event(const Json& event);
  void open_log(const std::string& file);
  void log(const std::string& message);

  std::mutex mutex_;
  std::ostream& out_;
  Verbosity verbosity_;
  bool updates_;
  bool is_json_;
  std::ofstream log_;
  bool is_log_begun_ = false;
  bool has_line_ = false;
  ProgressState state_;
  Clock::time_point shown_at_;
  std::deque<Clock::time_point> finished_at_;  ///< of the last frames: the window of the estimate
};

}  // namespace neve::app
