#include "render/overlay/plots.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "render/overlay/overlay_text.h"
#include "render/overlay/text_layout.h"
#include "render/overlay/ticks.h"

namespace neve::render::overlay {
namespace {

constexpr ImU32 panel_color = IM_COL32(8, 10, 16, 120);
constexpr ImU32 grid_color = IM_COL32(205, 213, 224, 38);
constexpr ImU32 axis_color = IM_COL32(205, 213, 224, 150);
constexpr ImU32 now_color = IM_COL32(240, 244, 250, 130);
constexpr int bar_alpha = 215;

ImU32 color_of(const PlotSeries& series, int alpha = 255) {
  return IM_COL32(series.color[0], series.color[1], series.color[2], alpha);
}

/// Layout in pixels: the same for all panels except for top and bottom.
struct Panel {
  float left, right, top, bottom;
};

/// Values to pixels; a range without width or sense becomes one of width 1.
struct Axes {
  Panel panel;
  double time_end, min, max;

  Axes(const Panel& p, const Plot& plot) : panel(p), time_end(plot.time_end), min(0), max(1) {
    if (!(time_end > 0) || !std::isfinite(time_end)) time_end = 1;
    if (!std::isfinite(plot.min) || !std::isfinite(plot.max)) return;
    min = plot.min;
    max = plot.max > plot.min ? double{plot.max} : min + 1;
  }
  float x(double time) const {
    const double part = std::clamp(time / time_end, -1.0, 2.0);
    return panel.left + static_cast<float>(part) * (panel.right - panel.left);
  }
  /// Far outside is as good as a little outside; the panel clips both.
  float y(double value) const {
    const double part = std::clamp((value - min) / (max - min), -1.0, 2.0);
    return panel.bottom - static_cast<float>(part) * (panel.bottom - panel.top);
  }
};

int tick_count(float length, float per_tick, int most) {
  return std::clamp(static_cast<int>(length / per_tick), 1, most);
}

std::vector<Tick> value_ticks(const Axes& axes, const ImFont& font) {
  const float height = axes.panel.bottom - axes.panel.top;
  // One step alone is often longer than the axis: a low panel would have no scale.
  const int least = height > 2 * font.FontSize ? 2 : 1;
  return nice_ticks(axes.min, axes.max,
                    std::max(least, tick_count(height, 1.5f * font.FontSize, 4)));
}

std::vector<Tick> time_ticks(const Axes& axes, const ImFont& font) {
  const float width = axes.panel.right - axes.panel.left;
  return nice_ticks(0, axes.time_end, tick_count(width, 4 * font.FontSize, 6));
}

void draw_grid(const Axes& axes, const ImFont& font) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const Panel& p = axes.panel;
  const float gap = std::round(5 * unit_of(font));
  const float line = std::max(1.0f, std::round(unit_of(font)));
  // Filled rectangles on whole pixels stay crisp where lines would be smeared over two.
  const auto horizontal = [&](float y, float from, float to, ImU32 color) {
    list.AddRectFilled(ImVec2(from, std::round(y)), ImVec2(to, std::round(y) + line), color);
  };
  const auto vertical = [&](float x, float from, float to, ImU32 color) {
    list.AddRectFilled(ImVec2(std::round(x), from), ImVec2(std::round(x) + line, to), color);
  };
  list.AddRectFilled(ImVec2(p.left, p.top), ImVec2(p.right, p.bottom), panel_color);
  for (const Tick& tick : value_ticks(axes, font)) {
    const float y = axes.y(tick.value);
    horizontal(y, p.left, p.right, grid_color);
    horizontal(y, p.left - gap, p.left, axis_color);
    draw_text(font,
              ImVec2(p.left - 1.6f * gap - text_width(font, tick.label), y - 0.5f * font.FontSize),
              soft_text, tick.label);
  }
  for (const Tick& tick : time_ticks(axes, font)) {
    vertical(axes.x(tick.value), p.top, p.bottom, grid_color);
    vertical(axes.x(tick.value), p.bottom, p.bottom + 0.7f * gap, axis_color);
  }
  vertical(p.left, p.top, p.bottom, axis_color);
  horizontal(p.bottom, p.left, p.right, axis_color);
}

void draw_bars(const PlotSeries& series, const Axes& axes) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const double foot = std::max(axes.min, std::min(0.0, axes.max));
  for (std::size_t k = 0; k < series.time.size(); ++k) {
    if (!std::isfinite(series.value[k])) continue;
    const double end = series.time[k];
    // Rounded ends: neighbours touch without overlap.
    const ImVec2 corner(std::round(axes.x(end - series.bar_width)), axes.y(series.value[k]));
    list.AddRectFilled(corner, ImVec2(std::round(axes.x(end)), axes.y(foot)),
                       color_of(series, bar_alpha));
  }
}

