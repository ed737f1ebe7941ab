#include "render/overlay/plot_canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace neve::render::overlay {
namespace {

constexpr Rgba panel_color{8, 10, 16, 120}, grid_color{205, 213, 224, 38},
    axis_color{205, 213, 224, 150}, now_color{240, 244, 250, 130}, bright_text{240, 244, 250, 255},
    soft_text{205, 213, 224, 255};
constexpr std::uint8_t bar_alpha = 215;

Rgba color_of(const PlotSeries& series, std::uint8_t alpha = 255) {
  return {series.color[0], series.color[1], series.color[2], alpha};
}

int tick_count(float length, float per_tick, int most) {
  return std::clamp(static_cast<int>(length / per_tick), 1, most);
}

/// A plot on its way to a canvas. A range without width or sense becomes one of width 1.
class PlotDrawing {
 public:
  PlotDrawing(const Plot& plot, const PlotPanel& panel, PlotCanvas& canvas)
      : plot_(plot), panel_(panel), canvas_(canvas), size_(canvas.text_size), unit_(size_ / 16) {
    if (plot.x_end > 0 && std::isfinite(plot.x_end)) x_end_ = static_cast<double>(plot.x_end);
    if (!std::isfinite(plot.min) || !std::isfinite(plot.max)) return;
    min_ = static_cast<double>(plot.min);
    max_ = plot.max > plot.min ? static_cast<double>(plot.max) : min_ + 1;
  }

  void draw(PlotWords words) {
    draw_grid(words.has_values);
    if (words.has_title) draw_title();
    const float overhang = 3 * unit_;  // the dot at the end of a curve may reach over the border
    canvas_.clip({panel_.left, panel_.top - overhang},
                 {panel_.right + overhang, panel_.bottom + overhang});
    draw_cells();
    for (const PlotSeries& series : plot_.series)
      if (series.bar_width > 0) draw_bars(series);
    draw_now();
    // The last one first: sums come after their parts and often lie on one of them.
    for (auto series = plot_.series.rbegin(); series != plot_.series.rend(); ++series)
      if (!(series->bar_width > 0) && !(series->dot_radius > 0)) draw_curve(*series);
    canvas_.unclip();
    // Dots at the border stay whole.
    for (auto series = plot_.series.rbegin(); series != plot_.series.rend(); ++series)
      if (series->dot_radius > 0) draw_dots(*series);
    if (words.has_x) draw_x_words();
    draw_beyond();
  }

 private:
  float x(double place) const {
    const double part = std::clamp(place / x_end_, -1.0, 2.0);
    return panel_.left + static_cast<float>(part) * (panel_.right - panel_.left);
  }
  /// Far outside is as good as a little outside; the panel clips both.
  float y(double value) const {
    const double part = std::clamp((value - min_) / (max_ - min_), -1.0, 2.0);
    return panel_.bottom - static_cast<float>(part) * (panel_.bottom - panel_.top);
  }
  Place at(const PlotSeries& series, std::size_t k) const {
    return {x(static_cast<double>(series.x[k])), y(static_cast<double>(series.value[k]))};
  }

  std::vector<Tick> value_ticks() const {
    if (!plot_.ticks.empty()) return plot_.ticks;
    const float height = panel_.bottom - panel_.top;
    // One step alone is often longer than the axis: a low panel would have no scale.
    const int least = height > 2 * size_ ? 2 : 1;
    return nice_ticks(min_, max_, std::max(least, tick_count(height, 1.5f * size_, 4)));
  }
  std::vector<Tick> x_ticks() const {
    if (!plot_.x_ticks.empty()) return plot_.x_ticks;
    return nice_ticks(0, x_end_, tick_count(panel_.right - panel_.left, 4 * size_, 6));
  }

  // Filled rectangles on whole pixels stay crisp where lines would be smeared over two.
  void horizontal(float y, float from, float to, Rgba color) {
    canvas_.rectangle({from, std::round(y)}, {to, std::round(y) + line_}, color);
  }
  void vertical(float x, float from, float to, Rgba color) {
    canvas_.rectangle({std::round(x), from}, {std::round(x) + line_, to}, color);
  }

  void draw_grid(bool has_values) {
    const PlotPanel& p = panel_;
    const float gap = std::round(5 * unit_);
    canvas_.rectangle({p.left, p.top}, {p.right, p.bottom}, panel_color);
    for (const Tick& tick : value_ticks()) {
      const float at = y(tick.value);
      horizontal(at, p.left, p.right, grid_color);
      horizontal(at, p.left - gap, p.left, axis_color);
      if (has_values)
        canvas_.text({p.left - 1.6f * gap, at - 0.5f * size_}, Note::Anchor::right, soft_text,
                     tick.label);
    }
    for (const Tick& tick : x_ticks()) {
      vertical(x(tick.value), p.top, p.bottom, grid_color);
      vertical(x(tick.value), p.bottom, p.bottom + 0.7f * gap, axis_color);
    }
    vertical(p.left, p.top, p.bottom, axis_color);
    horizontal(p.bottom, p.left, p.right, axis_color);
  }

