#pragma once
/// The curves of a run over time, finer than its frames.

#include <memory>
#include <vector>

#include "app/support/clock.h"
#include "app/timeline/timeline.h"
#include "app/view/session/live_frame.h"

namespace neve::app::view::session {

/// s, from the state to the end of its frame.
double seconds_left(const timeline::Timeline& timeline);

class Samples {
 public:
  /// Begins with the frames that a run has made.
  void begin(const std::vector<record::FrameRecord>& frames = {});

  /// Adds the state between two steps.
  void note(const timeline::Timeline& timeline) {
    note(timeline, timeline.summary(), timeline.here().advance.max_force());
  }
  /// The same from the thread that takes the steps, unless it takes too large a share of the time:
  /// the elastic energy needs a decomposition per particle. Forces on colliders are then unknown:
  /// the timeline has them when the steps have been taken.
  void note_if_cheap(const timeline::Timeline& timeline);
  void forget_after(double time);

  const std::shared_ptr<std::vector<RunSample>>& list() const { return list_; }

 private:
  void note(const timeline::Timeline& timeline, const sim::Summary& summary, double max_force);
  std::vector<RunSample>& own_list();

  std::shared_ptr<std::vector<RunSample>> list_ = std::make_shared<std::vector<RunSample>>();
  Clock::time_point noted_at_{};
  Clock::duration noting_took_{};
};

}  // namespace neve::app::view::session
