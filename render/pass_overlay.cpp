#include "render/pass_overlay.h"

#include <algorithm>
#include <cmath>

#include "render/colormap.h"
#include "render/overlay_text.h"
#include "render/plots.h"
#include "render/text_layout.h"
#include "render/ticks.h"

namespace neve::render {
namespace {

constexpr ImU32 mark_color = IM_COL32(255, 122, 40, 255);

/// Height of text: 16 pixels at 1280x720, in proportion elsewhere, but never too small to read.
int font_size_for(int width, int height) {
  const float scale = std::min(static_cast<float>(height) / 720, static_cast<float>(width) / 1120);
  return std::clamp(static_cast<int>(std::lround(16 * scale)), 10, 160);
}

std::string title_of(const Legend& legend) {
  return legend.unit.empty() ? legend.title : legend.title + " (" + legend.unit + ")";
}

std::vector<std::string> all_texts(const Frame& frame) {
  std::vector<std::string> texts = frame.caption;
  for (const Legend& legend : frame.legends) texts.push_back(title_of(legend));
  for (const Label& label : frame.labels) texts.push_back(label.text);
  for (const Note& note : frame.notes) texts.push_back(note.text);
  for (const Plot& plot : frame.plots) {
    texts.push_back(plot.title + plot.unit);
    for (const PlotSeries& series : plot.series) texts.push_back(series.name);
  }
  return texts;
}

/// A colour bar standing on `bottom`, its text ending at `right`.
/// @return its left edge
float draw_legend(const Legend& legend, const ImFont& font, float right, float bottom, float height,
                  float max_width) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float unit = unit_of(font);
  const int tick_count = std::clamp(static_cast<int>(height / (1.6f * font.FontSize)), 1, 5);
  const std::vector<Tick> ticks = nice_ticks(legend.min, legend.max, tick_count);
  float label_width = 0;
  for (const Tick& tick : ticks) label_width = std::max(label_width, text_width(font, tick.label));

  const float bar_width = std::max(6.0f, std::round(14 * unit)), gap = std::round(7 * unit);
  const std::string title = elide(font, title_of(legend), max_width);
  const float width = std::max(text_width(font, title), bar_width + gap + label_width);
  const float left = std::round(right - width), top = std::round(bottom - height);
  draw_text(font, ImVec2(left, top - 1.7f * font.FontSize), bright_text, title);

  for (float y = top; y < bottom; y += 1) {
    const Rgb8 c = map_color(legend.colormap, (bottom - y - 0.5f) / (bottom - top));
    list.AddRectFilled(ImVec2(left, y), ImVec2(left + bar_width, y + 1),
                       IM_COL32(c.r, c.g, c.b, 255));
  }
  list.AddRect(ImVec2(left, top), ImVec2(left + bar_width, bottom), IM_COL32(0, 0, 0, 110));
  const double range = static_cast<double>(legend.max) - static_cast<double>(legend.min);
  for (const Tick& tick : ticks) {
    const double part =
        ticks.size() == 1 ? 0.5 : (tick.value - static_cast<double>(legend.min)) / range;
    const float y = bottom - static_cast<float>(part) * (bottom - top);
    list.AddLine(ImVec2(left + bar_width, y), ImVec2(left + bar_width + 0.6f * gap, y), soft_text,
                 std::max(1.0f, unit));
    draw_text(font, ImVec2(left + bar_width + gap, y - 0.5f * font.FontSize), soft_text,
              tick.label);
  }
  return left;
}

}  // namespace

float OverlayPass::draw_legends(const Frame& frame) const {
  const ImFont& font = *imgui_.text_font();
  const float unit = unit_of(font);
  const float width = static_cast<float>(frame.width), height = static_cast<float>(frame.height);
  const float margin = std::round(24 * unit);
  float right = width - margin;
  // A picture too small for a bar, its title and two ticks gets none.
  if (height < 7 * font.FontSize || width < 12 * font.FontSize) return right;
  const float bar_height = std::round(std::min(210 * unit, 0.5f * height));
  for (const Legend& legend : frame.legends) {
    if (right < 0.4f * width) break;
    const float left = draw_legend(legend, font, right, height - margin, bar_height, 0.35f * width);
    right = left - margin;
  }
  return right;
}