  /// "energy (J)  kinetic  elastic  total": the names in the colours of their curves.
  void draw_title() {
    const float y = panel_.top - 1.3f * size_, gap = 0.6f * size_;
    float x = panel_.left;
    const std::string title =
        plot_.unit.empty() ? plot_.title : plot_.title + " (" + plot_.unit + ")";
    const std::string shown = canvas_.fitting(title, panel_.right - panel_.left);
    canvas_.text({x, y}, Note::Anchor::left, bright_text, shown);
    x += canvas_.text_width(shown);
    for (const PlotSeries& series : plot_.series) {
      if (series.name.empty()) continue;
      const float width = canvas_.text_width(series.name);
      if (x + gap + width > panel_.right + 2 * size_) break;
      canvas_.text({x + gap, y}, Note::Anchor::left, color_of(series), series.name);
      x += gap + width;
    }
  }

  void draw_cells() {
    if (plot_.cell_columns <= 0) return;
    const int columns = plot_.cell_columns, rows = static_cast<int>(plot_.cells.size()) / columns;
    const auto across = [](float from, float to, int k, int count) {
      return std::round(from + (to - from) * static_cast<float>(k) / static_cast<float>(count));
    };
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const auto& c = plot_.cells[static_cast<std::size_t>(row * columns + column)];
        canvas_.rectangle({across(panel_.left, panel_.right, column, columns),
                           across(panel_.top, panel_.bottom, row, rows)},
                          {across(panel_.left, panel_.right, column + 1, columns),
                           across(panel_.top, panel_.bottom, row + 1, rows)},
                          {c[0], c[1], c[2], 255});
      }
  }

  void draw_bars(const PlotSeries& series) {
    const double foot = std::max(min_, std::min(0.0, max_)),
                 width = static_cast<double>(series.bar_width);
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      if (!std::isfinite(series.value[k])) continue;
      const double end = static_cast<double>(series.x[k]);
      // Rounded ends: neighbours touch without overlap.
      canvas_.rectangle({std::round(x(end - width)), at(series, k).y},
                        {std::round(x(end)), y(foot)}, color_of(series, bar_alpha));
    }
  }

  void draw_now() {
    if (!plot_.now) return;
    const float at = std::round(x(static_cast<double>(*plot_.now))), half = 0.5f * line_;
    canvas_.rectangle({at - half, panel_.top}, {at + half, panel_.bottom}, now_color);
  }

  void draw_curve(const PlotSeries& series) {
    const float width = std::max(1.25f, 1.8f * unit_);
    std::vector<Place> run;
    const auto draw_run = [&] {
      if (run.size() > 1) canvas_.curve(run, color_of(series), width);
    };
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      if (std::isfinite(series.value[k])) {
        run.push_back(at(series, k));
        continue;
      }
      draw_run();
      run.clear();
    }
    draw_run();
    if (!run.empty()) canvas_.circle(run.back(), 1.7f * width, color_of(series), 0, "");
  }

  void draw_dots(const PlotSeries& series) {
    for (std::size_t k = 0; k < series.x.size(); ++k)
      canvas_.circle(at(series, k), series.dot_radius * unit_, color_of(series),
                     series.has_rings ? 2 * unit_ : 0,
                     k < series.notes.size() ? series.notes[k] : std::string());
  }

  /// "to 12.2", at each end of the axis where a curve leaves it.
  void draw_beyond() {
    double smallest = min_, largest = max_;
    for (const PlotSeries& series : plot_.series)
      for (const float value : series.value) {
        if (!std::isfinite(value)) continue;
        smallest = std::min(smallest, static_cast<double>(value));
        largest = std::max(largest, static_cast<double>(value));
      }
    const double least = 1e-3 * (max_ - min_);
    if (largest > max_ + least) draw_end(largest, panel_.top + 0.2f * size_);
    if (smallest < min_ - least) draw_end(smallest, panel_.bottom - 1.2f * size_);
  }

  void draw_end(double value, float top) {
    std::array<char, 32> number{};
    std::snprintf(number.data(), number.size(), "to %.3g", value);
    canvas_.text({panel_.right - 0.4f * size_, top}, Note::Anchor::right, bright_text,
                 number.data());
  }

  void draw_x_words() {
    const float y = panel_.bottom + 0.35f * size_;
    const std::vector<Tick> ticks = x_ticks();
    for (std::size_t k = 0; k < ticks.size(); ++k) {
      const bool has_unit = k + 1 == ticks.size() && !plot_.x_unit.empty();
      const std::string label = has_unit ? ticks[k].label + " " + plot_.x_unit : ticks[k].label;
      float left = x(ticks[k].value) - 0.5f * canvas_.text_width(ticks[k].label);
      // Given ones may be long, and end where the picture does.
      if (!plot_.x_ticks.empty())
        left = std::min(left, panel_.right + 0.5f * size_ - canvas_.text_width(label));
      canvas_.text({left, y}, Note::Anchor::left, soft_text, label);
    }
    if (!plot_.x_title.empty())
      canvas_.text({0.5f * (panel_.left + panel_.right), y + 1.2f * size_}, Note::Anchor::middle,
                   soft_text, plot_.x_title);
  }

  const Plot& plot_;
  const PlotPanel& panel_;
  PlotCanvas& canvas_;
  const float size_, unit_, line_ = std::max(1.0f, std::round(unit_));
  double x_end_ = 1, min_ = 0, max_ = 1;
};

}  // namespace

void draw_plot(const Plot& plot, const PlotPanel& panel, PlotWords words, PlotCanvas& canvas) {
  PlotDrawing(plot, panel, canvas).draw(words);
}

}  // namespace neve::render::overlay
