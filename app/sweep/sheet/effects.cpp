#include "app/sweep/sheet/effects.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "app/support/text.h"
#include "app/sweep/plan/designs.h"
#include "app/sweep/plan/labels.h"
#include "app/sweep/store/points.h"
#include "render/overlay/svg.h"

namespace neve::app::sweep::sheet {

namespace {

using render::overlay::svg_number, render::overlay::svg_text;

/// The axis and the signed share of its range of the step between two runs; axis -1: there is none.
struct Step {
  int axis = -1;
  double share = 0;
};

/// Choices have no order, so that nothing rises with them.
bool is_ordered(const store::Manifest& manifest, const store::AxisLabels& axis) {
  return std::all_of(
      manifest.parameters.begin(), manifest.parameters.end(), [&](const Parameter& parameter) {
        const bool is_of_axis = std::find(axis.addresses.begin(), axis.addresses.end(),
                                          parameter.address) != axis.addresses.end();
        return !is_of_axis || parameter.type == "number" || parameter.type == "integer";
      });
}

/// The share of the range of an axis between two levels; of a choice, which has no range, the whole
/// of it with each step.
double share_between(const store::Manifest& manifest, const store::AxisLabels& axis, int from,
                     int to) {
  const auto count = static_cast<int>(axis.shares.size());
  const auto share = [&](int level) {
    return level >= 0 && level < count ? axis.shares[static_cast<std::size_t>(level)]
                                       : level / (plan::morris_levels - 1.0);
  };
  const double way = share(to) - share(from);
  return is_ordered(manifest, axis) || way == 0 ? way : std::copysign(1, way);
}

Step step_between(const store::Manifest& manifest, const Run& a, const Run& b) {
  Step step;
  for (std::size_t k = 0; k < a.coordinates.size(); ++k) {
    if (a.coordinates[k] == b.coordinates[k]) continue;
    if (step.axis >= 0) return {};
    step = {static_cast<int>(k),
            share_between(manifest, manifest.screened[k], a.coordinates[k], b.coordinates[k])};
  }
  return step;
}

Effect effect_of(const std::vector<double>& changes) {
  Effect effect;
  effect.steps = static_cast<int>(changes.size());
  if (changes.empty()) return effect;
  const auto count = static_cast<double>(changes.size());
  for (const double x : changes) {
    effect.mean += x / count;
    effect.strength += std::abs(x) / count;
  }
  for (const double x : changes) effect.spread += (x - effect.mean) * (x - effect.mean);
  effect.spread = changes.size() > 1 ? std::sqrt(effect.spread / (count - 1)) : 0;
  return effect;
}

/// All metrics but those that differ from machine to machine and those that nothing changes.
struct Column {
  std::size_t metric = 0;
  std::vector<Effect> effects;
  double strongest = 0;
};

std::vector<Column> columns_of(const store::Manifest& manifest,
                               const std::vector<store::RunResult>& results) {
  std::vector<Column> columns;
  for (std::size_t metric = 0; metric < store::metric_infos().size(); ++metric) {
    if (store::metric_infos()[metric].is_time) continue;
    Column column{metric, effects_on(manifest, results, metric), 0};
    for (const Effect& e : column.effects)
      column.strongest = std::max(column.strongest, e.strength);
    if (column.strongest > 0) columns.push_back(std::move(column));
  }
  return columns;
}

/// Axes by the sum of their shares of the strongest effects.
std::vector<std::size_t> strongest_first(const std::vector<Column>& columns, std::size_t axes) {
  std::vector<double> share(axes, 0);
  for (const Column& column : columns)
    for (std::size_t a = 0; a < axes; ++a)
      if (!column.effects[a].is_noise) share[a] += column.effects[a].strength / column.strongest;
  std::vector<std::size_t> order(axes);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return share[a] > share[b]; });
  return order;
}

/// An effect of an axis, with its sign where it always has the same.
struct Shown {
  const Effect& effect;
  bool is_signed;

  Shown(const Effect& e, bool is_ordered_axis)
      : effect(e), is_signed(is_ordered_axis && e.is_one_way()) {}
  const char* way() const {
    if (effect.is_noise) return "noise";
    if (!is_signed) return "both";
    return effect.mean > 0 ? "rises" : "falls";
  }
  std::string text() const {
    if (effect.is_noise) return "within noise";
    if (is_signed) return rough_text(effect.mean);
    return effect.strength > 0 ? "\u00b1" + rough_text(effect.strength) : "0";
  }
};

