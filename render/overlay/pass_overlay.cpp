#include "render/overlay/pass_overlay.h"

#include <algorithm>
#include <cmath>

#include "render/frame/colormap.h"
#include "render/frame/range.h"
#include "render/overlay/overlay_text.h"
#include "render/overlay/plots.h"
#include "render/overlay/text_layout.h"

namespace neve::render::overlay {
namespace {

/// Text keeps to this part of the picture from its top, since the snow is in the middle.
constexpr float caption_share = 0.36f;
constexpr ImU32 mark_color = IM_COL32(255, 122, 40, 255);
constexpr ImU32 label_plate = IM_COL32(18, 21, 26, 150);
constexpr ImU32 caption_plate = IM_COL32(18, 21, 26, 190);

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
  texts.push_back(frame.footnote);
  if (frame.scale_bar) texts.push_back(frame.scale_bar->text);
  for (const Legend& legend : frame.legends) texts.push_back(title_of(legend));
  for (const Label& label : frame.labels) texts.push_back(label.text);
  for (const Note& note : frame.notes) texts.push_back(note.text);
  for (const std::string& words : frame.edge_words) texts.push_back(words);
  for (const Plot& plot : frame.plots) {
    texts.push_back(plot.title + plot.unit);
    for (const PlotSeries& series : plot.series) texts.push_back(series.name);
  }
  return texts;
}

bool has_upper_words(const Frame& frame) {
  return !(frame.edge_words[0] + frame.edge_words[1] + frame.edge_words[2]).empty();
}

struct LegendText {
  std::vector<std::string> title;  ///< lines
  std::vector<Tick> ticks;
  float title_width = 0, bar_width = 0;  ///< pixels; that of the bar with its numbers
};

float bar_width(const ImFont& font) {
  return std::max(6.0f, std::round(14 * unit_of(font)));
}

float tick_gap(const ImFont& font) {
  return std::round(7 * unit_of(font));
}

LegendText text_of(const Legend& legend, const ImFont& font, float height, float max_width) {
  const int tick_count = std::clamp(static_cast<int>(height / (1.6f * font.FontSize)), 1, 5);
  LegendText text{wrap(font, title_of(legend), max_width, 2),
                  nice_ticks(legend.min, legend.max, tick_count)};
  for (const std::string& line : text.title)
    text.title_width = std::max(text.title_width, text_width(font, line));
  float label_width = 0;
  for (const Tick& tick : text.ticks)
    label_width = std::max(label_width, text_width(font, tick.label));
  text.bar_width = bar_width(font) + tick_gap(font) + label_width;
  return text;
}

struct LegendPlace {
  float left, bottom, height;  ///< of the bar, pixels
  float title_left;
};

Rgb8 legend_color(const Legend& legend, float part) {
  if (legend.colors.empty()) return map_color(legend.colormap, part);
  const auto last = static_cast<float>(legend.colors.size() - 1);
  const auto& c =
      legend.colors[static_cast<std::size_t>(std::lround(std::clamp(part, 0.0f, 1.0f) * last))];
  return {c[0], c[1], c[2]};
}

/// A point beyond an end of the bar, in the colour that values beyond it have.
void draw_tip(const Legend& legend, float part, ImVec2 left_end, float width, float height) {
  const Rgb8 c = legend_color(legend, part);
  const ImVec2 right_end(left_end.x + width, left_end.y),
      point(left_end.x + 0.5f * width, left_end.y + height);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddTriangleFilled(left_end, right_end, point, IM_COL32(c.r, c.g, c.b, 255));
  list.AddTriangle(left_end, right_end, point, IM_COL32(0, 0, 0, 110));
}

/// A colour bar with its title above and its numbers to the right.
void draw_legend(const Legend& legend, const LegendText& text, const ImFont& font,
                 const LegendPlace& place) {
  const auto [left, bottom, height, title_left] = place;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float unit = unit_of(font), gap = tick_gap(font), right = left + bar_width(font);
  const float top = std::round(bottom - height);
  float y_title = top - (0.6f + 1.1f * static_cast<float>(text.title.size())) * font.FontSize;
  for (const std::string& line : text.title) {
    draw_text(font, ImVec2(title_left, y_title), bright_text, line);
    y_title += 1.1f * font.FontSize;
  }
  for (float y = top; y < bottom; y += 1) {
    const Rgb8 c = legend_color(legend, (bottom - y - 0.5f) / (bottom - top));
    list.AddRectFilled(ImVec2(left, y), ImVec2(right, y + 1), IM_COL32(c.r, c.g, c.b, 255));
  }
  list.AddRect(ImVec2(left, top), ImVec2(right, bottom), IM_COL32(0, 0, 0, 110));
  const float tip = std::round(0.5f * font.FontSize);
  if (legend.has_higher_values) draw_tip(legend, 1, ImVec2(left, top), right - left, -tip);
  if (legend.has_lower_values) draw_tip(legend, 0, ImVec2(left, bottom), right - left, tip);
  const auto min = static_cast<double>(legend.min), max = static_cast<double>(legend.max);
  for (const Tick& tick : text.ticks) {
    const double part = has_width(min, max) ? (tick.value - min) / (max - min) : 0.5;
    const float y = bottom - static_cast<float>(part) * (bottom - top);
    list.AddLine(ImVec2(right, y), ImVec2(right + 0.6f * gap, y), soft_text, std::max(1.0f, unit));
    draw_text(font, ImVec2(right + gap, y - 0.5f * font.FontSize), soft_text, tick.label);
  }
}

}  // namespace

