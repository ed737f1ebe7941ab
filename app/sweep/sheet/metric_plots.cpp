#include "app/sweep/sheet/metric_plots.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/support/text.h"
#include "app/sweep/plan/labels.h"
#include "app/sweep/store/points.h"
#include "render/overlay/svg.h"

namespace neve::app::sweep::sheet {

namespace {

constexpr float font_size = 13, panel_width = 210, panel_height = 120, left_room = 62,
                top_room = 30, bottom_room = 42, gap = 16, page_width = 1420;

/// Positions of the runs along one parameter.
struct Across {
  std::string title;
  std::vector<std::optional<double>> place;  ///< 0 to 1, of each run
  std::vector<render::Tick> ticks;
};

Across by_run(const store::Manifest& manifest) {
  Across across;
  const auto seeds = static_cast<std::size_t>(manifest.seeds);
  across.title = seeds > 1 ? "point" : "run";
  const std::size_t count = manifest.runs.size() / seeds;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    across.place.insert(across.place.end(), seeds, at);
    if (count <= 12 || k % (count / 6) == 0) across.ticks.push_back({at, std::to_string(k)});
  }
  return across;
}

Across by_choice(const store::Manifest& manifest, const Parameter& parameter) {
  Across across;
  across.title = parameter.name;
  std::vector<std::string> values;
  // An inherited text is in quotes, one of an axis is not.
  const auto value_of = [&](const Run& run) {
    return plan::value_text(run.value(parameter.address));
  };
  for (const Run& run : manifest.runs) {
    const std::string value = value_of(run);
    if (!value.empty() && std::find(values.begin(), values.end(), value) == values.end())
      values.push_back(value);
  }
  const auto place = [&](std::size_t k) {
    return (static_cast<double>(k) + 0.5) / static_cast<double>(values.size());
  };
  for (const Run& run : manifest.runs) {
    const auto found = std::find(values.begin(), values.end(), value_of(run));
    across.place.push_back(
        found == values.end()
            ? std::nullopt
            : std::optional(place(static_cast<std::size_t>(found - values.begin()))));
  }
  for (std::size_t k = 0; k < values.size() && values.size() <= 8; ++k)
    across.ticks.push_back({place(k), values[k]});
  return across;
}

/// Spans a range, logarithmic if values are positive and go over more than a factor of 20.
Across by_number(const Parameter& parameter, const std::vector<std::optional<double>>& values) {
  Across across;
  across.title = plan::titled(parameter.name, parameter.unit);
  double low = 1e300, high = -1e300;
  for (const std::optional<double>& x : values)
    if (x) low = std::min(low, *x), high = std::max(high, *x);
  const bool is_logarithmic = low > 0 && high > 20 * low;
  const auto scaled = [&](double x) { return is_logarithmic ? std::log10(x) : x; };
  const double a = scaled(low), width = std::max(scaled(high) - a, 1e-300);
  const auto place = [&](double x) {
    return high > low ? 0.04 + 0.92 * (scaled(x) - a) / width : 0.5;
  };
  for (const std::optional<double>& x : values)
    across.place.push_back(x ? std::optional(place(*x)) : std::nullopt);
  std::vector<double> kinds;
  for (const std::optional<double>& x : values)
    if (x && std::find(kinds.begin(), kinds.end(), *x) == kinds.end()) kinds.push_back(*x);
  std::sort(kinds.begin(), kinds.end());
  double nearest = 1;
  for (std::size_t k = 1; k < kinds.size(); ++k)
    nearest = std::min(nearest, place(kinds[k]) - place(kinds[k - 1]));
  // The values themselves where there is room for them.
  constexpr double room = 0.16;
  if (nearest >= room || kinds.size() == 1) {
    for (const double x : kinds)
      across.ticks.push_back({place(x), plan::value_text(scene::toml::number_text(x))});
  } else if (is_logarithmic) {
    across.ticks = {{place(low), plan::value_text(scene::toml::number_text(low))},
                    {place(high), plan::value_text(scene::toml::number_text(high))}};
  } else {
    for (const render::Tick& tick : render::nice_ticks(low, high, 4))
      across.ticks.push_back({place(tick.value), tick.label});
  }
  return across;
}

std::vector<Across> parameters_across(const store::Manifest& manifest) {
  std::vector<Across> columns;
  for (const Parameter& parameter : manifest.parameters) {
    if (manifest.seeds > 1 && parameter.address == "seed") continue;
    std::vector<std::optional<double>> values;
    std::size_t numbers = 0, given = 0;
    for (const Run& run : manifest.runs) {
      values.push_back(number_of(run.value(parameter.address)));
      numbers += values.back().has_value();
      given += !run.value(parameter.address).empty();
    }
    // A value that only one run gives is no axis.
    if (given < 2 || given < manifest.runs.size()) continue;
    columns.push_back(numbers == given ? by_number(parameter, values)
                                       : by_choice(manifest, parameter));
  }
  if (columns.empty()) columns.push_back(by_run(manifest));
  return columns;
}

struct Extent {
  double low = 0, high = 1;
};

/// Extent of the finished runs; of all runs if none is finished.
std::optional<Extent> extent_of(const store::Manifest& manifest,
                                const std::vector<store::RunResult>& results, std::size_t metric) {
  Extent all{1e300, -1e300}, whole = all;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const std::optional<double>& x = results[k].metrics[metric];
    if (!x) continue;
    all = {std::min(all.low, *x), std::max(all.high, *x)};
    if (store::is_whole(manifest.runs[k], results[k]))
      whole = {std::min(whole.low, *x), std::max(whole.high, *x)};
  }
  const Extent e = whole.low > whole.high ? all : whole;
  if (e.low > e.high) return std::nullopt;
  const double room =
      e.high > e.low ? 0.08 * (e.high - e.low) : std::max(1e-9, 0.1 * std::abs(e.high));
  return Extent{e.low - room, e.high + room};
}

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour blue{86, 180, 233}, pale_blue{62, 96, 118}, grey{142, 150, 162},
    pale_grey{84, 90, 98};

