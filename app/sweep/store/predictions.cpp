#include "app/sweep/store/predictions.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "app/support/text.h"

namespace neve::app::sweep::store {

namespace {

/// Tells why a copy has no end; "" if it has. A damaged one has no numbers.
std::string failure_of(const Run& run, const RunResult& result) {
  if (!result.flaws.empty()) return result.flaws;
  if (is_whole(run, result)) return "";
  if (result.status.state == RunState::diverged) return "it diverged";
  if (has_failed(result.status.state)) return result.status.reason;
  return "it has not been made yet";
}

predict::Copy copy_of(const std::filesystem::path& folder, const Manifest& manifest,
                      const Variant& variant) {
  predict::Copy copy;
  copy.coarsening = variant.coarsening;
  copy.seed = number_of<std::uint64_t>(variant.run.setting("seed")).value_or(0);
  const RunResult result = read_result(folder, variant.run, manifest.view);
  copy.failure = failure_of(variant.run, result);
  if (!copy.failure.empty()) return copy;
  copy.has_broken = result.has_broken;
  copy.whole = result.whole.value_or(1);
  for (int q = 0; q < predict::quantity_count; ++q) {
    const auto quantity = static_cast<predict::Quantity>(q);
    const std::optional<double> value = result.metrics[metric_of(quantity)];
    copy.values[q] = value.value_or(0);
  }
  return copy;
}

/// The runs themselves, one for each seed: mean and range of their values.
predict::Prediction prediction_of(const std::vector<const RunResult*>& full) {
  predict::Prediction known = predict::silent(
      "it has no snow at the start or at the end, or a sink takes what its largest piece lacks");
  known.is_run = true;
  for (const RunResult* result : full) {
    known.runs += result->has_broken.has_value();
    known.broken += result->has_broken.value_or(false);
  }
  if (known.runs == 0) return known;
  known.verdict = known.broken == known.runs ? predict::Verdict::breaks
                  : known.broken == 0        ? predict::Verdict::holds
                                             : predict::Verdict::undecided;
  known.reason = known.runs == 1 ? "the run at full resolution"
                                 : fmt::format("{} runs at full resolution", known.runs);
  for (int q = 0; q < predict::quantity_count; ++q) {
    const auto quantity = static_cast<predict::Quantity>(q);
    std::vector<double> values;
    for (const RunResult* result : full)
      if (result->has_broken) values.push_back(result->metrics[metric_of(quantity)].value_or(0));
    const Summary s = summary_of(values);
    known.estimates.push_back({quantity, s.mean, s.min, s.max, s.variance});
  }
  return known;
}

/// Judges the copies of a point. @param point  its first run
predict::Prediction judge_copies(const std::filesystem::path& folder, const Manifest& manifest,
                                 std::size_t point) {
  std::vector<predict::Copy> copies;
  for (const Variant& variant : manifest.variants) {
    if (variant.of != point || variant.is_full()) continue;
    if (!variant.failure.empty()) return predict::silent(variant.failure);
    copies.push_back(copy_of(folder, manifest, variant));
  }
  return copies.size() < 2 ? predict::silent("") : predict::judge(std::move(copies));
}

}  // namespace

std::size_t metric_of(predict::Quantity quantity) {
  const std::string_view name = predict::info_of(quantity).name;
  const std::vector<MetricInfo>& infos = metric_infos();
  const auto found = std::find_if(infos.begin(), infos.end(),
                                  [&](const MetricInfo& info) { return name == info.name; });
  return static_cast<std::size_t>(found - infos.begin());
}

std::vector<std::optional<RunResult>> full_results(const std::filesystem::path& folder,
                                                   const Manifest& manifest) {
  std::vector<std::optional<RunResult>> full;
  for (const Variant& variant : manifest.variants) {
    if (!variant.is_full()) continue;
    full.resize(manifest.runs.size());
    RunResult result = read_result(folder, variant.run, manifest.view);
    if (failure_of(variant.run, result).empty()) full[variant.of] = std::move(result);
  }
  return full;
}

std::vector<const RunResult*> full_results_of(const std::vector<std::optional<RunResult>>& full,
                                              std::size_t first, int seeds) {
  std::vector<const RunResult*> of_point;
  const std::size_t end = std::min(full.size(), first + static_cast<std::size_t>(seeds));
  for (std::size_t run = first; run < end; ++run)
    if (full[run]) of_point.push_back(&*full[run]);
  return of_point;
}

std::vector<predict::Prediction> predictions_of(const std::filesystem::path& folder,
                                                const Manifest& manifest) {
  std::vector<predict::Prediction> predictions;
  if (manifest.variants.empty()) return predictions;
  const std::vector<std::optional<RunResult>> full = full_results(folder, manifest);
  const auto seeds = static_cast<std::size_t>(manifest.seeds);
  for (std::size_t first = 0; first < manifest.runs.size(); first += seeds) {
    const std::vector<const RunResult*> own = full_results_of(full, first, manifest.seeds);
    predictions.push_back(own.empty() ? judge_copies(folder, manifest, first) : prediction_of(own));
  }
  return predictions;
}

std::vector<Summary> summaries_of(const std::vector<predict::Prediction>& predictions,
                                  predict::Quantity quantity) {
  std::vector<Summary> summaries;
  for (const predict::Prediction& prediction : predictions) {
    Summary& summary = summaries.emplace_back();
    if (prediction.estimates.empty()) continue;
    const predict::Estimate& e = prediction.estimates[static_cast<std::size_t>(quantity)];
    // Runs of several seeds are compared by their noise, all else by its interval.
    const bool has_noise = prediction.is_run && prediction.runs > 1;
    const std::size_t count =
        prediction.is_run ? static_cast<std::size_t>(prediction.runs) : prediction.copies.size();
    summary = {.count = std::max<std::size_t>(1, count),
               .mean = e.expected,
               .min = e.low,
               .max = e.high,
               .variance = e.variance,
               .is_interval = !has_noise};
    // One run is one draw.
    if (!prediction.is_run || prediction.runs != 1) continue;
    const double half = predict::share_of(quantity) * std::abs(e.expected);
    summary.min -= half;
    summary.max += half;
  }
  return summaries;
}

std::optional<predict::Quantity> telling_quantity(
    const std::vector<predict::Prediction>& predictions) {
  for (int q = 0; q < predict::quantity_count; ++q) {
    const std::vector<Summary> points =
        summaries_of(predictions, static_cast<predict::Quantity>(q));
    for (const Summary& a : points)
      for (const Summary& b : points)
        if (a.count > 0 && b.count > 0 && differ(a, b)) return static_cast<predict::Quantity>(q);
  }
  return std::nullopt;
}

std::string prediction_line(const std::vector<predict::Prediction>& predictions) {
  using predict::Verdict;
  std::string text;
  for (const bool is_run : {true, false}) {
    std::string counts;
    std::size_t points = 0;
    for (const Verdict verdict :
         {Verdict::breaks, Verdict::holds, Verdict::undecided, Verdict::cannot_say}) {
      const auto count = std::count_if(predictions.begin(), predictions.end(), [&](const auto& p) {
        return p.is_run == is_run && p.verdict == verdict && !p.reason.empty();
      });
      if (count == 0) continue;
      points += static_cast<std::size_t>(count);
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", predict::name(verdict), count);
    }
    if (points == 0) continue;
    text += fmt::format("{}{} {}: {}", text.empty() ? "at full resolution, " : "; ",
                        is_run ? "by runs of" : "by coarse copies of", count_text(points, "point"),
                        counts);
  }
  return text;
}

}  // namespace neve::app::sweep::store