OverlayPass::Limits OverlayPass::draw_legends(const Frame& frame) const {
  const ImFont& font = *imgui_.text_font();
  const float unit = unit_of(font), size = font.FontSize;
  const float width = static_cast<float>(frame.width), height = static_cast<float>(frame.height);
  const float margin = std::round(24 * unit), right = width - margin;
  // A picture too small for a bar, its title and two ticks gets none.
  if (frame.legends.empty() || height < 7 * size || width < 12 * size)
    return {right, right, height};
  // One above the other: side by side they would reach into the snow. Those without room are left
  // out.
  const float least = 4 * size, room = 0.5f * height;
  const auto count = std::min(frame.legends.size(),
                              static_cast<std::size_t>(std::max(1.0f, std::floor(room / least))));
  const float bar_height = std::round(std::min(210 * unit, room / static_cast<float>(count)));
  std::vector<LegendText> texts;
  float title_width = 0, bars = 0;
  std::size_t lines = 1;
  for (std::size_t k = 0; k < count; ++k) {
    const float room_beside = frame.legend_width > 0 ? frame.legend_width : 0.35f * width;
    texts.push_back(text_of(frame.legends[k], font, bar_height, room_beside));
    title_width = std::max(title_width, texts.back().title_width);
    bars = std::max(bars, texts.back().bar_width);
    lines = std::max(lines, texts.back().title.size());
  }
  const float above = (1.6f + 1.1f * static_cast<float>(lines)) * size;
  const float title_left = std::round(right - std::max(title_width, bars));
  // The bar would stand in the snow below a long title in a small picture.
  const bool is_narrow = title_width > 0.25f * width;
  const float left = is_narrow ? std::round(right - bars) : title_left;
  for (std::size_t k = 0; k < count; ++k) {
    const float below = static_cast<float>(count - 1 - k) * (bar_height + above);
    draw_legend(frame.legends[k], texts[k], font,
                {left, std::round(height - margin - below), bar_height,
                 is_narrow ? std::round(right - texts[k].title_width) : title_left});
  }
  // The caption is beside the title where that reaches into the upper third.
  const float top = height - margin - static_cast<float>(count) * (bar_height + above);
  const float beside = top < caption_share * height ? std::min(left, title_left) : left;
  return {beside - margin, left - margin, top - 0.3f * size};
}

