#include "app/compare/series.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/support/round_number.h"
#include "render/frame/compose.h"

namespace neve::app::compare {

namespace {

using record::FrameRecord;

/// A number of a frame that is worth a curve.
struct PairMetric {
  const char *name, *title, *unit;
  double (*of)(const FrameRecord&);
  bool is_of_bodies = false;  ///< that move by themselves
};

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Snow that is not there has no shape and no density.
double of_snow(const FrameRecord& frame, double value) {
  return record::has_snow(frame) ? value : none;
}

constexpr PairMetric pair_metrics[] = {
    {"spread", "spread", "m", [](const FrameRecord& f) { return of_snow(f, f.metrics.spread); }},
    {"height", "height", "m", [](const FrameRecord& f) { return of_snow(f, f.metrics.height); }},
    {"kinetic_energy", "kinetic energy", "J",
     [](const FrameRecord& f) { return f.summary.kinetic_energy; }},
    {"elastic_energy", "elastic energy", "J",
     [](const FrameRecord& f) { return f.summary.elastic_energy; }},
    {"max_speed", "largest speed", "m/s", [](const FrameRecord& f) { return f.summary.max_speed; }},
    {"mean_J_P", "mean J_P", "",
     [](const FrameRecord& f) { return of_snow(f, f.metrics.mean_J_P); }},
    {"fragments", "fragments", "",
     [](const FrameRecord& f) { return static_cast<double>(f.metrics.fragments); }},
    {"largest_fragment", "largest fragment", "",
     [](const FrameRecord& f) { return of_snow(f, f.metrics.largest_fragment); }},
    {"powder", "share of powder", "",
     [](const FrameRecord& f) { return of_snow(f, f.metrics.powder); }},
    {"crumbs", "share of crumbs", "",
     [](const FrameRecord& f) { return of_snow(f, f.metrics.crumbs); }},
    {"max_depth_cells", "depth in colliders", "cells",
     [](const FrameRecord& f) { return f.metrics.max_depth_cells; }},
    {"steps", "steps a frame", "",
     [](const FrameRecord& f) { return static_cast<double>(f.advance.steps); }},
    {"body_speed", "fastest body", "m/s",
     [](const FrameRecord& f) { return record::largest_speed(f.bodies).value_or(none); }, true},
    {"body_height", "lowest body", "m",
     [](const FrameRecord& f) { return record::lowest(f.bodies).value_or(none); }, true}};

/// Returns the metrics to list: those of bodies only where some have values.
std::vector<std::size_t> listed_metrics(const std::vector<PairMoment>& moments) {
  const auto is_told = [&](std::size_t k) {
    for (const PairMoment& moment : moments)
      for (const std::vector<double>& side : moment.metrics)
        if (!side.empty() && std::isfinite(side[k])) return true;
    return false;
  };
  std::vector<std::size_t> listed;
  for (std::size_t k = 0; k < std::size(pair_metrics); ++k)
    if (!pair_metrics[k].is_of_bodies || is_told(k)) listed.push_back(k);
  return listed;
}

std::vector<double> metrics_at(int frame, const std::vector<FrameRecord>& records) {
  const auto record = std::ranges::find(records, frame, &FrameRecord::frame);
  std::vector<double> values;
  if (record == records.end()) return values;
  for (const PairMetric& metric : pair_metrics) values.push_back(metric.of(*record));
  return values;
}

/// Name and value of every number of a moment, in the order of the table.
std::vector<std::pair<std::string, double>> numbers_of(const PairMoment& m,
                                                       const std::vector<std::size_t>& listed) {
  std::vector<std::pair<std::string, double>> numbers{{"time", m.time}};
  for (const std::size_t k : listed)
    for (std::size_t side = 0; side < 2; ++side)
      numbers.emplace_back(pair_metrics[k].name + std::string(side == 0 ? "_a" : "_b"),
                           m.metrics[side].empty() ? none : m.metrics[side][k]);
  if (m.displacement) {
    numbers.emplace_back("displacement_mean", m.displacement->mean);
    numbers.emplace_back("displacement_largest", m.displacement->largest);
    numbers.emplace_back("particles_in_both", static_cast<double>(m.displacement->in_both));
    numbers.emplace_back("particles_only_a", static_cast<double>(m.displacement->only_a));
    numbers.emplace_back("particles_only_b", static_cast<double>(m.displacement->only_b));
  }
  if (m.mass) {
    numbers.emplace_back("mass_more_a", (*m.mass)[0]);
    numbers.emplace_back("mass_more_b", (*m.mass)[1]);
  }
  return numbers;
}

constexpr std::array<std::uint8_t, 3> color_a{86, 180, 233}, color_b{230, 159, 0},
    plain_ground{30, 33, 39};
constexpr int panel_font = 20, panel_width = 400, panel_height = 390, panel_columns = 3;
/// Empty part above the curves, which the panel above covers.
constexpr int panel_top = 125;

render::PlotSeries curve_of(const std::vector<PairMoment>& moments, std::size_t metric,
                            std::size_t side) {
  render::PlotSeries series;
  series.name = side == 0 ? "A" : "B";
  series.color = side == 0 ? color_a : color_b;
  for (const PairMoment& m : moments) {
    if (m.metrics[side].empty()) continue;
    series.x.push_back(static_cast<float>(m.time));
    series.value.push_back(static_cast<float>(m.metrics[side][metric]));
  }
  return series;
}

render::Plot plot_of_metric(const std::vector<PairMoment>& moments, std::size_t metric) {
  render::Plot plot;
  plot.title = pair_metrics[metric].title;
  plot.unit = pair_metrics[metric].unit;
  plot.x_end = static_cast<float>(moments.back().time);
  plot.now = plot.x_end;
  double least = 0, most = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    plot.series.push_back(curve_of(moments, metric, side));
    for (const float value : plot.series.back().value) {
      if (!std::isfinite(value)) continue;
      least = std::min(least, static_cast<double>(value));
      most = std::max(most, static_cast<double>(value));
    }
  }
  plot.min = static_cast<float>(-round_up(-least));
  plot.max = static_cast<float>(round_up(most));
  return plot;
}

render::Image draw_panel(const std::vector<PairMoment>& moments, std::size_t metric,
                         render::Renderer& renderer) {
  render::Frame frame;
  frame.width = panel_width;
  frame.height = panel_height;
  frame.font_size = panel_font;
  frame.plots = {plot_of_metric(moments, metric)};
  return renderer.draw_over(render::compose(panel_width, panel_height, plain_ground, {}), frame);
}

}  // namespace