constexpr double row_height = 30, bar_height = 14, column_width = 106, bar_room = 76, head = 56,
                 foot = 80, name_per_letter = 7.2;

constexpr const char* bar_style = R"(<style>
text { font-family: "DejaVu Sans", Verdana, sans-serif; fill: #55606e; font-size: 11px }
.name { font-size: 12px; fill: #20262e } .head { fill: #20262e } .rule { stroke: #e2e7ec; stroke-width: 1 }
.rises { fill: #2b6cb0 } .falls { fill: #d9561e } .both { fill: #8a94a0 }
.noise { fill: #dde2e8 }
.spread { stroke: #20262e; stroke-width: 1.4 }
</style>
)";

/// A bar as long as the effect is strong, and its standard deviation as a line about its end.
std::string bar(const Shown& shown, double strongest, double x, double y) {
  const Effect& effect = shown.effect;
  const auto length = [&](double value) {
    return bar_room * std::clamp(value / strongest, 0.0, 1.2);
  };
  const double end = x + length(effect.strength), middle = y + bar_height / 2;
  std::string svg = "<rect x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" width=\"" +
                    svg_number(std::max(1.0, end - x)) + "\" height=\"" + svg_number(bar_height) +
                    "\" class=\"" + shown.way() + "\"><title>" + std::to_string(effect.steps) +
                    " steps: mean " + rough_text(effect.mean) + ", of the sizes " +
                    rough_text(effect.strength) + ", standard deviation " +
                    rough_text(effect.spread) + "</title></rect>\n";
  svg += "<line x1=\"" + svg_number(x + length(effect.strength - effect.spread)) + "\" y1=\"" +
         svg_number(middle) + "\" x2=\"" + svg_number(x + length(effect.strength + effect.spread)) +
         "\" y2=\"" + svg_number(middle) + "\" class=\"spread\"/>\n";
  return svg + svg_text(x, y + bar_height + 10, "start", "", shown.text());
}

std::string bar_legend(double y, bool has_noise) {
  std::string svg;
  double x = 12;
  std::vector<std::pair<const char*, const char*>> kinds{
      {"rises", "the metric rises with the parameter"},
      {"falls", "it falls"},
      {"both", "it does both, or the parameter is a choice"}};
  if (has_noise) kinds.emplace_back("noise", "within noise: another seed changes as much");
  for (const auto& [kind, words] : kinds) {
    svg += "<rect x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) +
           "\" width=\"12\" height=\"12\" class=\"" + std::string(kind) + "\"/>\n" +
           svg_text(x + 17, y + 10, "start", "", words);
    x += 32 + 6.6 * static_cast<double>(std::string_view(words).size());
  }
  svg += svg_text(12, y + 30, "start", "",
                  "Bar and number: mean change for the whole range of the parameter, from the "
                  "smaller to the larger end of a list, or from one choice to another.");
  return svg + svg_text(12, y + 46, "start", "",
                        "Line: its standard deviation; a long one means that it depends on the "
                        "others.");
}

}  // namespace

std::vector<Effect> effects_on(const store::Manifest& manifest,
                               const std::vector<store::RunResult>& results, std::size_t metric) {
  const std::size_t axes = manifest.screened.size();
  if (axes == 0) return {};
  std::vector<std::vector<double>> changes(axes);
  std::vector<std::vector<std::pair<store::Summary, store::Summary>>> steps(axes);
  const std::vector<store::Point> points = store::points_of(manifest, results);
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const Run &a = manifest.runs[points[k].first], &b = manifest.runs[points[k + 1].first];
    const bool is_last_of_trajectory = k % (axes + 1) == axes;
    if (is_last_of_trajectory || a.coordinates.size() != axes || b.coordinates.size() != axes)
      continue;
    const store::Summary &before = points[k].metrics[metric],
                         &after = points[k + 1].metrics[metric];
    if (before.count == 0 || after.count == 0) continue;
    const Step step = step_between(manifest, a, b);
    // Two levels may be the same value, of few whole numbers or of a list of one.
    if (step.axis < 0 || step.share == 0) continue;
    const auto axis = static_cast<std::size_t>(step.axis);
    changes[axis].push_back((after.mean - before.mean) / step.share);
    steps[axis].emplace_back(before, after);
  }
  std::vector<Effect> effects;
  for (std::size_t a = 0; a < axes; ++a) {
    effects.push_back(effect_of(changes[a]));
    if (manifest.seeds == 1) continue;
    const store::Verdict verdict = store::change(steps[a]);
    effects.back().is_noise = verdict == store::Verdict::noise;
    effects.back().is_unknown = verdict == store::Verdict::unknown;
  }
  return effects;
}

std::string effects_csv(const store::Manifest& manifest,
                        const std::vector<store::RunResult>& results) {
  if (manifest.screened.empty()) return {};
  const bool has_noise = manifest.seeds > 1;
  std::string csv = "metric,unit,parameter,steps,mean,mean_of_sizes,standard_deviation";
  csv += has_noise ? ",within_noise\n" : "\n";
  for (const std::size_t metric : store::listed_metrics(results)) {
    const store::MetricInfo& info = store::metric_infos()[metric];
    const std::vector<Effect> effects = effects_on(manifest, results, metric);
    for (std::size_t a = 0; a < effects.size(); ++a)
      csv += fmt::format("{},{},\"{}\",{},{:.6g},{:.6g},{:.6g}{}\n", info.name, info.unit,
                         joined(manifest.screened[a].addresses, " "), effects[a].steps,
                         effects[a].mean, effects[a].strength, effects[a].spread,
                         !has_noise              ? ""
                         : effects[a].is_unknown ? ","
                         : effects[a].is_noise   ? ",1"
                                                 : ",0");
  }
  return csv;
}

std::string effects_svg(const store::Manifest& manifest,
                        const std::vector<store::RunResult>& results, bool is_document) {
  const std::vector<Column> columns = columns_of(manifest, results);
  if (columns.empty()) return {};
  const std::size_t axes = manifest.screened.size();
  double names = 0;
  for (const store::AxisLabels& axis : manifest.screened)
    names = std::max(names, name_per_letter * static_cast<double>(axis.name.size()));
  const double left = names + 28;
  std::string body;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const double x = left + static_cast<double>(c) * column_width;
    const store::MetricInfo& info = store::metric_infos()[columns[c].metric];
    body += svg_text(x, head - 30, "start", " class=\"head\"", info.title);
    if (info.unit[0]) body += svg_text(x, head - 16, "start", "", info.unit);
  }
  double y = head;
  for (const std::size_t a : strongest_first(columns, axes)) {
    body += svg_text(12, y + bar_height - 3, "start", " class=\"name\"", manifest.screened[a].name);
    const bool is_of_numbers = is_ordered(manifest, manifest.screened[a]);
    for (std::size_t c = 0; c < columns.size(); ++c)
      body += bar({columns[c].effects[a], is_of_numbers}, columns[c].strongest,
                  left + static_cast<double>(c) * column_width, y);
    y += row_height;
    body += "<line x1=\"12\" x2=\"" +
            svg_number(left + static_cast<double>(columns.size()) * column_width) + "\" y1=\"" +
            svg_number(y - 3) + "\" y2=\"" + svg_number(y - 3) + "\" class=\"rule\"/>\n";
  }
  body += bar_legend(y + 14, manifest.seeds > 1);
  const double width = std::max(left + static_cast<double>(columns.size()) * column_width, 940.0);
  return render::overlay::svg_drawing(width, y + foot, is_document ? "#ffffff" : "",
                                      bar_style + body, is_document);
}

std::vector<std::string> effect_lines(const store::Manifest& manifest,
                                      const std::vector<store::RunResult>& results) {
  std::vector<std::string> lines;
  for (const Column& column : columns_of(manifest, results)) {
    std::vector<std::size_t> order(column.effects.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const Effect &x = column.effects[a], &y = column.effects[b];
      return x.is_noise != y.is_noise ? y.is_noise : x.strength > y.strength;
    });
    const auto part = [&](std::size_t a) {
      const store::AxisLabels& axis = manifest.screened[a];
      return axis.name + " " + Shown(column.effects[a], is_ordered(manifest, axis)).text();
    };
    const auto is_told = [&](std::size_t place) {
      return order.size() > place && !column.effects[order[place]].is_noise &&
             column.effects[order[place]].strength > 0;
    };
    const store::MetricInfo& info = store::metric_infos()[column.metric];
    std::string line = plan::titled(info.title, info.unit) + ": ";
    line += is_told(0) ? part(order[0]) : "all effects are within noise";
    if (is_told(1)) line += ", then " + part(order[1]);
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace neve::app::sweep::sheet
