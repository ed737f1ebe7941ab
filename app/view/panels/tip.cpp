#include "app/view/panels/tip.h"

#include <algorithm>

namespace neve::app::view::panels {

namespace {

constexpr float rest_before_tip = 0.4f;  // s
constexpr float tip_gap = 3;             // px between widget and tip
/// ImGui hides a new window in its first frame, to learn its size.
constexpr int frames_to_appear = 3;

/// The widget on which the mouse rests. There is one mouse, as there is one current ImGui context.
struct Rest {
  ImVec2 widget{-1, -1};
  int frame = -1;
  float seconds = 0;
  int shown = 0;  ///< frames that had its tip
};
Rest rest;

float wrap_width() {
  return 26 * ImGui::GetFontSize();
}

ImVec2 size_of_tip(const std::vector<TipLine>& lines) {
  const ImGuiStyle& style = ImGui::GetStyle();
  ImVec2 size(0, -style.ItemSpacing.y);
  for (const TipLine& line : lines) {
    const ImVec2 text = ImGui::CalcTextSize(line.text.c_str(), nullptr, false, wrap_width());
    size.x = std::max(size.x, text.x);
    size.y += text.y + style.ItemSpacing.y;
  }
  return {size.x + 2 * style.WindowPadding.x, size.y + 2 * style.WindowPadding.y};
}

}  // namespace

bool wants_tip() {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return false;
  const ImVec2 widget = ImGui::GetItemRectMin();
  const int frame = ImGui::GetFrameCount();
  const bool is_same = widget.x == rest.widget.x && widget.y == rest.widget.y &&
                       (frame == rest.frame || frame == rest.frame + 1) && !ImGui::IsAnyMouseDown();
  const bool is_next = is_same && frame != rest.frame;
  rest = {widget, frame, is_same ? rest.seconds + ImGui::GetIO().DeltaTime : 0,
          is_same ? rest.shown : 0};
  const bool is_due = rest.seconds >= rest_before_tip;
  if (is_due && is_next) ++rest.shown;
  return is_due;
}

bool is_tip_coming() {
  const bool is_on_its_way = rest.seconds < rest_before_tip || rest.shown < frames_to_appear;
  return rest.frame == ImGui::GetFrameCount() && is_on_its_way && !ImGui::IsAnyMouseDown();
}

ImVec2 tip_place(ImVec2 from, ImVec2 to, ImVec2 size, ImVec2 screen) {
  const float below = to.y + tip_gap, above = from.y - tip_gap - size.y;
  const bool has_room = below + size.y <= screen.y || above < 0;
  return {std::max(0.0f, std::min(from.x, screen.x - size.x)), has_room ? below : above};
}

void show_tip(const std::vector<TipLine>& lines) {
  // A window that finds its size itself has it a frame later, and a paused view draws no other.
  const ImVec2 size = size_of_tip(lines);
  ImGui::SetNextWindowSize(size);
  ImGui::SetNextWindowPos(tip_place(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), size,
                                    ImGui::GetIO().DisplaySize));
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(wrap_width());
  for (const TipLine& line : lines) {
    if (line.is_dim)
      ImGui::TextDisabled("%s", line.text.c_str());
    else
      ImGui::TextUnformatted(line.text.c_str());
  }
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void tip(const char* text) {
  if (wants_tip()) show_tip({{text}});
}

}  // namespace neve::app::view::panels