void OverlayPass::draw_footnote(const Frame& frame, float left, float right) const {
  const ImFont& font = *imgui_.text_font();
  const float margin = std::round(20 * unit_of(font)), line = 1.25f * font.FontSize;
  const float from = left > 0 ? left + 1.5f * margin : margin;
  const float bottom = static_cast<float>(frame.height) - margin;
  if (frame.footnote.empty()) {
    if (frame.scale_bar) draw_scale_bar(*frame.scale_bar, from, right, bottom);
    return;
  }
  // The snow is in the middle: no higher than a fifth of the picture.
  const float room = 0.18f * static_cast<float>(frame.height);
  const auto most = static_cast<std::size_t>(std::min(2.0f, std::floor(room / line)));
  if (right - from < 8 * font.FontSize || most == 0) return;
  const std::vector<std::string> lines = wrap(font, frame.footnote, right - from, most);
  const float top = bottom - line * static_cast<float>(lines.size());
  if (frame.scale_bar) draw_scale_bar(*frame.scale_bar, from, right, top - 0.5f * font.FontSize);
  for (std::size_t k = 0; k < lines.size(); ++k)
    draw_text(font, ImVec2(from, top + line * static_cast<float>(k)), soft_text, lines[k]);
}

void OverlayPass::draw_scale_bar(const ScaleBar& bar, float left, float right, float bottom) const {
  const ImFont& font = *imgui_.text_font();
  const float unit = std::max(1.0f, unit_of(font)), gap = 0.5f * font.FontSize;
  const float text = text_width(font, bar.text);
  // The text stands above the bar, since both side by side would not fit in a small tile.
  if (!(bar.pixels > 0) || left + std::max(bar.pixels, text) > right) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float x = std::round(left), y = std::round(bottom) - 2 * unit, end = x + bar.pixels;
  for (const auto& [color, rim] :
       {std::pair{text_shadow, 1.5f * unit}, std::pair{bright_text, 0.0f}}) {
    list.AddRectFilled(ImVec2(x - rim, y - unit - rim), ImVec2(end + rim, y + unit + rim), color);
    for (const float at : {x, end - 2 * unit})
      list.AddRectFilled(ImVec2(at - rim, y - 4 * unit - rim),
                         ImVec2(at + 2 * unit + rim, y + unit + rim), color);
  }
  draw_text(font,
            ImVec2(x + 0.5f * (bar.pixels - text) > x ? x + 0.5f * (bar.pixels - text) : x,
                   y - gap - font.FontSize),
            soft_text, bar.text);
}

void OverlayPass::draw_caption(const Frame& frame, const Limits& limits) const {
  const float unit = unit_of(*imgui_.text_font());
  const float height = static_cast<float>(frame.height);
  const float margin = std::round(20 * unit);
  const bool has_strip = frame.caption_height > 0;
  if (!has_strip && height < 4 * imgui_.text_font()->FontSize) return;  // it would be all text
  const float whole = static_cast<float>(frame.width) - 2 * margin;
  const float above = has_strip ? whole : 0.66f * static_cast<float>(frame.width) - margin;
  const float beside = std::min(above, limits.caption - margin);
  const float bottom =
      has_strip ? static_cast<float>(frame.caption_height) : caption_share * height;
  float y = std::round((has_strip ? 10 : has_upper_words(frame) ? 25 : 16) * unit);
  for (std::size_t i = 0; i < frame.caption.size(); ++i) {
    const ImFont& font = i == 0 ? *imgui_.title_font() : *imgui_.text_font();
    const float line_height = std::round(1.25f * font.FontSize);
    const int room = static_cast<int>((bottom - y) / line_height);
    const int max_lines = i == 0 ? (room >= 6 ? 2 : 1) : std::max(room, 0);
    // Only a line that reaches down to the legend has to keep beside it.
    const float one_line = y + line_height;
    const bool is_above =
        has_strip || (one_line <= limits.legend_top && text_width(font, frame.caption[i]) <= above);
    const float width = is_above ? above : beside;
    for (const std::string& line :
         wrap(font, frame.caption[i], width, static_cast<std::size_t>(max_lines))) {
      if (frame.has_caption_plate)
        ImGui::GetBackgroundDrawList()->AddRectFilled(
            ImVec2(margin - 6 * unit, y - 2 * unit),
            ImVec2(margin + text_width(font, line) + 6 * unit, y + line_height - 2 * unit),
            caption_plate);
      draw_text(font, ImVec2(margin, y), i == 0 ? bright_text : soft_text, line);
      y += line_height;
    }
    if (i == 0) y += std::round(3 * unit);
  }
}

