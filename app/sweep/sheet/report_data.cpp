#include "app/sweep/sheet/report_data.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "app/options/arguments.h"
#include "app/support/text.h"
#include "app/sweep/plan/labels.h"
#include "app/sweep/sheet/seals.h"
#include "app/sweep/sheet/star.h"
#include "app/sweep/store/points.h"
#include "app/sweep/store/promote.h"
#include "app/sweep/store/stars.h"

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

/// Returns the name of a quantity in columns and noise: no metric has such a name.
std::string full_name(predict::Quantity quantity) {
  return std::string("full_") + predict::info_of(quantity).name;
}

template <class Act>
void for_each_quantity(const Act& act) {
  for (int q = 0; q < predict::quantity_count; ++q) act(static_cast<predict::Quantity>(q));
}

void add_prediction_columns(Json& columns) {
  columns.push_back(column("prediction", "at full resolution", true, "full_verdict"));
  for_each_quantity([&](predict::Quantity quantity) {
    const predict::QuantityInfo& info = predict::info_of(quantity);
    columns.push_back(column("metric", plan::titled(std::string("full ") + info.title, info.unit),
                             false, full_name(quantity)));
  });
}

Json column_names(const store::Manifest& manifest, bool has_predictions,
                  const std::vector<std::size_t>& metrics) {
  Json columns = Json::array();
  columns.push_back(column("run", "run", false));
  if (has_labels(manifest)) columns.push_back(column("name", "name", true));
  for (const Parameter& p : manifest.parameters)
    columns.push_back(column(manifest.seeds > 1 && p.address == "seed" ? "seed" : "parameter",
                             plan::titled(p.name, p.unit),
                             p.type != "number" && p.type != "integer", p.address));
  columns.push_back(column("star", "star", true, "stars and notes of neve sweep star"));
  columns.push_back(column("state", "state", true));
  columns.push_back(column("warnings", "warnings", false, "hover over a cell for the text"));
  if (has_predictions) add_prediction_columns(columns);
  for (const std::size_t k : metrics) {
    const store::MetricInfo& metric = store::metric_infos()[k];
    columns.push_back(
        column("metric", plan::titled(metric.title, metric.unit), false, metric.name));
  }
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

void add_prediction_cells(const predict::Prediction& prediction, Json& cells) {
  cells.push_back(prediction.reason.empty() ? Json() : Json(predict::name(prediction.verdict)));
  for_each_quantity([&](predict::Quantity quantity) {
    cells.push_back(prediction.estimates.empty()
                        ? Json()
                        : Json(prediction.estimates[static_cast<std::size_t>(quantity)].expected));
  });
}

Json cells_of(const store::Manifest& manifest, const Run& run, const store::RunResult& result,
              const predict::Prediction* prediction, const std::vector<std::size_t>& metrics) {
  Json cells = Json::array();
  cells.push_back(run.index);
  if (has_labels(manifest)) cells.push_back(run.label);
  for (const Parameter& p : manifest.parameters) cells.push_back(cell_of(run.value(p.address)));
  cells.push_back(Json());  // the page fills it in
  cells.push_back(store::name(result.status.state));
  cells.push_back(result.warnings.size());
  if (prediction) add_prediction_cells(*prediction, cells);
  for (const std::size_t k : metrics) {
    const std::optional<double> value = store::told_metric(run, result, k);
    cells.push_back(value ? Json(*value) : Json());
  }
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
  return shell_path(folder + "/runs/" + run.folder + "/scene.toml");
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
  if (manifest.quality != setup::Quality::preview) options.quality = manifest.quality;
  return options::shell_line(options::words_of(options));
}

/// A branch has no scene of its own.
std::string promote_command(const std::string& folder, const store::Manifest& manifest,
                            const Run& run) {
  if (manifest.beginning) return "";
  store::PromoteOptions options;
  options.folder = folder;
  options.run = run.index;
  return options::shell_line(options::words_of(options));
}

/// A run of the sweep, and what else is known of its point.
struct Known {
  const std::vector<std::size_t>& metrics;          ///< that are listed
  const predict::Prediction* prediction = nullptr;  ///< of its point; null without
  const Run* full = nullptr;  ///< at full resolution, whose pictures are shown; null without
  std::optional<bool> full_broken{};  ///< what its snow did
};

Json row_of(const std::string& folder, const store::Manifest& manifest, const Run& run,
            const store::RunResult& result, const Known& known) {
  const predict::Prediction* prediction = known.prediction;
  const Run& shown = known.full ? *known.full : run;
  const std::optional<bool> broken = known.full ? known.full_broken : result.has_broken;
  const std::string pictures = "runs/" + shown.folder + "/" + manifest.view + "/";
  return {{"run", run.index},
          {"key", run.key},
          {"settings", store::settings_json(store::telling_settings(manifest, run))},
          {"label", run.label},
          {"state", store::name(result.status.state)},
          {"failed", store::has_failed(result.status.state)},
          {"reason", result.status.reason},
          {"warnings", result.warnings},
          {"broken", broken ? Json(*broken) : Json()},
          {"levels", run.coordinates},
          {"frames", ranges_of(result.frames)},
          {"pictures", pictures},
          {"view", manifest.beginning ? "" : "neve view " + scene_word(folder, shown)},
          // Digits need no quotes either: the page puts the name of the frame in.
          {"viewFrame", "neve view " + shell_path(folder + "/" + pictures + "FRAME.png")},
          {"again", again_command(folder, manifest, shown)},
          {"promote", promote_command(folder, manifest, run)},
          {"texts", written_values(manifest, run)},
          {"full", known.full != nullptr},
          {"why", prediction ? prediction->reason : ""},
          {"cells", cells_of(manifest, run, result, prediction, known.metrics)}};
}

/// Lists the axes of a grid or a screening, whose runs have a level on each.
Json axes_of(const store::Manifest& manifest) {
  Json axes = Json::array();
  for (const std::vector<store::AxisLabels>* list : {&manifest.axes, &manifest.screened})
    for (const store::AxisLabels& axis : *list)
      axes.push_back({{"name", axis.name}, {"values", axis.values}, {"addresses", axis.addresses}});
  return axes;
}

/// A metric at each point, with its noise or interval: what the page compares, it does not compute.
/// If noise is not known there are no groups, and ranks are those of the means alone.
Json noise_of(const std::string& metric, store::Verdict verdict,
              const std::vector<store::Summary>& summaries) {
  const bool is_known = verdict != store::Verdict::unknown;
  const std::vector<int> ranks =
      is_known ? store::shared_ranks(summaries) : store::ranks_of_means(summaries);
  const std::vector<double> shared = store::shared_means(summaries, ranks);
  const std::vector<std::vector<int>> groups =
      is_known ? store::close_groups(summaries) : std::vector<std::vector<int>>(summaries.size());
  Json list = Json::array();
  for (std::size_t k = 0; k < summaries.size(); ++k) {
    const store::Summary& s = summaries[k];
    list.push_back(s.count == 0
                       ? Json()
                       : Json{{"mean", s.mean},
                              {"min", s.min},
                              {"max", s.max},
                              {"rank", ranks[k]},
                              {"shared", shared[k]},
                              {"groups", groups[k]},
                              {"letters", is_known ? store::group_letters(groups[k]) : ""}});
  }
  return {{"metric", metric},
          {"noise", verdict == store::Verdict::noise},
          {"known", is_known},
          {"points", list}};
}

/// The verdict at full resolution, with what the runs of the point did.
Json outcome_of(const predict::Prediction& prediction, const store::Point& point) {
  return {{"text", predicted_outcome(prediction, point)},
          {"undecided", predict::is_in_doubt(prediction)}};
}

void add_noise(const store::Manifest& manifest, const std::vector<store::RunResult>& results,
               const std::vector<predict::Prediction>& predictions, Json& data) {
  data["seeds"] = manifest.seeds;
  data["predicts"] = !predictions.empty();
  if (manifest.seeds == 1 && predictions.empty()) return;
  const std::vector<store::Point> points = store::points_of(manifest, results);
  data["outcomes"] = Json::array();
  for (std::size_t k = 0; k < points.size(); ++k)
    data["outcomes"].push_back(predictions.empty()
                                   ? Json{{"text", store::outcome_text(points[k])},
                                          {"undecided", store::is_undecided(points[k])}}
                                   : outcome_of(predictions[k], points[k]));
  data["groupColours"] = group_colours;
  data["noise"] = Json::array();
  for (const std::size_t metric :
       manifest.seeds > 1 ? store::listed_metrics(results) : std::vector<std::size_t>{})
    data["noise"].push_back(noise_of(store::metric_infos()[metric].name,
                                     store::verdict_of(manifest, points, metric),
                                     store::summaries_of(points, metric)));
  if (predictions.empty()) return;
  for_each_quantity([&](predict::Quantity quantity) {
    data["noise"].push_back(noise_of(full_name(quantity), store::Verdict::real,
                                     store::summaries_of(predictions, quantity)));
  });
}

/// Tiles side by side, as sheet.png has them where its axes are along its edges; 0: as many as fit.
std::size_t columns_of_sheet(const store::Manifest& manifest) {
  if (manifest.wrap > 0) return static_cast<std::size_t>(manifest.wrap);
  return manifest.axes.size() < 2 ? 0 : manifest.axes.back().values.size();
}

}  // namespace