PairMoment moment_of(int frame, const scene::Scene& scene_a,
                     const std::vector<record::FrameRecord>& a,
                     const std::vector<record::FrameRecord>& b) {
  PairMoment moment;
  moment.frame = scene::number_of(scene_a, frame);
  moment.time = frame / scene_a.fps;
  moment.metrics = {metrics_at(frame, a), metrics_at(frame, b)};
  return moment;
}

std::string series_csv(const std::vector<PairMoment>& moments) {
  std::string text = "frame";
  if (moments.empty()) return text + "\n";
  const std::vector<std::size_t> listed = listed_metrics(moments);
  for (const auto& [title, value] : numbers_of(moments.front(), listed)) text += "," + title;
  text += "\n";
  for (const PairMoment& m : moments) {
    text += std::to_string(m.frame);
    for (const auto& [title, value] : numbers_of(m, listed))
      text += "," + (std::isfinite(value) ? fmt::format("{}", value) : std::string());
    text += "\n";
  }
  return text;
}

Json series_json(const std::vector<PairMoment>& moments) {
  Json list = Json::array();
  const std::vector<std::size_t> listed = listed_metrics(moments);
  for (const PairMoment& m : moments) {
    Json row;
    row["frame"] = m.frame;
    for (const auto& [title, value] : numbers_of(m, listed)) row[title] = number_or_null(value);
    list.push_back(row);
  }
  return list;
}

render::Image draw_series(const std::vector<PairMoment>& moments, const std::string& title_a,
                          const std::string& title_b, render::Renderer& renderer) {
  const int each = panel_height - panel_top;
  const std::vector<std::size_t> listed = listed_metrics(moments);
  const int rows = (static_cast<int>(listed.size()) + panel_columns - 1) / panel_columns;
  const int head = 4 * panel_font, width = panel_columns * panel_width,
            height = head + rows * each + panel_font / 2;
  std::vector<render::Tile> tiles;
  // Panels are laid from the lowest row up: each covers the empty part of the one below.
  for (int k = static_cast<int>(listed.size()) - 1; k >= 0; --k)
    tiles.push_back({(k % panel_columns) * panel_width,
                     head + (k / panel_columns) * each - panel_top,
                     draw_panel(moments, listed[static_cast<std::size_t>(k)], renderer)});
  render::Frame words;
  words.width = width;
  words.height = height;
  words.font_size = panel_font;
  const auto size = static_cast<float>(panel_font), room = static_cast<float>(width) - 2 * size;
  words.notes = {
      {size, 0.7f * size, "A   " + title_a, render::Note::Anchor::left, room, false, color_a},
      {size, 2.1f * size, "B   " + title_b, render::Note::Anchor::left, room, false, color_b}};
  return renderer.draw_over(render::compose(width, height, plain_ground, tiles), words);
}

}  // namespace neve::app::compare
