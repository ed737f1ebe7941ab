/// The columns beside the picture, and questions above it.

#include <imgui_internal.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

#include "app/view/panels/beside.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/viewer_state.h"

namespace neve::app::view::panels {

namespace {

template <class Draw>
void add_tab(const char* name, Draw draw, ImGuiTabItemFlags flags = 0,
             const char* label = nullptr) {
  const bool is_open = ImGui::BeginTabItem(name, nullptr, flags);
  note_label(label ? label : name);
  if (!is_open) return;
  ImGui::BeginChild("content");
  draw();
  ImGui::EndChild();
  ImGui::EndTabItem();
}

}  // namespace

void draw_panel_switch(ViewerState& state) {
  const PanelSwitches& panels = state.panels;
  if (!panels.is_narrow || panels.left || panels.right) return;
  // The caption begins at the left.
  ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x, 0), ImGuiCond_Always, ImVec2(1, 0));
  if (ImGui::Begin("panels", nullptr,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar |
                       ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                       ImGuiWindowFlags_NoBackground)) {
    if (labelled_button("Panels")) state.panels.left = state.panels.right = true;
  }
  ImGui::End();
}

PanelPlace column_beside(ViewerState& state) {
  if (!state.panels.left && !state.panels.right) state.panels.left = state.panels.right = true;
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  const auto x = static_cast<float>(state.viewport.x), y = static_cast<float>(state.viewport.y),
             right = x + static_cast<float>(state.viewport.width),
             below = y + static_cast<float>(state.viewport.height) + 2.6f * em();
  if (state.panels.is_stacked) return {ImVec2(0, below), ImVec2(all.x, all.y - below)};
  if (right < all.x) return {ImVec2(right, y), ImVec2(all.x - right, all.y - y)};
  return {ImVec2(0, y), ImVec2(std::max(x, 1.0f), all.y - y)};
}

std::vector<frontend::ScrollPlace> scroll_places() {
  std::vector<frontend::ScrollPlace> places;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
    if (!window->WasActive || window->Hidden || window->ScrollMax.y <= 0) continue;
    const ImRect& place = window->InnerRect;
    // ImGui moves a window by this much for a notch of the wheel.
    const float notch = std::min(5 * window->CalcFontSize(), 0.67f * place.GetHeight());
    places.push_back({place.Min.x, place.Min.y, place.GetWidth(), place.GetHeight(), notch});
  }
  return places;
}

void draw_left_column(ViewerState& state) {
  if (!ImGui::BeginTabBar("left")) return;
  add_tab(
      "Parameters", [&] { draw_parameters(state); },
      std::exchange(state.go_to_parameters, false) ? ImGuiTabItemFlags_SetSelected : 0);
  add_tab("Objects", [&] { draw_objects(state); });
  const std::size_t count = state.bench.document().edits().size();
  const std::string changed =
      count > 0 ? "Changed (" + std::to_string(count) + ")###Changed" : "Changed###Changed";
  add_tab(
      changed.c_str(), [&] { draw_changes(state); }, 0, "Changed");
  ImGui::EndTabBar();
}

void draw_right_column(ViewerState& state) {
  // Names of tabs are scrolled where they have no room, not cut.
  if (!ImGui::BeginTabBar("right", ImGuiTabBarFlags_FittingPolicyScroll)) return;
  const auto flags = [&](std::size_t tab) {
    return state.go_to_tab == tab ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None;
  };
  const std::optional<std::size_t> wanted = state.go_to_tab;
  add_tab(
      "View", [&] { draw_view_panel(state); }, flags(tab::view));
  add_tab(
      "Inspect", [&] { draw_inspector(state); }, flags(tab::inspect));
  add_tab(
      "Plots", [&] { draw_plots_panel(state); }, flags(tab::plots));
  add_tab(
      "Messages", [&] { draw_messages(state); }, flags(tab::messages));
  if (wanted == state.go_to_tab) state.go_to_tab.reset();
  ImGui::EndTabBar();
}

void draw_offer(ViewerState& state) {
  if (!state.is_reload_offered) return;
  const render::PicturePlace& p = state.viewport;
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(p.x) + 0.5f * static_cast<float>(p.width),
                                 static_cast<float>(p.y) + em()),
                          ImGuiCond_Always, ImVec2(0.5f, 0));
  if (ImGui::Begin("offer", nullptr,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar |
                       ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    ImGui::PushTextWrapPos(std::min(30 * em(), static_cast<float>(p.width)));
    ImGui::TextUnformatted((state.bench.document().file() + " was changed on disk.").c_str());
    const std::string error = state.bench.reload_error();
    if (!error.empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.42f, 0.32f, 1));
      ImGui::TextUnformatted(error.c_str());
      ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
    const bool is_reload = labelled_button("Reload and restart");
    ImGui::SameLine();
    const bool is_kept = labelled_button("Keep the current scene");
    if (is_reload) state.bench.reload();
    if (is_kept) state.bench.keep_file();
    if (is_reload || is_kept) state.is_reload_offered = state.bench.has_file_changed();
  }
  ImGui::End();
}

}  // namespace neve::app::view::panels