Json report_data(const std::string& folder, const store::Manifest& manifest,
                 const std::vector<store::RunResult>& results,
                 const std::vector<predict::Prediction>& predictions) {
  Json data;
  data["fps"] = manifest.fps;
  data["firstNumber"] = manifest.first_number;
  StarOptions star;
  star.folder = folder;
  data["star"] = options::shell_line(options::words_of(star));
  data["tile"] = {manifest.tile_width, manifest.tile_height};
  data["across"] = columns_of_sheet(manifest);
  data["axes"] = axes_of(manifest);
  const std::vector<std::size_t> metrics = store::listed_metrics(results);
  data["columns"] = column_names(manifest, !predictions.empty(), metrics);
  add_noise(manifest, results, predictions, data);
  data["rows"] = Json::array();
  const std::vector<std::optional<store::RunResult>> full = store::full_results(folder, manifest);
  const auto seeds = static_cast<std::size_t>(manifest.seeds);
  for (std::size_t k = 0; k < manifest.runs.size(); ++k) {
    Known known{metrics};
    if (!predictions.empty()) known.prediction = &predictions[k / seeds];
    // Each seed has a run at full resolution of its own.
    for (const store::Variant& variant : manifest.variants) {
      if (!variant.is_full() || variant.of != k || !full[k]) continue;
      known.full = &variant.run;
      known.full_broken = full[k]->has_broken;
    }
    const Run& run = manifest.runs[k];
    data["rows"].push_back(row_of(folder, manifest, run, results[k], known));
    if (manifest.fps_of(run) != manifest.fps) data["rows"].back()["fps"] = manifest.fps_of(run);
  }
  return data;
}

}  // namespace neve::app::sweep::sheet
