#pragma once
/// Common parts of overlays: text with a shadow, its colours, and the unit of layout.

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace neve::render::overlay {

inline constexpr ImU32 bright_text = IM_COL32(240, 244, 250, 255);
inline constexpr ImU32 soft_text = IM_COL32(205, 213, 224, 255);
inline constexpr ImU32 text_shadow = IM_COL32(8, 10, 16, 150);

/// One unit of layout: a pixel at 720p.
inline float unit_of(const ImFont& font) {
  return font.FontSize / 16;
}

/// Draws text with a shadow, so that it reads on snow as well as on the background.
inline void draw_text(const ImFont& font, ImVec2 at, ImU32 color, const std::string& text,
                      ImDrawList& list = *ImGui::GetBackgroundDrawList()) {
  const float offset = std::max(1.0f, std::round(unit_of(font)));
  at = ImVec2(std::round(at.x), std::round(at.y));
  const char* end = text.c_str() + text.size();
  list.AddText(&font, font.FontSize, ImVec2(at.x + offset, at.y + offset), text_shadow,
               text.c_str(), end);
  list.AddText(&font, font.FontSize, at, color, text.c_str(), end);
}

}  // namespace neve::render::overlay
