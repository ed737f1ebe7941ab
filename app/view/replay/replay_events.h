#pragma once
/// Events of a step, for each of the frames that it takes.

#include <vector>

#include "app/view/frontend/frontend.h"
#include "app/view/replay/replay_script.h"

namespace neve::app::view::replay {

/// px of the picture
struct ReplayPoint {
  float x = 0, y = 0;
};

/// Events of a step. The move, press and release of a click take three frames, as by hand, and the
/// panels follow in a fourth.
/// @param points where its places are now
/// @return the events before each frame; nothing for steps that are no input
std::vector<std::vector<frontend::InputEvent>> events_of(const ReplayStep& step,
                                                         const std::vector<ReplayPoint>& points);

}  // namespace neve::app::view::replay
