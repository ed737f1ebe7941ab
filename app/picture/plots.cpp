#include "app/picture/plots.h"

#include <algorithm>
#include <array>

#include "app/setup/auto_ranges.h"
#include "app/support/round_number.h"
#include "sim/engine/time_step.h"

namespace neve::app::picture {

namespace {

using Rgb = std::array<std::uint8_t, 3>;

// Colours that stay apart for all kinds of colour vision (Okabe and Ito).
constexpr Rgb sky_blue{86, 180, 233}, orange{230, 159, 0}, white{240, 244, 250}, green{0, 158, 115},
    yellow{240, 228, 66}, purple{204, 121, 167}, vermillion{213, 94, 0}, pink{240, 110, 150};

struct LimitStyle {
  sim::DtLimit limit;
  const char* name;
  Rgb color;
};
constexpr LimitStyle limit_styles[] = {
    {sim::DtLimit::max_dt, "max_dt", white},         {sim::DtLimit::cfl, "cfl", sky_blue},
    {sim::DtLimit::acoustic, "acoustic", orange},    {sim::DtLimit::strain, "strain", purple},
    {sim::DtLimit::fixed, "fixed", yellow},          {sim::DtLimit::frame_end, "frame end", green},
    {sim::DtLimit::collider, "collider", vermillion}};
static_assert(std::size(limit_styles) == sim::dt_limit_count);

render::PlotSeries curve(const char* name, Rgb color, std::span<const PlotSample> history,
                         auto value) {
  render::PlotSeries series{.name = name, .color = color, .time = {}, .value = {}};
  for (const PlotSample& sample : history) {
    series.time.push_back(static_cast<float>(sample.time));
    series.value.push_back(static_cast<float>(value(sample)));
  }
  return series;
}

render::Plot plot_of(const char* title, const char* unit, const std::optional<scene::Range>& range,
                     double now, double duration) {
  const scene::Range axis = range.value_or(scene::Range{});
  return {.title = title,
          .unit = unit,
          .time_end = static_cast<float>(duration),
          .now = static_cast<float>(now),
          .min = static_cast<float>(axis.min),
          .max = static_cast<float>(axis.max),
          .series = {}};
}

/// A bar per frame of the mean step, coloured by the limit that ruled most; only limits that did
/// are named.
render::Plot dt_plot(const scene::PlotRanges& ranges, std::span<const PlotSample> history,
                     double now, double interval, double duration) {
  const scene::Range seconds = ranges.dt.value_or(scene::Range{});
  render::Plot plot = plot_of("time step", "ms",
                              scene::Range{1000 * seconds.min, 1000 * seconds.max}, now, duration);
  for (const LimitStyle& style : limit_styles) {
    render::PlotSeries bars{.name = style.name,
                            .color = style.color,
                            .time = {},
                            .value = {},
                            .bar_width = static_cast<float>(interval)};
    for (const PlotSample& sample : history) {
      if (sample.steps == 0 || sample.limit != style.limit) continue;
      bars.time.push_back(static_cast<float>(sample.time));
      bars.value.push_back(static_cast<float>(1000 * interval / static_cast<double>(sample.steps)));
    }
    if (!bars.time.empty()) plot.series.push_back(std::move(bars));
  }
  return plot;
}

}  // namespace

PlotSample plot_sample(double time, double interval, const sim::Summary& summary,
                       const sim::AdvanceReport& advance) {
  PlotSample sample{time, summary.kinetic_energy, summary.elastic_energy, summary.max_speed,
                    0,    advance.steps,          advance.limit()};
  for (const sim::ColliderLoad& load : advance.loads)
    sample.max_force = std::max(sample.max_force, load.impulse.norm() / interval);
  return sample;
}

std::vector<render::Plot> make_plots(const scene::PlotRanges& ranges, bool has_colliders,
                                     std::span<const PlotSample> history, double now,
                                     double interval, double duration) {
  // Half an interval: times are sums of steps and not exact.
  const auto later = std::find_if(history.begin(), history.end(), [&](const PlotSample& sample) {
    return sample.time > now + 0.5 * interval;
  });
  history = history.first(static_cast<std::size_t>(later - history.begin()));

  render::Plot energy = plot_of("energy", "J", ranges.energy, now, duration);
  energy.series = {
      curve("kinetic", sky_blue, history, [](const PlotSample& s) { return s.kinetic_energy; }),
      curve("elastic", orange, history, [](const PlotSample& s) { return s.elastic_energy; }),
      curve("total", white, history,
            [](const PlotSample& s) { return s.kinetic_energy + s.elastic_energy; })};
  render::Plot speed = plot_of("largest speed", "m/s", ranges.speed, now, duration);
  speed.series = {curve("", vermillion, history, [](const PlotSample& s) { return s.max_speed; })};
  std::vector<render::Plot> plots{energy, speed};
  if (has_colliders) {
    plots.push_back(plot_of("largest force on a collider", "N", ranges.force, now, duration));
    plots.back().series = {
        curve("", pink, history, [](const PlotSample& s) { return s.max_force; })};
  }
  plots.push_back(dt_plot(ranges, history, now, interval, duration));
  return plots;
}

}  // namespace neve::app::picture
