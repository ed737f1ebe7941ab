/// The line above the tiles: the round, what happens, and the answers that are no tile.

#include <imgui.h>

#include <algorithm>
#include <array>
#include <string>

#include "app/view/panels/labels.h"
#include "app/view/panels/tip.h"
#include "app/view/picker/colours.h"
#include "app/view/picker/picker_state.h"

namespace neve::app::view::picker {

namespace {

struct Answer {
  const char* name;        ///< "": nothing is here now
  const char* short_name;  ///< where there is little room
  const char* help;
  bool is_on;  ///< can be given now
  bool is_lit;
  Wish::Kind wish;  ///< nothing: it only changes what the next click means
};

/// "Take back" has one place, and where "Stop and write the pick" was nothing comes under the hand
/// that has just clicked it.
std::vector<Answer> answers_of(const PickerState& state) {
  if (state.phase == Phase::over)
    return {{"Done", "Done", "Ends neve (Q); all files stay", true, true, Wish::Kind::done},
            {"Continue", "Continue", "More rounds of the same search", !state.game.is_over(), false,
             Wish::Kind::more_rounds},
            {"Take back", "Take back", "Takes the last answer back (U)", state.can_undo(), false,
             Wish::Kind::undo},
            {"", "", "", false, false, Wish::Kind::nothing}};
  if (state.phase == Phase::stuck)
    return {
        {"Try again", "Try again", "Does the same again", true, true, Wish::Kind::try_again},
        {"Stop", "Stop", "Ends neve; the same command continues", true, false, Wish::Kind::stop}};
  const bool is_asking = state.phase == Phase::asking;
  return {{"Two are equal", "Two are equal", "The next two clicks are one answer (T, or shift)",
           is_asking, state.takes_two || state.first.has_value(), Wish::Kind::nothing},
          {"None of them", "None of them", "Nine others (0)", is_asking, false, Wish::Kind::choose},
          {"Take back", "Take back", "Takes the last answer back (U)", state.can_undo(), false,
           Wish::Kind::undo},
          {"Stop and write the pick", "Stop here", "Writes the scene that was found so far (Q)",
           !state.is_stopping, false, Wish::Kind::stop}};
}

void give(PickerState& state, const Answer& answer) {
  state.note.clear();
  if (answer.wish != Wish::Kind::nothing) {
    state.wish = {answer.wish, {}};
    state.first.reset();
    return;
  }
  state.takes_two = !(state.takes_two || state.first);
  state.first.reset();
}

void draw_answer(PickerState& state, const Answer& answer, const char* name, ImVec2 size) {
  if (*name == '\0') return ImGui::Dummy(size);
  if (!answer.is_on) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.4f);
  if (answer.is_lit) ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.24f, 0.45f, 0.70f, 1));
  const bool is_pressed = ImGui::Button(name, size);
  panels::note_label(answer.name);
  if (answer.is_lit) ImGui::PopStyleColor();
  if (!answer.is_on) ImGui::PopStyleVar();
  panels::tip(answer.help);
  if (is_pressed && answer.is_on) give(state, answer);
}

std::string title_of(const PickerState& state) {
  if (state.phase == Phase::over) return "The pick";
  const int round = std::min(state.game.answered() + 1, state.game.max_rounds());
  return "Round " + std::to_string(round) + " of " + std::to_string(state.game.max_rounds());
}

std::string status_of(const PickerState& state) {
  if (state.is_stopping) return "Ending the runs ...";
  if (!state.note.empty()) return state.note;
  switch (state.phase) {
    case Phase::making:
      return "Making nine tiles: " + std::to_string(state.done()) + " of 9 are done";
    case Phase::asking:
      if (state.first)
        return "Tile " + std::to_string(*state.first + 1) + " and ...? Choose the other one";
      return state.takes_two ? "Choose the two that are equally good"
                             : "Choose the tile that comes nearest to the snow you want";
    case Phase::stuck:
      return "This round could not be made";
    case Phase::over:
      return state.values.empty() ? "Nothing was chosen yet" : "Scene and sweep are written";
  }
  return {};
}

void draw_buttons_of_phone(PickerState& state) {
  const std::vector<Answer> answers = answers_of(state);
  const float gap = 0.5f * em();
  const float width = 0.5f * (state.layout.buttons.width - 3 * gap), height = 2.7f * em();
  for (std::size_t k = 0; k < answers.size(); ++k) {
    ImGui::SetCursorPos(ImVec2(gap + static_cast<float>(k % 2) * (width + gap),
                               0.2f * em() + static_cast<float>(k / 2) * (height + 0.4f * em())));
    draw_answer(state, answers[k], answers[k].short_name, ImVec2(width, height));
  }
}

/// The widest word that each place of the bar ever has: no answer moves when the words change.
constexpr std::array slots{"Two are equal", "None of them", "Take back", "Stop and write the pick"};

float width_of_slot(std::size_t k) {
  return ImGui::CalcTextSize(slots[k]).x + 2 * ImGui::GetStyle().FramePadding.x;
}

float width_of(const std::vector<Answer>& answers) {
  float width = 0;
  for (std::size_t k = 0; k < answers.size(); ++k)
    width += width_of_slot(k) + ImGui::GetStyle().ItemSpacing.x;
  return width;
}

void draw_text(const std::string& text, const char* label, ImU32 color) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  if (label) panels::note_label(label);
}

}  // namespace

void draw_bar(PickerState& state) {
  const Layout& layout = state.layout;
  const ImU32 status_color = state.note.empty() ? colour::dim : colour::wrong;
  // Scripts wait for the round by the name of its title.
  const std::string title = title_of(state);
  const std::string label = state.phase == Phase::making  ? "making " + title
                            : state.phase == Phase::stuck ? "stuck at " + title
                                                          : title;
  if (layout.is_stacked) {
    ImGui::SetCursorPos(ImVec2(0.6f * em(), 0.4f * em()));
    draw_text(title, label.c_str(), colour::text);
    ImGui::SetCursorPosX(0.6f * em());
    ImGui::PushTextWrapPos(layout.bar.width - 0.6f * em());
    draw_text(status_of(state), "status", status_color);
    ImGui::PopTextWrapPos();
    return;
  }
  const std::vector<Answer> answers = answers_of(state);
  const float left = layout.bar.width - width_of(answers) - 0.2f * em(), row = 0.55f * em();
  ImGui::SetCursorPos(ImVec2(0.8f * em(), row + ImGui::GetStyle().FramePadding.y));
  draw_text(title, label.c_str(), colour::text);
  ImGui::SameLine(0, 1.2f * em());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushClipRect(at, ImVec2(left - em(), at.y + 1.5f * em()), true);
  draw_text(status_of(state), "status", status_color);
  ImGui::PopClipRect();
  ImGui::SetCursorPos(ImVec2(left, row));
  for (std::size_t k = 0; k < answers.size(); ++k) {
    draw_answer(state, answers[k], answers[k].name, ImVec2(width_of_slot(k), 0));
    ImGui::SameLine();
  }
}

void draw_buttons(PickerState& state) {
  if (state.layout.is_stacked) draw_buttons_of_phone(state);
}

}  // namespace neve::app::view::picker
