#include "app/sweep/sheet/report_data.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "app/options/arguments.h"
#include "app/support/text.h"
#include "app/sweep/sheet/seals.h"
#include "app/sweep/store/points.h"

namespace neve::app::sweep::sheet {

namespace {

/// A number where it is one, so that it sorts as one.
Json cell_of(const std::string& value) {
  if (const std::optional<double> x = number_of(value)) return *x;
  return value.empty() ? Json() : Json(plan::value_text(value));
}

Json column(const char* kind, const std::string& title, bool is_text,
            const std::string& help = {}) {
  return {{"kind", kind}, {"title", title}, {"text", is_text}, {"help", help}};
}

bool has_labels(const store::Manifest& manifest) {
  return std::any_of(manifest.runs.begin(), manifest.runs.end(),
                     [](const Run& run) { return !run.label.empty(); });
}

Json column_names(const store::Manifest& manifest) {
  Json columns = Json::array();
  columns.push_back(column("run", "run", false));
  if (has_labels(manifest)) columns.push_back(column("name", "name", true));
  for (const Parameter& p : manifest.parameters)
    columns.push_back(column(manifest.seeds > 1 && p.address == "seed" ? "seed" : "parameter",
                             p.name + (p.unit.empty() ? "" : " (" + p.unit + ")"),
                             p.type != "number" && p.type != "integer", p.address));
  columns.push_back(column("state", "state", true));
  columns.push_back(column("warnings", "warnings", false, "hover over a cell for the text"));
  for (const store::MetricInfo& metric : store::metric_infos())
    columns.push_back(column(
        "metric",
        std::string(metric.title) + (metric.unit[0] ? std::string(" (") + metric.unit + ")" : ""),
        false, metric.name));
  columns.push_back(column("reason", "reason", true));
  return columns;
}

/// Parameters that are numbers, as the user wrote them, by column: only results are rounded.
Json written_values(const store::Manifest& manifest, const Run& run) {
  Json texts = Json::object();
  std::size_t c = has_labels(manifest) ? 2 : 1;
  for (const Parameter& p : manifest.parameters) {
    const std::string value = run.value(p.address);
    if (cell_of(value).is_number()) texts[std::to_string(c)] = value;
    ++c;
  }
  return texts;
}

Json cells_of(const store::Manifest& manifest, const Run& run, const store::RunResult& result) {
  Json cells = Json::array();
  cells.push_back(run.index);
  if (has_labels(manifest)) cells.push_back(run.label);
  for (const Parameter& p : manifest.parameters) cells.push_back(cell_of(run.value(p.address)));
  cells.push_back(store::name(result.status.state));
  cells.push_back(result.warnings.size());
  for (const std::optional<double>& value : result.metrics)
    cells.push_back(value ? Json(*value) : Json());
  cells.push_back(result.status.reason);
  return cells;
}

/// [[0, 24], [30, 31]]
Json ranges_of(const std::vector<int>& numbers) {
  Json ranges = Json::array();
  for (const int n : numbers) {
    if (!ranges.empty() && ranges.back()[1] == n - 1)
      ranges.back()[1] = n;
    else
      ranges.push_back({n, n});
  }
  return ranges;
}

std::string scene_word(const std::string& folder, const Run& run) {
  return options::shell_path(folder + "/runs/" + run.folder + "/scene.toml");
}

/// A branch is made again from the beginning that it has in common with others: its own scene file
/// has the values of that beginning.
std::string again_command(const std::string& folder, const store::Manifest& manifest,
                          const Run& run) {
  run::RenderOptions options;
  options.scene = folder + "/runs/" + run.folder + "/scene.toml";
  if (manifest.beginning) options = manifest.beginning->fork_of(run, folder);
  options.frames = run.frames;
  options.out = "again/" + run.folder;
  return options::shell_line(options::words_of(options));
}

Json row_of(const std::string& folder, const store::Manifest& manifest, const Run& run,
            const store::RunResult& result) {
  const std::string pictures = "runs/" + run.folder + "/" + manifest.view + "/";
  return {{"run", run.index},
          {"label", run.label},
          {"state", store::name(result.status.state)},
          {"failed", store::has_failed(result.status.state)},
          {"reason", result.status.reason},
          {"warnings", result.warnings},
          {"broken", result.has_broken ? Json(*result.has_broken) : Json()},
          {"levels", run.coordinates},
          {"frames", ranges_of(result.frames)},
          {"pictures", pictures},
          {"view", manifest.beginning ? "" : "neve view " + scene_word(folder, run)},
          // Digits need no quotes either: the page puts the name of the frame in.
          {"viewFrame", "neve view " + options::shell_path(folder + "/" + pictures + "FRAME.png")},
          {"again", again_command(folder, manifest, run)},
          {"texts", written_values(manifest, run)},
          {"cells", cells_of(manifest, run, result)}};
}

/// Of a grid or a screening, whose runs have a level on each.
Json axes_of(const store::Manifest& manifest) {
  Json axes = Json::array();
  for (const std::vector<store::AxisLabels>* list : {&manifest.axes, &manifest.screened})
    for (const store::AxisLabels& axis : *list)
      axes.push_back({{"name", axis.name}, {"values", axis.values}, {"addresses", axis.addresses}});
  return axes;
}

/// A metric at each point, with the noise of its runs: what the page compares, it does not compute.
Json noise_of(const store::Manifest& manifest, const std::vector<store::Point>& points,
              std::size_t metric) {
  const std::vector<store::Summary> summaries = store::summaries_of(points, metric);
  const std::vector<int> ranks = store::shared_ranks(summaries);
  const std::vector<double> shared = store::shared_means(summaries, ranks);
  const std::vector<std::vector<int>> groups = store::close_groups(summaries);
  Json list = Json::array();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const store::Summary& s = summaries[k];
    list.push_back(s.count == 0 ? Json()
                                : Json{{"mean", s.mean},
                                       {"min", s.min},
                                       {"max", s.max},
                                       {"rank", ranks[k]},
                                       {"shared", shared[k]},
                                       {"groups", groups[k]},
                                       {"letters", store::group_letters(groups[k])}});
  }
  return {{"metric", store::metric_infos()[metric].name},
          {"noise", store::is_noise(manifest, points, metric)},
          {"points", list}};
}

void add_noise(const store::Manifest& manifest, const std::vector<store::RunResult>& results,
               Json& data) {
  data["seeds"] = manifest.seeds;
  if (manifest.seeds == 1) return;
  const std::vector<store::Point> points = store::points_of(manifest, results);
  data["outcomes"] = Json::array();
  for (const store::Point& point : points)
    data["outcomes"].push_back(
        {{"text", store::outcome_text(point)}, {"undecided", store::is_undecided(point)}});
  data["groupColours"] = group_colours;
  data["noise"] = Json::array();
  for (std::size_t metric = 0; metric < store::metric_infos().size(); ++metric)
    data["noise"].push_back(noise_of(manifest, points, metric));
}

/// Tiles side by side, as sheet.png has them where its axes are along its edges; 0: as many as fit.
std::size_t columns_of_sheet(const store::Manifest& manifest) {
  if (manifest.wrap > 0) return static_cast<std::size_t>(manifest.wrap);
  return manifest.axes.size() < 2 ? 0 : manifest.axes.back().values.size();
}

}  // namespace

Json report_data(const std::string& folder, const store::Manifest& manifest,
                 const std::vector<store::RunResult>& results) {
  Json data;
  data["fps"] = manifest.fps;
  data["tile"] = {manifest.tile_width, manifest.tile_height};
  data["across"] = columns_of_sheet(manifest);
  data["axes"] = axes_of(manifest);
  data["columns"] = column_names(manifest);
  add_noise(manifest, results, data);
  data["rows"] = Json::array();
  for (std::size_t k = 0; k < manifest.runs.size(); ++k)
    data["rows"].push_back(row_of(folder, manifest, manifest.runs[k], results[k]));
  return data;
}

}  // namespace neve::app::sweep::sheet