void OverlayPass::draw_labels(const Frame& frame, const View& view, const Limits& limits) const {
  const ImFont& font = *imgui_.text_font();
  const float unit = unit_of(font), margin = 6 * unit;
  for (const Label& label : frame.labels) {
    const Vec3f p = view.project(label.position);
    if (!(p.z > 0)) continue;
    const float height = static_cast<float>(view.height), width = static_cast<float>(view.width);
    // A label is above its place, on the picture, off the legends, while the place is on it.
    if (p.x < 0 || p.x > width || p.y < 0 || p.y > height) continue;
    const float top = std::max(margin, height - p.y - 1.35f * font.FontSize);
    const float right = top + font.FontSize > limits.legend_top ? limits.below : width - margin;
    const std::string text = elide(font, label.text, right - margin);
    const float text_size = text_width(font, text);
    const float left = std::clamp(p.x, margin, std::max(margin, right - text_size));
    const float rim = 3 * unit;
    ImGui::GetBackgroundDrawList()->AddRectFilled(
        ImVec2(left - rim, top - 0.5f * rim),
        ImVec2(left + text_size + rim, top + font.FontSize + 0.5f * rim), label_plate, rim);
    draw_text(font, ImVec2(left, top), soft_text, text);
  }
}

void OverlayPass::draw_notes(const Frame& frame) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (const Patch& patch : frame.patches) {
    float longest = 0;
    for (const std::string& line : patch.lines)
      longest = std::max(longest, text_width(*imgui_.text_font(), line));
    const float width =
        patch.lines.empty() ? patch.width : std::min(patch.width, longest + 2 * patch.rim);
    list.AddRectFilled(ImVec2(patch.x, patch.y), ImVec2(patch.x + width, patch.y + patch.height),
                       IM_COL32(patch.color[0], patch.color[1], patch.color[2], patch.color[3]));
  }
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

/// Draws words in the margins that all else leaves free: below lower legends, above the caption.
void OverlayPass::draw_edge_words(const Frame& frame) const {
  const ImFont& font = *imgui_.text_font();
  const float unit = unit_of(font), rim = std::round(12 * unit);
  const auto width = static_cast<float>(frame.width), height = static_cast<float>(frame.height);
  for (std::size_t k = 0; k < frame.edge_words.size(); ++k) {
    const std::string text = elide(font, frame.edge_words[k], width / 3 - rim);
    if (text.empty()) continue;
    const std::size_t column = k % 3;
    const float free = width - 2 * rim - text_width(font, text);
    const float x = rim + 0.5f * static_cast<float>(column) * free;
    const float y = k < 3 ? 4 * unit : height - font.FontSize - 4 * unit;
    draw_text(font, ImVec2(x, y), bright_text, text);
  }
}

void OverlayPass::draw(const Frame& frame, const View& view) {
  const bool has_edge_words = std::ranges::any_of(
      frame.edge_words, [](const std::string& words) { return !words.empty(); });
  if (!has_edge_words && frame.caption.empty() && frame.legends.empty() && frame.marks.empty() &&
      frame.labels.empty() && frame.plots.empty() && frame.patches.empty() && frame.notes.empty() &&
      frame.footnote.empty() && !frame.scale_bar)
    return;
  const int font_size =
      frame.font_size > 0 ? frame.font_size : font_size_for(frame.width, frame.height);
  imgui_.begin(frame.width, frame.height, font_size, all_texts(frame));
  const Limits limits = draw_legends(frame);
  draw_labels(frame, view, limits);
  draw_marks(frame, view);
  draw_caption(frame, limits);
  draw_footnote(frame, draw_plots(frame, *imgui_.text_font(), limits.below), limits.below);
  draw_notes(frame);
  draw_edge_words(frame);
  imgui_.end();
}

}  // namespace neve::render::overlay
