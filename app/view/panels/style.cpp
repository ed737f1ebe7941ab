#include "app/view/panels/style.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace neve::app::view::panels {

void style_panels(float scale) {
  ImGuiStyle style;
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 0;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  style.Colors[ImGuiCol_WindowBg] = ImVec4(0.085f, 0.095f, 0.12f, 1);
  style.Colors[ImGuiCol_FrameBg] = ImVec4(0.16f, 0.18f, 0.22f, 1);
  style.Colors[ImGuiCol_Button] = ImVec4(0.20f, 0.23f, 0.29f, 1);
  style.Colors[ImGuiCol_PlotHistogram] = ImVec4(0.24f, 0.45f, 0.70f, 1);
  style.Colors[ImGuiCol_SliderGrab] = ImVec4(0.24f, 0.45f, 0.70f, 1);
  style.Colors[ImGuiCol_SliderGrabActive] = ImVec4(0.45f, 0.68f, 0.95f, 1);
  style.Colors[ImGuiCol_Header] = ImVec4(0.18f, 0.27f, 0.38f, 1);
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
}

int font_size(float scale) {
  return std::clamp(static_cast<int>(std::lround(14 * scale)), 11, 48);
}

}  // namespace neve::app::view::panels
