#include "app/card/panel.h"

#include <algorithm>
#include <cmath>

#include "app/picture/frame_builder.h"
#include "app/support/round_number.h"

namespace neve::app::card {

namespace {

constexpr picture::Rgb behind{120, 128, 140};
constexpr int margin = 12, top = 34, picture_width = 214, picture_height = 206;
constexpr int plot_left = margin + picture_width + 6, plot_width = 208, plot_height = 142;

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values)
    if (std::isfinite(value)) most = std::max(most, value);
  return most;
}

render::PlotSeries curve_of(const Experiment& e, const Axes& axes, picture::Rgb color) {
  const KindInfo& info = info_of(e.kind);
  render::PlotSeries series;
  series.color = color;
  for (std::size_t k = 0; k < e.x.size(); ++k) {
    series.x.push_back(static_cast<float>(info.x_scale * e.x[k]));
    series.value.push_back(static_cast<float>(axes.y_scale * e.y[k]));
  }
  return series;
}

/// The overlay has plots in its lower left corner, in proportion to the picture: one of this size
/// is cut out of a picture that is large enough.
render::Image draw_plot(const render::Plot& plot, render::Renderer& renderer) {
  constexpr double share_of_width = 0.22, share_of_height = 0.2;
  constexpr int above = 2 * card_font, below = 20 + 3 * card_font / 2;
  render::Frame frame;
  frame.font_size = card_font;
  frame.width = static_cast<int>(std::lround(plot_width / share_of_width));
  frame.height = static_cast<int>(std::lround((plot_height + above) / share_of_height));
  frame.width = std::min(frame.width, frame.height - 1);
  frame.plots = {plot};
  const render::Image image =
      renderer.draw_over(render::compose(frame.width, frame.height, card_ground, {}), frame);
  const int left = 10, upper = frame.height - below - plot_height - above;
  return render::compose(panel_width - plot_left, frame.height - upper, card_ground,
                         {{-left, -upper, image}});
}

render::Plot plot_of(const Experiment& e, const std::vector<const Experiment*>& others,
                     const Axes& axes) {
  const KindInfo& info = info_of(e.kind);
  render::Plot plot;
  plot.title = info.y_title;
  plot.unit = axes.y_unit;
  plot.x_title = info.x_title;
  plot.x_unit = info.x_unit;
  plot.x_end = static_cast<float>(axes.x_end);
  plot.x_ticks = render::nice_ticks(0, axes.x_end, 4);
  plot.min = static_cast<float>(axes.low);
  plot.max = static_cast<float>(axes.high);
  plot.series.push_back(curve_of(e, axes, picture::orange));
  for (const Experiment* other : others) plot.series.push_back(curve_of(*other, axes, behind));
  return plot;
}

render::Image draw_stage(const Experiment& e, render::Renderer& renderer) {
  scene::View view = e.stage.views.front();
  view.size = scene::PictureSize{picture_width, picture_height};
  view.background = scene::Background::gradient;
  picture::PictureOptions options;
  options.quality = setup::Quality::final;
  render::Frame frame = picture::FrameBuilder(e.stage, e.seeded, options).build(view, e.shown);
  frame.caption.clear();
  return renderer.draw(frame);
}

}  // namespace

Axes axes_of(const std::vector<const Experiment*>& experiments) {
  const KindInfo& info = info_of(experiments.front()->kind);
  double x = 0, y = 0, low = 0;
  for (const Experiment* e : experiments) {
    x = std::max(x, largest(e->x));
    y = std::max(y, largest(e->y));
    for (const double value : e->y)
      if (std::isfinite(value)) low = std::min(low, value);
  }
  Axes axes;
  axes.y_scale = info.y_scale;
  axes.y_unit = info.y_unit;
  if (axes.y_unit == std::string("Pa") && y >= 1e3) {
    axes.y_unit = y >= 1e6 ? "MPa" : "kPa";
    axes.y_scale = y >= 1e6 ? 1e-6 : 1e-3;
  }
  axes.x_end = x > 0 ? info.x_scale * x : 1;
  axes.high = y > 0 ? round_up(1.05 * axes.y_scale * y) : 1;
  // Plates swing back on what tears, and push.
  const double below = -axes.y_scale * low;
  if (below > 0.02 * axes.high) axes.low = -round_up(1.05 * below);
  return axes;
}

void add_panel(const Experiment& e, const std::vector<const Experiment*>& others, const Axes& axes,
               int x, int y, render::Renderer& renderer, std::vector<render::Tile>& tiles,
               render::Frame& words) {
  const KindInfo& info = info_of(e.kind);
  tiles.push_back({x + plot_left, y + top - 8, draw_plot(plot_of(e, others, axes), renderer)});
  tiles.push_back({x + margin, y + top + 24, draw_stage(e, renderer)});
  const auto note = [&](int at_x, int at_y, const std::string& text, bool is_title,
                        picture::Rgb color) {
    words.notes.push_back({static_cast<float>(x + at_x), static_cast<float>(y + at_y), text,
                           render::Note::Anchor::left,
                           static_cast<float>(panel_width - margin - at_x), is_title, color});
  };
  note(margin, 4, info.title, true, card_bright);
  note(margin + 84, 9, info.setting, false, card_soft);
  std::string line;
  for (std::size_t k = 1; k < e.words.size(); ++k) line += (k > 1 ? ", " : "") + e.words[k];
  if (!e.words.empty())
    note(margin, top + picture_height + 30, e.words.front(), false, picture::orange);
  note(margin, top + picture_height + 50, e.failure.empty() ? line : e.failure, false,
       e.failure.empty() ? card_bright : picture::vermillion);
}

}  // namespace neve::app::card
