#include "render/overlay/plots.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "render/overlay/overlay_text.h"
#include "render/overlay/text_layout.h"

namespace neve::render::overlay {
namespace {

ImU32 packed(Rgba color) {
  return IM_COL32(color[0], color[1], color[2], color[3]);
}

ImVec2 vector_of(Place place) {
  return {place.x, place.y};
}

}  // namespace

float ImGuiCanvas::text_width(const std::string& text) const {
  return overlay::text_width(font_, text);
}

std::string ImGuiCanvas::fitting(const std::string& text, float width) const {
  return elide(font_, text, width);
}

void ImGuiCanvas::text(Place at, Note::Anchor anchor, Rgba color, const std::string& text) {
  if (anchor != Note::Anchor::left)
    at.x -= (anchor == Note::Anchor::right ? 1.0f : 0.5f) * text_width(text);
  draw_text(font_, vector_of(at), packed(color), text, list_);
}

void ImGuiCanvas::rectangle(Place low, Place high, Rgba color) {
  list_.AddRectFilled(vector_of(low), vector_of(high), packed(color));
}

void ImGuiCanvas::curve(std::span<const Place> points, Rgba color, float width) {
  std::vector<ImVec2> line;
  for (const Place place : points) line.push_back(vector_of(place));
  list_.AddPolyline(line.data(), static_cast<int>(line.size()), packed(color), 0, width);
}

void ImGuiCanvas::circle(Place center, float radius, Rgba color, float line, const std::string&) {
  if (line > 0)
    list_.AddCircle(vector_of(center), radius, packed(color), 0, line);
  else
    list_.AddCircleFilled(vector_of(center), radius, packed(color), 16);
}

void ImGuiCanvas::clip(Place low, Place high) {
  list_.PushClipRect(vector_of(low), vector_of(high));
}

float draw_plots(const Frame& frame, const ImFont& font, float right_limit) {
  if (frame.plots.empty()) return 0;
  const float width = static_cast<float>(frame.width), height = static_cast<float>(frame.height);
  const float size = font.FontSize, unit = unit_of(font);
  const float title = 1.4f * size, gap = 0.6f * size, least = 1.9f * size;
  // The caption has the upper 36 %.
  const float bottom = std::round(height - 20 * unit - 1.5f * size), top = 0.37f * height;
  const int fitting = static_cast<int>((bottom - top) / (title + gap + least));
  const std::size_t count =
      std::min(frame.plots.size(), static_cast<std::size_t>(std::max(fitting, 0)));
  if (count == 0 || width < 20 * size) return 0;
  // An upright picture has its snow above them: they keep to a fifth of its height.
  const float highest =
      height > width ? std::max(title + gap + least, 0.2f * height / static_cast<float>(count))
                     : 9.5f * size;
  const float each = std::min((bottom - top) / static_cast<float>(count), highest);

  const float left = std::round(20 * unit + 3.2f * size);  // room for the numbers
  const float right = std::round(
      std::min(left + std::clamp(0.22f * width, 11 * size, 22 * size), right_limit - 0.5f * size));
  if (right - left < 8 * size) return 0;
  ImGuiCanvas canvas(font, *ImGui::GetBackgroundDrawList());
  for (std::size_t k = 0; k < count; ++k) {
    const float below = static_cast<float>(count - 1 - k) * each;
    const PlotPanel panel{left, right, std::round(bottom - below - (each - title - gap)),
                          std::round(bottom - below)};
    draw_plot(frame.plots[k], panel, {.has_x = k + 1 == count}, canvas);
  }
  return right;
}

}  // namespace neve::render::overlay
