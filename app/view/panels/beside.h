#pragma once
/// Place of lists that must not cover the picture.

#include <imgui.h>

#include <vector>

#include "app/view/frontend/frontend.h"
#include "app/view/panels/viewer_state.h"

namespace neve::app::view::panels {

struct PanelPlace {
  ImVec2 at, size;  ///< px
};

/// The right column, else the left one, else all that is below the picture. Hidden panels come
/// back.
PanelPlace column_beside(ViewerState& state);

/// All lists of this picture that have more than they show.
std::vector<frontend::ScrollPlace> scroll_places();

}  // namespace neve::app::view::panels
