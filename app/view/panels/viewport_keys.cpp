/// Keys that are not for a text field.

#include <imgui_internal.h>

#include <algorithm>

#include "app/view/frontend/frontend.h"
#include "app/view/frontend/imgui_input.h"
#include "app/view/panels/viewer_state.h"

namespace neve::app::view::panels {

namespace {

/// True if a sign that was typed in this frame counts: a key that is held types it again and again.
/// Phones type without keys.
bool takes_signs(ViewerState& state) {
  bool is_new = false, is_down = false;
  for (int key = '!'; key <= '~'; ++key) {
    is_new = is_new || frontend::is_key_pressed(key);
    is_down = is_down || frontend::is_key_down(key);
  }
  if (is_new || !is_down) state.is_sign_taken = false;
  const bool takes = !state.is_sign_taken;
  if (is_down && !ImGui::GetIO().InputQueueCharacters.empty()) state.is_sign_taken = true;
  return takes;
}

}  // namespace

void use_keys(ViewerState& state) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput) return;
  const session::LiveFrame& live = *state.live;
  session::Session& session = state.bench.session();
  const auto pressed = [](int key) { return frontend::is_key_pressed(key); };
  if (io.KeyCtrl) {
    if (pressed('Z')) io.KeyShift ? state.bench.redo() : state.bench.undo();
    if (pressed('Y')) state.bench.redo();
    if (pressed('S')) state.bench.save_copy();
    return;
  }
  if (pressed(' ')) toggle_run(state);
  // A sign has another key on each keyboard, some with shift: what is typed tells it.
  const auto typed = [&, takes = takes_signs(state)](char sign) {
    return takes && io.InputQueueCharacters.contains(static_cast<ImWchar>(sign));
  };
  if (typed('.')) session.next_frame();
  if (typed(',')) session.next_step();
  if (typed(';')) {
    session.next_stage();
    state.go_to_tab = tab::inspect;
  }
  if (pressed('R')) state.bench.reset();
  if (pressed('P')) state.wants_picture = true;
  if (pressed('B')) switch_throwing(state);
  if (pressed('F')) io.KeyShift ? frame_all(state) : frame_selection(state);
  for (int axis = 0; axis < 3; ++axis)
    if (pressed('X' + axis)) {
      state.orbit.look_along(axis);
      state.is_camera_of_scene = false;
    }
  const std::vector<scene::View>& views = state.bench.document().scene()->views;
  for (std::size_t k = 0; k < std::min<std::size_t>(9, views.size()); ++k)
    if (typed(static_cast<char>('1' + k))) state.view = views[k].name;
  if (typed('?') || pressed(frontend::key::f1)) state.is_help_open = !state.is_help_open;
  if (pressed(frontend::key::escape)) {
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup))
      ImGui::ClosePopupToLevel(0, true);
    else if (state.is_help_open)
      state.is_help_open = false;
    else if (state.sweep.shows_sheet)
      state.sweep.shows_sheet = false;
    else if (state.throwing.is_on)
      state.throwing.is_on = false;
    else if (state.probe)
      set_probe(state, std::nullopt);
    else
      state.selected.clear();
  }
  if (pressed(frontend::key::tab)) {
    const bool is_on = state.panels.left || state.panels.right;
    state.panels = {!is_on, !is_on};
  }
  // Between two frames, the one before is the last one that was passed.
  if (frontend::is_key_pressed(frontend::key::left, true))
    session.show_frame(std::max(0, live.is_frame_end ? live.frame - 1 : live.frame));
  if (frontend::is_key_pressed(frontend::key::right, true)) {
    const auto next = std::upper_bound(live.kept.begin(), live.kept.end(), live.frame);
    show_frame(state, next == live.kept.end() ? live.head + 1 : *next);
  }
  if (pressed(frontend::key::home)) session.show_frame(0);
  if (pressed(frontend::key::end)) session.show_head();
}

}  // namespace neve::app::view::panels
