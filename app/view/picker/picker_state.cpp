#include "app/view/picker/picker_state.h"

#include <imgui.h>

#include <algorithm>

#include "app/view/frontend/imgui_input.h"

namespace neve::app::view::picker {

namespace {

void wish_for(PickerState& state, pick::Click click) {
  state.wish = {Wish::Kind::choose, std::move(click)};
  state.first.reset();
  state.takes_two = false;
  state.closer.reset();
}

}  // namespace

sweep::jobs::RunProgress PickerState::run(int tile) const {
  const auto k = static_cast<std::size_t>(tile);
  return k < runs.runs.size() ? runs.runs[k] : sweep::jobs::RunProgress{};
}

void click_tile(PickerState& state, int tile, bool is_pair) {
  if (state.phase != Phase::asking) return;
  state.note = pick::why_not(state.runs, {tile});
  if (!state.note.empty()) return;
  if (!state.first && (is_pair || state.takes_two)) {
    state.first = tile;
  } else if (!state.first) {
    wish_for(state, {tile});
  } else if (*state.first == tile) {
    state.first.reset();  // clicked again: taken back
  } else {
    wish_for(state, {*state.first, tile});
  }
}

void use_keys(PickerState& state) {
  namespace key = frontend::key;
  using frontend::is_key_pressed;
  const auto wish = [&](Wish::Kind kind) { state.wish = {kind, {}}; };
  if (state.phase == Phase::asking) {
    const bool is_pair = ImGui::GetIO().KeyShift;
    for (int tile = 0; tile < tile_count; ++tile)
      if (is_key_pressed('1' + tile)) click_tile(state, tile, is_pair);
    if (is_key_pressed('0')) wish_for(state, {});
    if (is_key_pressed('T')) {
      state.takes_two = !state.takes_two;
      state.first.reset();
    }
  }
  if (is_key_pressed('U') && state.can_undo()) wish(Wish::Kind::undo);
  if (is_key_pressed('Q')) wish(state.phase == Phase::over ? Wish::Kind::done : Wish::Kind::stop);
  if (is_key_pressed(key::escape)) {
    state.closer.reset();
    state.first.reset();
  }
  const int step =
      static_cast<int>(is_key_pressed(key::right)) - static_cast<int>(is_key_pressed(key::left));
  if (state.closer) state.closer = (*state.closer + tile_count + step) % tile_count;
}

float em() {
  return ImGui::GetFontSize();
}

}  // namespace neve::app::view::picker