/// The place of each point, so that those with one value lie side by side.
std::vector<std::optional<double>> places_of(const Across& across,
                                             const std::vector<store::Point>& points) {
  constexpr double apart = 0.022;
  std::vector<std::optional<double>> places;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::optional<double> own = across.place[points[k].first];
    double before = 0, all = 0;
    for (std::size_t other = 0; own && other < points.size(); ++other)
      if (across.place[points[other].first] == own) {
        before += other < k;
        ++all;
      }
    const double step = all > 1 ? std::min(apart, 0.12 / (all - 1)) : 0;
    places.push_back(own ? std::optional(*own + step * (before - 0.5 * (all - 1))) : std::nullopt);
  }
  return places;
}

void add_line(double x0, double y0, double x1, double y1, render::PlotSeries& lines) {
  for (const double x : {x0, x1, x1}) lines.x.push_back(static_cast<float>(x));
  for (const double y : {y0, y1, std::nan("")}) lines.value.push_back(static_cast<float>(y));
}

/// Adds a line from min to max of each point, with the mean.
void add_whiskers(const std::vector<std::optional<double>>& places,
                  const std::vector<store::Point>& points, std::size_t metric, bool is_noise,
                  render::Plot& plot) {
  render::PlotSeries lines{.name = {}, .color = is_noise ? grey : blue, .x = {}, .value = {}};
  render::PlotSeries means = lines;
  means.dot_radius = 4.2f;
  constexpr double cap = 0.008;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const store::Summary& s = points[k].metrics[metric];
    if (s.count == 0 || !places[k]) continue;
    const double x = *places[k];
    add_line(x, s.min, x, s.max, lines);
    for (const double end : {s.min, s.max}) add_line(x - cap, end, x + cap, end, lines);
    means.x.push_back(static_cast<float>(x));
    means.value.push_back(static_cast<float>(s.mean));
    means.notes.push_back(fmt::format("point {}: mean {}, {} to {} in {} runs", k,
                                      rough_text(s.mean), rough_text(s.min), rough_text(s.max),
                                      s.count));
  }
  plot.series.push_back(std::move(lines));
  plot.series.push_back(std::move(means));
}

