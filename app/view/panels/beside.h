#pragma once
/// Place of lists that must not cover the picture.

#include <imgui.h>

#include "app/view/panels/viewer_state.h"

namespace neve::app::view::panels {

struct PanelPlace {
  ImVec2 at, size;  ///< px
};

/// The right column, else the left one, else all that is below the picture. Hidden panels come
/// back.
PanelPlace column_beside(ViewerState& state);

}  // namespace neve::app::view::panels
