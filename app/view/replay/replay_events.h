#pragma once
/// What somebody does in a step, as the events of the frames that it takes.

#include <vector>

#include "app/view/front/front.h"
#include "app/view/replay/replay_script.h"

namespace neve::app::view::replay {

/// px of the picture
struct ReplayPoint {
  float x = 0, y = 0;
};

/// Of a click the move, the press and the release come in three frames, as from a hand, and a frame
/// in which the panels follow.
/// @param points where its places are now
/// @return for each frame what happens before it; nothing for steps that are no input
std::vector<std::vector<front::InputEvent>> events_of(const ReplayStep& step,
                                                      const std::vector<ReplayPoint>& points);

}  // namespace neve::app::view::replay