/// Draws whole runs as dots, others as rings; with seeds small ones, and a whisker for each point.
render::Plot plot_of(const Across& across, const std::vector<store::RunResult>& results,
                     const store::Manifest& manifest, const std::vector<store::Point>& points,
                     std::size_t metric, const Extent& extent) {
  const store::MetricInfo& info = store::metric_infos()[metric];
  const bool has_seeds = manifest.seeds > 1, is_noise = store::is_noise(manifest, points, metric);
  const std::vector<std::optional<double>> places = places_of(across, points);
  const Colour dots = !has_seeds ? blue : is_noise ? pale_grey : pale_blue;
  render::PlotSeries whole{.name = {}, .color = dots, .x = {}, .value = {}},
      failed{.name = {}, .color = {230, 120, 60}, .x = {}, .value = {}};
  whole.dot_radius = has_seeds ? 2.4f : 4.2f;
  failed.dot_radius = 4.2f;
  failed.has_rings = true;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const std::optional<double>& value = results[k].metrics[metric];
    if (!value || !across.place[k]) continue;
    const Run& run = manifest.runs[k];
    const bool is_ok = results[k].status.state == store::RunState::ok;
    render::PlotSeries& series = is_ok ? whole : failed;
    const std::size_t point = k / static_cast<std::size_t>(manifest.seeds);
    series.x.push_back(static_cast<float>(has_seeds ? *places[point] : *across.place[k]));
    // One that exploded lies far beyond; its note has the number.
    series.value.push_back(static_cast<float>(std::clamp(*value, extent.low, extent.high)));
    series.notes.push_back("run " + std::to_string(run.index) + ": " +
                           (run.label.empty() ? "" : run.label + ", ") + rough_text(*value));
  }
  render::Plot plot;
  plot.title = info.title;
  if (is_noise) plot.title += ": noise here";
  plot.unit = info.unit;
  plot.min = static_cast<float>(extent.low);
  plot.max = static_cast<float>(extent.high);
  plot.series = {whole, failed};
  if (has_seeds) add_whiskers(places, points, metric, is_noise, plot);
  plot.x_title = across.title;
  plot.x_unit.clear();
  plot.x_ticks = across.ticks;
  return plot;
}

}  // namespace

std::string metric_plots_svg(const store::Manifest& manifest,
                             const std::vector<store::RunResult>& results) {
  const std::vector<Across> columns = parameters_across(manifest);
  const std::vector<store::Point> points = store::points_of(manifest, results);
  const float row_height = top_room + panel_height + bottom_room;
  const float block_width = left_room + static_cast<float>(columns.size()) * (panel_width + gap);
  const int side_by_side = std::max(1, static_cast<int>(page_width / block_width));
  render::overlay::SvgCanvas canvas(font_size);
  int count = 0;
  for (std::size_t metric = 0; metric < store::metric_infos().size(); ++metric) {
    const std::optional<Extent> extent = extent_of(manifest, results, metric);
    if (!extent) continue;
    const float left = block_width * static_cast<float>(count % side_by_side) + left_room,
                top = row_height * static_cast<float>(count / side_by_side) + top_room;
    ++count;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const float x = left + static_cast<float>(c) * (panel_width + gap);
      const bool is_first = c == 0;
      render::overlay::draw_plot(plot_of(columns[c], results, manifest, points, metric, *extent),
                                 {x, x + panel_width, top, top + panel_height},
                                 {.has_title = is_first, .has_values = is_first}, canvas);
    }
  }
  if (count == 0) return {};
  return canvas.drawing(block_width * static_cast<float>(std::min(count, side_by_side)),
                        row_height * static_cast<float>((count + side_by_side - 1) / side_by_side),
                        true);
}

}  // namespace neve::app::sweep::sheet
