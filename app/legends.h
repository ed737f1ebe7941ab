#pragma once
/// Which colour bars a view needs.

#include <vector>

#include "app/scene/scene.h"
#include "render/frame.h"

namespace neve::app {

/// One for each thing that the view colours by a value. @param view resolved: ranges are there
std::vector<render::Legend> legends_of(const View& view);

}  // namespace neve::app
