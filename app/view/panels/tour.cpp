/// A guided tour: ten steps, each with a ring around the widget that it is about.

#include <imgui.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "app/view/panels/labels.h"
#include "app/view/panels/viewer_state.h"

namespace neve::app::view::panels {

namespace {

struct Stop {
  const char* text;
  const char* label;                    ///< of the widget, as labels.h knows it
  const char* otherwise;                ///< the way to it where it is hidden
  std::optional<bool> is_right = {};    ///< column that it is in
  std::optional<std::size_t> tab = {};  ///< of the right column
};

constexpr std::array stops{
    Stop{"This is the snow. Drag to turn around it, use the wheel or two fingers to zoom.",
         "picture", "picture"},
    Stop{"Run simulates, and stops at the last frame. Space does the same. Try it, and pause.",
         "Run", "Pause"},
    Stop{"Frame, Step and Stage advance by one: a moment of the film, a time step, one stage of a "
         "step.",
         "Frame", "Frame"},
    Stop{"The bar below has every frame that was simulated. Drag it to go back; nothing is lost.",
         "time line", "Play"},
    Stop{"All numbers of the scene are in Parameters. Type what you look for: hardening, sticky, "
         "camera. "
         "Hover over a name for its meaning.",
         "find a parameter", "Parameters", false},
    Stop{
        "Numbers with a turning arrow wait for Reset, all others change the snow at once, while it "
        "runs.",
        "Reset", "Reset"},
    Stop{"Objects lists bodies and colliders. Select one, and drag its arrows in the picture.",
         "Objects", "Objects", false},
    Stop{
        "Views show the same snow as particles, as smoke, as a slice through the grid with arrows, "
        "or as snow in sunlight.",
        "view particles", "View", true, tab::view},
    Stop{"Inside a step: hover over a stage to read what it does, click it to see its result. "
         "Click a "
         "particle in the picture to read its numbers.",
         "Stages", "Inspect", true, tab::inspect},
    Stop{"Save pictures, the scene with your changes, or the command that makes it again.",
         "Save ...", "Save ..."}};

void go_to(ViewerState& state, int step) {
  state.tour_step = step < static_cast<int>(stops.size()) ? step : -1;
  if (state.tour_step < 0) return;
  const Stop& stop = stops[static_cast<std::size_t>(step)];
  if (!stop.is_right) return;
  (*stop.is_right ? state.panels.right : state.panels.left) = true;
  state.panels.prefers_right = *stop.is_right;
  if (stop.tab) state.go_to_tab = stop.tab;
}

void draw_ring(const Stop& stop) {
  const Labels& labels = Labels::of_panels();
  std::optional<LabelPlace> place = labels.find(stop.label);
  if (!place) place = labels.find(stop.otherwise);
  if (!place) return;
  const float margin = 0.25f * em();
  ImGui::GetForegroundDrawList()->AddRect(
      ImVec2(place->x - margin, place->y - margin),
      ImVec2(place->x + place->width + margin, place->y + place->height + margin),
      IM_COL32(255, 184, 60, 255), 0.3f * em(), 0, 0.15f * em());
}

}  // namespace

void start_tour(ViewerState& state) {
  state.is_help_open = false;
  go_to(state, 0);
}

void draw_tour(ViewerState& state) {
  if (state.tour_step < 0) return;
  const int step = state.tour_step, last = static_cast<int>(stops.size()) - 1;
  const Stop& stop = stops[static_cast<std::size_t>(step)];
  draw_ring(stop);
  const render::PicturePlace& p = state.viewport;
  const float width = std::min(30 * em(), 0.94f * static_cast<float>(p.width));
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(p.x) + 0.5f * static_cast<float>(p.width),
                                 static_cast<float>(p.y + p.height) - 0.8f * em()),
                          ImGuiCond_Always, ImVec2(0.5f, 1));
  ImGui::SetNextWindowSize(ImVec2(width, 0));
  if (ImGui::Begin("tour", nullptr,
                   ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                       ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings)) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(stop.text);
    ImGui::PopTextWrapPos();
    // Buttons stay at one place, so that a hand that stays there clicks through the tour.
    const auto button = [&](const char* label, int to, bool is_on = true) {
      ImGui::BeginDisabled(!is_on);
      if (ImGui::Button(label)) go_to(state, to);
      ImGui::EndDisabled();
      note_label(label);
      ImGui::SameLine();
    };
    button("Previous", step - 1, step > 0);
    button(step < last ? "Next" : "Done", step + 1);
    if (step < last) button("End the tour", last + 1);
    ImGui::TextDisabled("%d of %d", step + 1, last + 1);
  }
  ImGui::End();
}

}  // namespace neve::app::view::panels
