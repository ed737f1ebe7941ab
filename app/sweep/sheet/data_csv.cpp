#include "app/sweep/sheet/data_csv.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <set>

#include "app/output/sequence.h"
#include "app/support/text.h"
#include "app/sweep/store/points.h"

namespace neve::app::sweep::sheet {

namespace {

/// RFC 4180.
std::string quoted(const std::string& text) {
  if (text.find_first_of("\",\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

std::string float_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  std::string result = text;
  if (result.find_first_of(".eE") == std::string::npos) result += ".0";
  return result;
}

std::string whole_text(double x) {
  return std::to_string(std::llround(x));
}

std::optional<double> trimmed_number(std::string text) {
  std::erase(text, ' ');
  if (text.starts_with("+")) text.erase(0, 1);
  const std::optional<double> x = number_of(text);
  return x && std::isfinite(*x) ? x : std::nullopt;
}

/// Readers of the table take it for a number, not-a-number and infinities included.
bool looks_like_number(const std::string& text) {
  double x = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), x);
  return !text.empty() && result.ec != std::errc::invalid_argument &&
         result.ptr == text.data() + text.size();
}

/// Spreadsheets would evaluate it.
bool looks_like_formula(const std::string& text) {
  return text.find_first_of("=@+-\t\r") == 0;
}

/// "[0, -5, 0]": its three numbers, or none.
std::vector<std::string> components(const std::string& value) {
  std::vector<std::string> parts(1);
  for (const char c : value) {
    if (c == '[' || c == ']' || c == ' ') continue;
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts.size() == 3 ? parts : std::vector<std::string>(3);
}

/// "material.snow.hardening" -> "material_snow_hardening"; no column but those of files may begin
/// with FILE.
std::string column_name(const std::string& address) {
  std::string name = address;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name.starts_with("FILE") ? "_" + name : name;
}

/// A string that looks like a number would give its column another type.
std::string text_cell(const std::string& text) {
  const bool is_quoted = looks_like_number(text) || text.empty() || looks_like_formula(text);
  return is_quoted ? "'" + text + "'" : text;
}

/// TOML text as a cell of a column of this type.
std::string cell(const std::string& value, const std::string& type) {
  if (value.empty()) return "";
  if (type == "number" || type == "integer") {
    const std::optional<double> x = trimmed_number(value);
    if (!x) return "";
    return type == "number" ? float_text(*x) : whole_text(*x);
  }
  return text_cell(plan::value_text(value));
}

/// Unique names of columns.
class ColumnNames {
 public:
  /// @param suffix  follows a name that is taken
  std::string unique(std::string name, const std::string& suffix) {
    while (!taken_.insert(name).second) name += suffix;
    return name;
  }

 private:
  std::set<std::string> taken_;
};

class Rows {
 public:
  void add(const std::string& text) {
    line_ += (is_first_ ? "" : ",") + quoted(text);
    is_first_ = false;
  }
  void end() {
    text_ += line_ + "\n";
    line_.clear();
    is_first_ = true;
  }
  std::string text() const { return text_; }

 private:
  std::string text_, line_;
  bool is_first_ = true;
};

void add_parameter_names(const store::Manifest& manifest, ColumnNames& names, Rows& rows) {
  for (const Parameter& parameter : manifest.parameters) {
    const std::string name = column_name(parameter.address);
    if (parameter.type != "vector") {
      rows.add(names.unique(name, "_set"));
      continue;
    }
    for (const char* axis : {"_x", "_y", "_z"}) rows.add(names.unique(name + axis, "_set"));
  }
}

constexpr std::array interval_columns{"", "_low", "_high"};

void add_prediction_names(bool has_seeds, ColumnNames& names, Rows& rows) {
  rows.add(names.unique("full_by", "_done"));
  if (has_seeds)
    for (const char* name : {"full_runs", "full_broken"}) rows.add(names.unique(name, "_done"));
  rows.add(names.unique("full_verdict", "_done"));
  for (int q = 0; q < predict::quantity_count; ++q)
    for (const char* column : interval_columns)
      rows.add(names.unique(
          std::string("full_") + predict::info_of(static_cast<predict::Quantity>(q)).name + column,
          "_done"));
}

void add_prediction(const predict::Prediction& prediction, bool has_seeds, Rows& rows) {
  const bool is_known = !prediction.reason.empty();
  rows.add(!is_known ? "-" : prediction.is_run ? "run" : "copies");
  if (has_seeds)
    for (const int count : {prediction.runs, prediction.broken})
      rows.add(prediction.is_run ? std::to_string(count) : "");
  rows.add(is_known ? predict::name(prediction.verdict) : "-");
  for (std::size_t q = 0; q < predict::quantity_count; ++q) {
    if (prediction.estimates.empty()) {
      for (std::size_t k = 0; k < interval_columns.size(); ++k) rows.add("");
      continue;
    }
    const predict::Estimate& e = prediction.estimates[q];
    for (const double value : {e.expected, e.low, e.high}) rows.add(float_text(value));
  }
}

/// Numbers of the metrics with a column.
using Listed = std::vector<std::size_t>;

Listed listed_metrics(const std::vector<store::RunResult>& results, bool with_times) {
  Listed listed = store::listed_metrics(results);
  if (!with_times)
    std::erase_if(listed, [](std::size_t metric) { return store::metric_infos()[metric].is_time; });
  return listed;
}

void add_header(const store::Manifest& manifest, bool has_predictions, const Listed& listed,
                Rows& rows) {
  ColumnNames names;
  for (const char* name : {"run", "label"}) rows.add(names.unique(name, "_"));
  add_parameter_names(manifest, names, rows);
  if (!manifest.marks.empty())
    for (const char* name : {"star", "note"}) rows.add(names.unique(name, "_"));
  // Columns of results give way to columns of settings: frames, frames_done.
  for (const char* name : {"state", "reason", "warnings", "frames"})
    rows.add(names.unique(name, "_done"));
  for (const std::size_t metric : listed)
    rows.add(names.unique(store::metric_infos()[metric].name, "_done"));
  if (has_predictions) add_prediction_names(manifest.seeds > 1, names, rows);
  for (const char* name : {"FILE", "FILE_scene"}) rows.add(name);
  rows.end();
}

void add_parameters(const store::Manifest& manifest, const Run& run, Rows& rows) {
  for (const Parameter& parameter : manifest.parameters) {
    const std::string value = run.value(parameter.address);
    if (parameter.type != "vector") {
      rows.add(cell(value, parameter.type));
      continue;
    }
    for (const std::string& part : components(value)) rows.add(cell(part, "number"));
  }
}

/// @param prediction  of its point; null without
void add_row(const store::Manifest& manifest, const Run& run, const store::RunResult& result,
             const predict::Prediction* prediction, const Listed& listed, Rows& rows) {
  rows.add(std::to_string(run.index));
  rows.add(cell(run.label.empty() ? "run " + std::to_string(run.index) : run.label, "string"));
  add_parameters(manifest, run, rows);
  if (!manifest.marks.empty()) {
    const auto mark = manifest.marks.find(run.index);
    const bool is_marked = mark != manifest.marks.end();
    rows.add(is_marked && mark->second.has_star ? "1" : "0");
    rows.add(!is_marked || mark->second.note.empty() ? "-" : text_cell(mark->second.note));
  }
  rows.add(store::name(result.status.state));
  rows.add(result.status.reason.empty() ? "-" : cell(result.status.reason, "string"));
  rows.add(std::to_string(result.warnings.size()));
  rows.add(std::to_string(result.frames.size()));
  for (const std::size_t k : listed) {
    const store::MetricInfo& metric = store::metric_infos()[k];
    const std::optional<double> value = store::told_metric(run, result, k);
    rows.add(!value ? "" : metric.is_whole ? whole_text(*value) : float_text(*value));
  }
  if (prediction) add_prediction(*prediction, manifest.seeds > 1, rows);
  const std::string folder = "runs/" + run.folder;
  rows.add(result.frames.empty()
               ? ""
               : output::frame_path(folder, manifest.view, result.frames.back()).generic_string());
  rows.add(folder + "/scene.toml");
  rows.end();
}

/// Columns of each metric. Points that are too close to call share a rank, and a letter in groups.
constexpr std::array point_columns{"_mean", "_min", "_max", "_rank", "_groups"};

struct PointColumns {
  std::vector<store::Summary> summaries;
  std::vector<int> ranks;
  std::vector<std::vector<int>> groups;
  bool is_whole = false;
  bool is_known = true;  ///< which points differ
};

std::vector<PointColumns> point_columns_of(const store::Manifest& manifest,
                                           const std::vector<store::Point>& points,
                                           const Listed& listed) {
  std::vector<PointColumns> columns;
  for (const std::size_t metric : listed) {
    const store::MetricInfo& info = store::metric_infos()[metric];
    const std::vector<store::Summary> summaries = store::summaries_of(points, metric);
    columns.push_back({summaries, store::shared_ranks(summaries), store::close_groups(summaries),
                       info.is_whole,
                       store::verdict_of(manifest, points, metric) != store::Verdict::unknown});
  }
  return columns;
}

void add_point_header(const store::Manifest& manifest, bool has_predictions, const Listed& listed,
                      Rows& rows) {
  ColumnNames names;
  for (const char* name : {"point", "label"}) rows.add(names.unique(name, "_"));
  add_parameter_names(manifest, names, rows);
  for (const char* name : {"runs", "ended", "judged", "broken"})
    rows.add(names.unique(name, "_done"));
  for (const std::size_t metric : listed)
    for (const char* column : point_columns)
      rows.add(names.unique(std::string(store::metric_infos()[metric].name) + column, "_done"));
  if (has_predictions) add_prediction_names(manifest.seeds > 1, names, rows);
  rows.end();
}

void add_cells(const PointColumns& column, std::size_t point, Rows& rows) {
  const store::Summary& s = column.summaries[point];
  if (s.count == 0) {
    for (std::size_t k = 0; k < point_columns.size(); ++k) rows.add("");
    return;
  }
  rows.add(float_text(s.mean));
  for (const double end : {s.min, s.max})
    rows.add(column.is_whole ? whole_text(end) : float_text(end));
  rows.add(column.is_known ? std::to_string(column.ranks[point]) : "");
  rows.add(column.is_known ? store::group_letters(column.groups[point]) : "");
}

}  // namespace

std::string points_csv(const store::Manifest& manifest,
                       const std::vector<store::RunResult>& results,
                       const std::vector<predict::Prediction>& predictions, bool with_times) {
  if (manifest.seeds == 1) return {};
  const store::Manifest shown = store::first_draws(manifest);
  const std::vector<store::Point> points = store::points_of(manifest, results);
  const Listed listed = listed_metrics(results, with_times);
  const std::vector<PointColumns> columns = point_columns_of(manifest, points, listed);
  Rows rows;
  add_point_header(shown, !predictions.empty(), listed, rows);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Run& run = shown.runs[k];
    rows.add(std::to_string(k));
    rows.add(cell(run.label.empty() ? "point " + std::to_string(k) : run.label, "string"));
    add_parameters(shown, run, rows);
    for (const std::size_t count :
         {points[k].count, points[k].ended, points[k].judged, points[k].broken})
      rows.add(std::to_string(count));
    for (const PointColumns& column : columns) add_cells(column, k, rows);
    if (!predictions.empty()) add_prediction(predictions[k], true, rows);
    rows.end();
  }
  return rows.text();
}

std::string data_csv(const store::Manifest& manifest, const std::vector<store::RunResult>& results,
                     const std::vector<predict::Prediction>& predictions, bool with_times) {
  const Listed listed = listed_metrics(results, with_times);
  Rows rows;
  add_header(manifest, !predictions.empty(), listed, rows);
  const auto seeds = static_cast<std::size_t>(manifest.seeds);
  for (std::size_t k = 0; k < manifest.runs.size(); ++k)
    add_row(manifest, manifest.runs[k], results[k],
            predictions.empty() ? nullptr : &predictions[k / seeds], listed, rows);
  return rows.text();
}

}  // namespace neve::app::sweep::sheet
