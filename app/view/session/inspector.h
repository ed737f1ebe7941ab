#pragma once
/// Looks inside the next step, on a copy: after a stage, and at a probe.

#include <optional>
#include <utility>

#include "app/support/clock.h"
#include "app/timeline/timeline.h"
#include "app/view/session/live_frame.h"

namespace neve::app::view::session {

class Inspector {
 public:
  /// The stage of the step that was done last; nothing: the state between two steps is shown.
  std::optional<sim::Stage> stage{};

  void set_probe(std::optional<dump::Probe> probe) {
    probe_ = std::move(probe);
    reading_.reset();
    probed_at_ = {};
  }
  const std::optional<dump::Probe>& probe() const { return probe_; }
  void set_histogram(std::optional<FieldName> field) {
    histogram_ = std::move(field);
    probed_at_ = {};
  }

  /// The last readings are of a moment that was left.
  void look_again() { probed_at_ = {}; }

  /// Goes on to the next stage. @return false after the last one
  bool next_stage();

  /// Adds the stage, the probe and the histogram to a frame. A running simulation is probed four
  /// times a second.
  void inspect(timeline::Timeline& timeline, bool is_running, LiveFrame& live);

 private:
  std::optional<dump::Probe> probe_;
  std::optional<ProbeReading> reading_;  ///< the last one
  std::optional<FieldName> histogram_;
  std::optional<HistogramReading> spread_;  ///< the last one
  Clock::time_point probed_at_{};
};

}  // namespace neve::app::view::session
