#include "app/sweep/sheet/metric_plots.h"

#include <algorithm>
#include <cmath>

#include "app/support/text.h"
#include "app/sweep/sheet/svg_text.h"
#include "render/overlay/ticks.h"

namespace neve::app::sweep::sheet {

namespace {

constexpr double panel_width = 210, panel_height = 120, left_room = 62, top_room = 30,
                 bottom_room = 34, gap = 16, page_width = 1420;

/// Positions of the runs along one parameter.
struct Across {
  std::string title;
  std::vector<std::optional<double>> place;           ///< 0 to 1, of each run
  std::vector<std::pair<double, std::string>> ticks;  ///< place and text
};

Across by_run(const store::Manifest& manifest) {
  Across across;
  across.title = "run";
  const auto count = manifest.runs.size();
  for (std::size_t k = 0; k < count; ++k) {
    const double at = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    across.place.emplace_back(at);
    if (count <= 12 || k % (count / 6) == 0)
      across.ticks.emplace_back(at, std::to_string(manifest.runs[k].index));
  }
  return across;
}

Across by_choice(const store::Manifest& manifest, const Parameter& parameter) {
  Across across;
  across.title = parameter.name;
  std::vector<std::string> values;
  for (const Run& run : manifest.runs) {
    const std::string value = run.value(parameter.address);
    if (!value.empty() && std::find(values.begin(), values.end(), value) == values.end())
      values.push_back(value);
  }
  const auto place = [&](std::size_t k) {
    return (static_cast<double>(k) + 0.5) / static_cast<double>(values.size());
  };
  for (const Run& run : manifest.runs) {
    const auto found = std::find(values.begin(), values.end(), run.value(parameter.address));
    across.place.push_back(
        found == values.end()
            ? std::nullopt
            : std::optional(place(static_cast<std::size_t>(found - values.begin()))));
  }
  for (std::size_t k = 0; k < values.size() && values.size() <= 8; ++k)
    across.ticks.emplace_back(place(k), plan::value_text(values[k]));
  return across;
}

/// Logarithmic where the values are positive and go over more than a factor of 20.
Across by_number(const Parameter& parameter, const std::vector<std::optional<double>>& values) {
  Across across;
  across.title = parameter.name + (parameter.unit.empty() ? "" : " (" + parameter.unit + ")");
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
      across.ticks.emplace_back(place(x), plan::value_text(scene::toml::number_text(x)));
  } else if (is_logarithmic) {
    across.ticks = {{place(low), plan::value_text(scene::toml::number_text(low))},
                    {place(high), plan::value_text(scene::toml::number_text(high))}};
  } else {
    for (const render::overlay::Tick& tick : render::overlay::nice_ticks(low, high, 4))
      across.ticks.emplace_back(place(tick.value), tick.label);
  }
  return across;
}

std::vector<Across> parameters_across(const store::Manifest& manifest) {
  std::vector<Across> columns;
  for (const Parameter& parameter : manifest.parameters) {
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

std::string svg_panel(const Across& across, const std::vector<store::RunResult>& results,
                      const store::Manifest& manifest, std::size_t metric, const Extent& extent,
                      double x0, double y0, bool is_first) {
  const auto y_of = [&](double value) {
    return y0 + panel_height * (1 - (value - extent.low) / (extent.high - extent.low));
  };
  std::string svg = "<rect x=\"" + svg_number(x0) + "\" y=\"" + svg_number(y0) + "\" width=\"" +
                    svg_number(panel_width) + "\" height=\"" + svg_number(panel_height) +
                    "\" class=\"panel\"/>\n";
  for (const render::overlay::Tick& tick :
       render::overlay::nice_ticks(extent.low, extent.high, 4)) {
    const double y = y_of(tick.value);
    svg += "<line x1=\"" + svg_number(x0) + "\" y1=\"" + svg_number(y) + "\" x2=\"" +
           svg_number(x0 + panel_width) + "\" y2=\"" + svg_number(y) + "\" class=\"grid\"/>\n";
    if (is_first) svg += svg_text(x0 - 6, y + 3.5, "end", "tick", tick.label);
  }
  for (const auto& [place, label] : across.ticks)
    svg += svg_text(x0 + place * panel_width, y0 + panel_height + 14, "middle", "tick", label);
  for (std::size_t k = 0; k < results.size(); ++k) {
    const std::optional<double>& value = results[k].metrics[metric];
    if (!value || !across.place[k]) continue;
    const bool is_ok = results[k].status.state == store::RunState::ok;
    // One that exploded lies far beyond; its tooltip has the number.
    const double inside = std::clamp(*value, extent.low, extent.high);
    svg += "<circle cx=\"" + svg_number(x0 + *across.place[k] * panel_width) + "\" cy=\"" +
           svg_number(y_of(inside)) + "\" r=\"" + (is_ok ? "3.2" : "3.6") + "\" class=\"" +
           (is_ok ? "run" : "run failed") + "\" data-run=\"" +
           std::to_string(manifest.runs[k].index) + "\"><title>run " +
           std::to_string(manifest.runs[k].index) + ": " +
           xml_text(manifest.runs[k].label.empty()
                        ? rough_text(*value)
                        : manifest.runs[k].label + ", " + rough_text(*value)) +
           "</title></circle>\n";
  }
  return svg;
}

constexpr const char* plot_style = R"(<style>
text { font-family: "DejaVu Sans", Verdana, sans-serif; fill: #55606e }
.tick { font-size: 10px } .name { font-size: 12px; fill: #20262e }
.panel { fill: #f5f7f9 } .grid { stroke: #d8dee5; stroke-width: 1 }
.run { fill: #2b6cb0; fill-opacity: 0.85 }
.run.failed { fill: none; stroke: #d9561e; stroke-width: 1.6 }
</style>
)";

}  // namespace

std::string metric_plots_svg(const store::Manifest& manifest,
                             const std::vector<store::RunResult>& results, bool is_document) {
  const std::vector<Across> columns = parameters_across(manifest);
  const double row_height = top_room + panel_height + bottom_room;
  const double block_width = left_room + static_cast<double>(columns.size()) * (panel_width + gap);
  const int side_by_side = std::max(1, static_cast<int>(page_width / block_width));
  std::string body;
  int count = 0;
  for (std::size_t metric = 0; metric < store::metric_infos().size(); ++metric) {
    const std::optional<Extent> extent = extent_of(manifest, results, metric);
    if (!extent) continue;
    const store::MetricInfo& info = store::metric_infos()[metric];
    const std::string unit = info.unit[0] ? std::string(" (") + info.unit + ")" : "";
    const double left = block_width * (count % side_by_side) + left_room;
    const double y = row_height * (count / side_by_side);
    ++count;
    body += svg_text(left, y + top_room - 10, "start", "name", info.title + unit);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double x = left + static_cast<double>(c) * (panel_width + gap);
      body += svg_panel(columns[c], results, manifest, metric, *extent, x, y + top_room, c == 0);
      body += svg_text(x + panel_width / 2, y + top_room + panel_height + 28, "middle", "tick",
                       columns[c].title);
    }
  }
  if (body.empty()) return {};
  const double width = block_width * std::min(count, side_by_side);
  const double height = row_height * ((count + side_by_side - 1) / side_by_side);
  const std::string head = is_document ? "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" : "";
  return head + "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + svg_number(width) +
         "\" height=\"" + svg_number(height) + "\" viewBox=\"0 0 " + svg_number(width) + " " +
         svg_number(height) + "\">\n" + plot_style +
         (is_document ? "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" : "") + body +
         "</svg>\n";
}

}  // namespace neve::app::sweep::sheet
