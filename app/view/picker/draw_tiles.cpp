/// The nine tiles: numbers, the pointed and the chosen one, and how far their runs are.

#include <imgui.h>

#include <algorithm>
#include <string>

#include "app/view/panels/labels.h"
#include "app/view/picker/colours.h"
#include "app/view/picker/picker_state.h"

namespace neve::app::view::picker {

namespace {

struct Frame {
  ImVec2 low, high;
};

Frame frame_of(const Grid& grid, int tile) {
  const ImVec2 low(static_cast<float>(grid.tile_x(tile)), static_cast<float>(grid.tile_y(tile)));
  return {low, ImVec2(low.x + static_cast<float>(grid.tile_width),
                      low.y + static_cast<float>(grid.tile_height))};
}

Frame whole_grid(const Grid& grid) {
  return {frame_of(grid, 0).low, frame_of(grid, tile_count - 1).high};
}

void draw_badge(ImVec2 at, const std::string& text, ImU32 color) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float pad = 0.3f * em();
  list.AddRectFilled(at, ImVec2(at.x + size.x + 2 * pad, at.y + size.y + pad), colour::shadow,
                     0.25f * em());
  list.AddText(ImVec2(at.x + pad, at.y + 0.5f * pad), color, text.c_str());
}

/// Words in the middle of a tile, cut where it is too small for them.
void draw_words_over(const Frame& frame, const std::string& text, ImU32 color) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float pad = 0.4f * em(), width = frame.high.x - frame.low.x - 2 * pad;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, width);
  const float height = frame.high.y - frame.low.y;
  const ImVec2 at(frame.low.x + std::max(pad, 0.5f * (width + 2 * pad - size.x)),
                  frame.low.y + std::max(1.5f * em(), 0.5f * (height - size.y)));
  list.PushClipRect(frame.low, frame.high, true);
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, color, text.c_str(), nullptr, width);
  list.PopClipRect();
}

std::string progress_text(const sweep::jobs::RunProgress& run) {
  if (run.state == sweep::store::RunState::running)
    return std::to_string(run.made) + " of " + std::to_string(run.frames) + " frames";
  return run.has_ended() ? "" : "waiting";
}

void draw_progress(const Frame& frame, const sweep::jobs::RunProgress& run) {
  if (run.frames <= 0) return;
  const float share = static_cast<float>(run.made) / static_cast<float>(run.frames);
  const float thick = std::max(2.0f, 0.22f * em()), top = frame.high.y - thick;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(ImVec2(frame.low.x, top), frame.high, colour::line);
  list.AddRectFilled(ImVec2(frame.low.x, top),
                     ImVec2(frame.low.x + share * (frame.high.x - frame.low.x), frame.high.y),
                     colour::accent);
}

/// A tile that waits for its run: a picture of the round before, if there is one, behind a veil.
void draw_waiting(const Frame& frame, const sweep::jobs::RunProgress& run, bool is_stopping) {
  ImGui::GetWindowDrawList()->AddRectFilled(frame.low, frame.high, colour::veil);
  draw_words_over(frame, is_stopping ? "" : progress_text(run), colour::text);
  draw_progress(frame, run);
}

void draw_border(const PickerState& state, const Frame& frame, int tile) {
  const bool is_first = state.first == tile, is_pointed = state.pointed == tile;
  if (!is_first && !is_pointed) return;
  const float thick = std::max(2.0f, 0.2f * em());
  ImGui::GetWindowDrawList()->AddRect(
      frame.low, frame.high, is_first ? colour::liked : colour::accent, 0.2f * em(), 0, thick);
}

std::string badge_text(const PickerState& state, int tile) {
  const std::string number = std::to_string(tile + 1);
  const ShownTile& shown = state.tiles[static_cast<std::size_t>(tile)];
  const bool is_favourite = tile == 0 && shown.is_new && state.phase != Phase::over &&
                            state.game.lesson().has_favourite();
  const bool has_room = static_cast<float>(state.layout.grid.tile_width) > 12 * em();
  return is_favourite && has_room ? number + "  favourite so far" : number;
}

