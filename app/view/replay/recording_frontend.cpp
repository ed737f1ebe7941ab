#include "app/view/replay/recording_frontend.h"

#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "app/view/replay/replay_script.h"

namespace neve::app::view::replay {

using Clock = std::chrono::steady_clock;

RecordingFrontend::RecordingFrontend(frontend::Frontend& front, std::filesystem::path file)
    : front_(front), file_(std::move(file)), start_(Clock::now()) {
  recorder_.set_size(front_.size());
  save();
}

RecordingFrontend::~RecordingFrontend() {
  try {
    save();
  } catch (const IoError&) {
    // wait() told it already, or the disk has become full in the last second.
  }
}

std::vector<frontend::InputEvent> RecordingFrontend::wait(double seconds) {
  std::vector<frontend::InputEvent> events = front_.wait(seconds);
  const auto now = Clock::now();
  recorder_.set_size(front_.size());
  recorder_.note(events, std::chrono::duration<double>(now - start_).count());
  const bool is_over = !events.empty() && events.back().kind == frontend::InputEvent::Kind::close;
  const bool is_due =
      recorder_.steps().size() != saved_steps_ && now - saved_ > std::chrono::seconds(1);
  if (is_over || is_due) save();
  return events;
}

void RecordingFrontend::set_progress(int frame, bool is_running) {
  recorder_.set_progress(frame, is_running);
  front_.set_progress(frame, is_running);
}

void RecordingFrontend::save() {
  output::write_named_file(file_, replay_text(recorder_.steps()));
  saved_ = Clock::now();
  saved_steps_ = recorder_.steps().size();
}

}  // namespace neve::app::view::replay