void draw_curve(const PlotSeries& series, const Axes& axes, float width) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  std::vector<ImVec2> run;
  const auto draw_run = [&] {
    if (run.size() > 1)
      list.AddPolyline(run.data(), static_cast<int>(run.size()), color_of(series), 0, width);
    run.clear();
  };
  for (std::size_t k = 0; k < series.time.size(); ++k) {
    if (!std::isfinite(series.value[k])) {
      draw_run();
      continue;
    }
    run.emplace_back(axes.x(series.time[k]), axes.y(series.value[k]));
  }
  const bool has_end = !run.empty();
  const ImVec2 end = has_end ? run.back() : ImVec2();
  draw_run();
  if (has_end) list.AddCircleFilled(end, 1.7f * width, color_of(series), 16);
}

/// "energy (J)  kinetic  elastic  total": the names in the colours of their curves.
void draw_title(const Plot& plot, const Axes& axes, const ImFont& font) {
  const float y = axes.panel.top - 1.3f * font.FontSize;
  const float gap = 0.6f * font.FontSize;
  const std::string title = plot.unit.empty() ? plot.title : plot.title + " (" + plot.unit + ")";
  const float room = axes.panel.right - axes.panel.left;
  float x = axes.panel.left;
  const std::string shown = elide(font, title, room);
  draw_text(font, ImVec2(x, y), bright_text, shown);
  x += text_width(font, shown);
  for (const PlotSeries& series : plot.series) {
    if (series.name.empty()) continue;
    const float width = text_width(font, series.name);
    if (x + gap + width > axes.panel.right + 2 * font.FontSize) break;
    draw_text(font, ImVec2(x + gap, y), color_of(series), series.name);
    x += gap + width;
  }
}

void draw_panel(const Plot& plot, const Axes& axes, const ImFont& font) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const Panel& p = axes.panel;
  const float unit = unit_of(font);
  draw_grid(axes, font);
  draw_title(plot, axes, font);
  const float overhang = 3 * unit;  // the dot at the end of a curve may reach over the border
  list.PushClipRect(ImVec2(p.left, p.top - overhang),
                    ImVec2(p.right + overhang, p.bottom + overhang));
  for (const PlotSeries& series : plot.series)
    if (series.bar_width > 0) draw_bars(series, axes);
  const float x = std::round(axes.x(plot.now));
  const float half = 0.5f * std::max(1.0f, std::round(unit));
  list.AddRectFilled(ImVec2(x - half, p.top), ImVec2(x + half, p.bottom), now_color);
  // The last one first: sums come after their parts and often lie on one of them.
  for (auto series = plot.series.rbegin(); series != plot.series.rend(); ++series)
    if (!(series->bar_width > 0)) draw_curve(*series, axes, std::max(1.25f, 1.8f * unit));
  list.PopClipRect();
}

void draw_time_labels(const Axes& axes, const ImFont& font) {
  const float y = axes.panel.bottom + 0.35f * font.FontSize;
  const std::vector<Tick> ticks = time_ticks(axes, font);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const bool is_last = k + 1 == ticks.size();
    const std::string label = ticks[k].label + (is_last ? " s" : "");
    const float number = text_width(font, ticks[k].label);
    draw_text(font, ImVec2(axes.x(ticks[k].value) - 0.5f * number, y), soft_text, label);
  }
}

}  // namespace

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
  for (std::size_t k = 0; k < count; ++k) {
    const float below = static_cast<float>(count - 1 - k) * each;
    const Panel panel{left, right, std::round(bottom - below - (each - title - gap)),
                      std::round(bottom - below)};
    const Axes axes(panel, frame.plots[k]);
    draw_panel(frame.plots[k], axes, font);
    if (k + 1 == count) draw_time_labels(axes, font);
  }
  return right;
}

}  // namespace neve::render::overlay