/// Draws what the other seeds of a tile say, at its lower edge.
void draw_noise(const PickerState& state, const Frame& frame, int tile) {
  const auto k = static_cast<std::size_t>(tile);
  if (k >= state.noise.tiles.size() || state.noise.tiles[k].empty()) return;
  const float inset = 0.3f * em(), room = frame.high.x - frame.low.x - 4 * inset;
  const std::string& text = state.noise.tiles[k];
  // A small tile has room for its letters alone.
  const bool has_room = ImGui::CalcTextSize(text.c_str()).x <= room;
  draw_badge(ImVec2(frame.low.x + inset, frame.high.y - 1.9f * em()),
             has_room ? text : state.noise.letters[k], colour::text);
}

void draw_tile(PickerState& state, int tile) {
  const ShownTile& shown = state.tiles[static_cast<std::size_t>(tile)];
  const Frame frame = frame_of(state.layout.grid, tile);
  const std::string name = "tile " + std::to_string(tile + 1);
  ImGui::SetCursorScreenPos(frame.low);
  const bool is_clicked = ImGui::InvisibleButton(
      name.c_str(), ImVec2(frame.high.x - frame.low.x, frame.high.y - frame.low.y));
  panels::note_label(name.c_str());
  if (ImGui::IsItemHovered()) state.pointed = tile;
  const sweep::jobs::RunProgress run = state.run(tile);
  if (!shown.is_new && state.phase != Phase::over) draw_waiting(frame, run, state.is_stopping);
  if (shown.is_new && run.has_failed()) {
    ImGui::GetWindowDrawList()->AddRectFilled(frame.low, frame.high, colour::veil);
    draw_words_over(frame, run.reason, colour::wrong);
  }
  draw_border(state, frame, tile);
  const float inset = 0.3f * em();
  draw_badge(ImVec2(frame.low.x + inset, frame.low.y + inset), badge_text(state, tile),
             state.first == tile ? colour::liked : colour::text);
  draw_noise(state, frame, tile);
  if (is_clicked) click_tile(state, tile, ImGui::GetIO().KeyShift);
  // A finger that rests is the right button.
  if (ImGui::IsItemClicked(1) && shown.is_new) state.closer = tile;
}

void draw_closer(PickerState& state) {
  const Frame frame = whole_grid(state.layout.grid);
  const int tile = *state.closer;
  ImGui::SetCursorScreenPos(frame.low);
  if (ImGui::InvisibleButton(
          "closer", ImVec2(frame.high.x - frame.low.x, frame.high.y - frame.low.y - 2.6f * em())))
    state.closer.reset();
  panels::note_label("closer");
  const float inset = 0.4f * em();
  draw_badge(ImVec2(frame.low.x + inset, frame.low.y + inset), "Tile " + std::to_string(tile + 1),
             colour::text);
  state.pointed = tile;
  ImGui::SetCursorScreenPos(ImVec2(frame.low.x + inset, frame.high.y - 2.3f * em()));
  const bool is_asking = state.phase == Phase::asking;
  if (is_asking && panels::labelled_button("Choose this one"))
    click_tile(state, tile, ImGui::GetIO().KeyShift);
  if (is_asking) ImGui::SameLine();
  if (panels::labelled_button("All nine")) state.closer.reset();
}

/// The picture of the result takes the place of the tiles, or a veil lies over them.
void draw_pick(const PickerState& state) {
  const Frame frame = whole_grid(state.layout.grid);
  if (!state.closer && !state.values.empty())
    ImGui::GetWindowDrawList()->AddRectFilled(frame.low, frame.high, colour::veil);
  if (state.closer)
    draw_badge(ImVec2(frame.low.x + 0.4f * em(), frame.low.y + 0.4f * em()), "The pick",
               colour::liked);
}

}  // namespace

void draw_tiles(PickerState& state) {
  state.pointed = -1;
  if (state.phase == Phase::over) {
    draw_pick(state);
    return;
  }
  if (state.closer) {
    draw_closer(state);
    return;
  }
  for (int tile = 0; tile < tile_count; ++tile) draw_tile(state, tile);
}

}  // namespace neve::app::view::picker