void OverlayPass::draw_caption(const Frame& frame, float right_limit) const {
  const float unit = unit_of(*imgui_.text_font());
  const float height = static_cast<float>(frame.height);
  const float margin = std::round(20 * unit);
  const bool has_strip = frame.caption_height > 0;
  const float width = has_strip
                          ? static_cast<float>(frame.width) - 2 * margin
                          : std::min(right_limit, 0.66f * static_cast<float>(frame.width)) - margin;
  // The snow is in the middle: text keeps to the upper third.
  const float bottom = has_strip ? static_cast<float>(frame.caption_height) : 0.36f * height;
  float y = std::round((has_strip ? 10 : 16) * unit);
  for (std::size_t i = 0; i < frame.caption.size(); ++i) {
    const ImFont& font = i == 0 ? *imgui_.title_font() : *imgui_.text_font();
    const float line_height = std::round(1.25f * font.FontSize);
    const int room = static_cast<int>((bottom - y) / line_height);
    const int max_lines = i == 0 ? (room >= 6 ? 2 : 1) : std::max(room, 0);
    for (const std::string& line :
         wrap(font, frame.caption[i], width, static_cast<std::size_t>(max_lines))) {
      draw_text(font, ImVec2(margin, y), i == 0 ? bright_text : soft_text, line);
      y += line_height;
    }
    if (i == 0) y += std::round(3 * unit);
  }
}

void OverlayPass::draw_labels(const Frame& frame, const View& view) const {
  const ImFont& font = *imgui_.text_font();
  const float unit = unit_of(font), margin = 6 * unit;
  for (const Label& label : frame.labels) {
    const Vec3f p = view.project(label.position);
    if (!(p.z > 0)) continue;
    const float height = static_cast<float>(view.height), width = static_cast<float>(view.width);
    const std::string text = elide(font, label.text, width - 2 * margin);
    const float text_size = text_width(font, text);
    // Above its place, and kept on the picture as long as the place itself is.
    if (p.x < 0 || p.x > width || p.y < 0 || p.y > height) continue;
    const float wanted = label.ends_here ? p.x - text_size : p.x;
    const float left = std::clamp(wanted, margin, std::max(margin, width - text_size - margin));
    const float top = std::max(margin, height - p.y - 1.35f * font.FontSize);
    draw_text(font, ImVec2(left, top), soft_text, text);
  }
}

void OverlayPass::draw_notes(const Frame& frame) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (const Patch& patch : frame.patches)
    list.AddRectFilled(ImVec2(patch.x, patch.y),
                       ImVec2(patch.x + patch.width, patch.y + patch.height),
                       IM_COL32(patch.color[0], patch.color[1], patch.color[2], patch.color[3]));
  for (const Note& note : frame.notes) {
    const ImFont& font = note.is_title ? *imgui_.title_font() : *imgui_.text_font();
    const std::string text = note.room > 0 ? elide(font, note.text, note.room) : note.text;
    const float width = text_width(font, text);
    const float shift = note.anchor == Note::Anchor::left     ? 0
                        : note.anchor == Note::Anchor::middle ? 0.5f * width
                                                              : width;
    draw_text(font, ImVec2(note.x - shift, note.y),
              IM_COL32(note.color[0], note.color[1], note.color[2], 255), text);
  }
}

void OverlayPass::draw_marks(const Frame& frame, const View& view) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float unit = unit_of(*imgui_.text_font());
  for (const Vec3f& mark : frame.marks) {
    const Vec3f p = view.project(mark);
    if (!(p.z > 0)) continue;
    const ImVec2 center(p.x, static_cast<float>(view.height) - p.y);
    const float on_picture = frame.points.radius * view.pixels_per_slope / p.z;
    const float radius = std::clamp(2 * on_picture, 8 * unit, 40 * unit);
    const float d = 0.7071f;
    const ImVec2 start(center.x + d * radius, center.y - d * radius);
    const ImVec2 end(center.x + d * (radius + 22 * unit), center.y - d * (radius + 22 * unit));
    for (const auto& [color, width] : {std::pair{text_shadow, 4.0f}, std::pair{mark_color, 2.0f}}) {
      list.AddCircle(center, radius, color, 32, width * unit);
      list.AddLine(start, end, color, width * unit);
    }
  }
}

void OverlayPass::draw(const Frame& frame, const View& view) {
  if (frame.caption.empty() && frame.legends.empty() && frame.marks.empty() &&
      frame.labels.empty() && frame.plots.empty() && frame.patches.empty() && frame.notes.empty())
    return;
  const int font_size =
      frame.font_size > 0 ? frame.font_size : font_size_for(frame.width, frame.height);
  imgui_.begin(frame.width, frame.height, font_size, all_texts(frame));
  draw_labels(frame, view);
  draw_marks(frame, view);
  draw_caption(frame, draw_legends(frame));
  draw_plots(frame, *imgui_.text_font());
  draw_notes(frame);
  imgui_.end();
}

}  // namespace neve::render
