/// Words beside or below the tiles: what was learned, an error, or the pick and its files.

#include <imgui.h>

#include <algorithm>
#include <string>

#include "app/support/text.h"
#include "app/view/panels/labels.h"
#include "app/view/picker/colours.h"
#include "app/view/picker/picker_state.h"

namespace neve::app::view::picker {

namespace {

void say(const std::string& text, ImU32 color = colour::text) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

void draw_heading(const char* text) {
  ImGui::Dummy(ImVec2(0, 0.3f * em()));
  say(text, colour::accent);
  panels::note_label(text);
}

void draw_paragraph(const std::string& text, ImU32 color = colour::text) {
  say(text, color);
  ImGui::Dummy(ImVec2(0, 0.15f * em()));
}

void draw_lesson(const PickerState& state) {
  draw_heading("Learned so far");
  if (!state.map) {
    draw_paragraph(
        "Nothing yet. The first nine are spread evenly over the parameters; the next nine are made "
        "from your answer.");
    return;
  }
  const bool is_over = state.phase == Phase::over;
  for (const std::string& line : is_over ? state.learned : state.game.lesson().lines)
    draw_paragraph(line);
  ImGui::Dummy(ImVec2(0, 0.3f * em()));
  draw_map(state);
}

void draw_hand(const PickerState& state) {
  draw_heading("By hand");
  if (state.layout.is_stacked)
    draw_paragraph(
        "Tap a tile to choose it. Rest a finger on one to see it large, with its values.",
        colour::dim);
  else
    draw_paragraph(
        "A click chooses a tile, with shift the first of two. The right button shows one large. "
        "Keys: 1 to 9, 0 for none, T for two, U takes back, Q stops.",
        colour::dim);
}

void draw_failure(PickerState& state) {
  draw_heading("This round failed");
  draw_paragraph(state.failure, colour::wrong);
  draw_paragraph("Nothing is lost: your answers are in " +
                     (state.game.folder() / "clicks.txt").string() +
                     ", and runs that are finished are not made again. Solve this and try again; "
                     "or stop, and the same command continues later.",
                 colour::dim);
}

void draw_command(const PickerState& state, const std::string& command, const char* button) {
  say(command);
  if (panels::labelled_button(button)) state.copy(command);
}

void draw_next(const PickerState& state) {
  const std::filesystem::path& folder = state.game.folder();
  draw_heading("Next");
  draw_command(state, "neve render " + shell_path((folder / "picked.toml").string()),
               "Copy: render it");
  draw_command(state, "neve sweep " + shell_path((folder / "picked_sweep.toml").string()),
               "Copy: sweep around it");
}

void draw_files(const PickerState& state) {
  draw_heading("Files");
  const auto row = [&](const char* name, const char* meaning) {
    if (!state.download)
      say(name);
    else if (panels::labelled_button((std::string("Download ") + name).c_str()))
      state.download(state.game.folder() / name);
    say(meaning, colour::dim);
  };
  row("picked.toml", "the scene with these values, in its own resolution");
  row("picked_sweep.toml", "a sweep over the two axes that matter most");
  row("clicks.txt", "your answers; --clicks replays them to the bit");
  if (!state.download) draw_paragraph("in " + state.game.folder().string(), colour::dim);
}

}  // namespace

void draw_words(PickerState& state) {
  if (state.phase == Phase::stuck) draw_failure(state);
  if (state.layout.is_stacked) draw_axes(state);
  if (!state.noise.key.empty()) {
    draw_heading("Noise");
    draw_paragraph(state.noise.key);
  }
  draw_lesson(state);
  draw_hand(state);
}

void draw_result(PickerState& state) {
  const int rounds = state.game.answered();
  if (state.values.empty()) {
    draw_heading("Nothing was chosen");
    draw_paragraph("The same command continues from here, and so does Continue.");
    return;
  }
  draw_heading("Picked");
  draw_paragraph("after " + std::to_string(rounds) + (rounds == 1 ? " round" : " rounds"),
                 colour::dim);
  for (const scene::Override& value : state.values)
    draw_paragraph(value.address + " = " + value.value);
  draw_next(state);
  draw_files(state);
  draw_lesson(state);
}

}  // namespace neve::app::view::picker
