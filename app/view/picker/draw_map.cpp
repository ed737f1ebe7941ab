/// Expected liking over the two axes that tell most.

#include <imgui.h>

#include <algorithm>

#include "app/view/panels/labels.h"
#include "app/view/panels/words.h"
#include "app/view/picker/colours.h"
#include "app/view/picker/picker_state.h"
#include "render/overlay/plots.h"

namespace neve::app::view::picker {

void draw_map(const PickerState& state) {
  const float width = ImGui::GetContentRegionAvail().x, left = 4.6f * em(), top = 1.6f * em();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float side = std::max(4 * em(), std::min(width - left, 22 * em()));
  render::overlay::ImGuiCanvas canvas(*ImGui::GetFont(), *ImGui::GetWindowDrawList());
  render::overlay::draw_plot(
      *state.map, {at.x + left, at.x + left + side, at.y + top, at.y + top + side}, {}, canvas);
  ImGui::Dummy(ImVec2(width, top + side + 3.2f * em()));
  panels::note_label("map");
  panels::dim_text(pick::map_words);
}

}  // namespace neve::app::view::picker
