#include "app/sweep/sheet/seals.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>

#include "app/support/text.h"

namespace neve::app::sweep::sheet {

namespace {

constexpr std::array<std::uint8_t, 3> seal_ink{240, 244, 250}, seal_grey{190, 199, 212},
    seal_caution{255, 205, 96};
constexpr std::array<std::uint8_t, 4> rail{96, 106, 122, 255}, white_whisker{240, 244, 250, 255},
    grey_whisker{142, 150, 162, 255}, coarse_whisker{108, 172, 228, 255};

struct Scale {
  double low = 0, high = 0;

  double place(double x) const { return high > low ? (x - low) / (high - low) : 0.5; }
};

Scale scale_of(const std::vector<store::Summary>& summaries) {
  Scale scale{1e300, -1e300};
  for (const store::Summary& s : summaries)
    if (s.count > 0) scale = {std::min(scale.low, s.min), std::max(scale.high, s.max)};
  return scale;
}

std::string with_unit(double x, const std::string& unit) {
  return rough_text(x) + (unit.empty() ? "" : " " + unit);
}

constexpr float square_width = 1.5f;  // in sizes of the font

/// A square for each group, or one for many. @return the left end, px
float draw_letters(const std::vector<int>& groups, float right, float y, float size,
                   render::Frame& words) {
  constexpr std::size_t max_squares = 3;
  const auto square = [&](const std::string& text, int group, float width) {
    right -= width;
    const auto& c = group_colours[static_cast<std::size_t>(group) % group_colours.size()];
    words.patches.push_back(
        {right, y - 0.1f * size, width - 0.1f * size, 1.3f * size, {c[0], c[1], c[2], 255}});
    words.notes.push_back(
        {right + 0.5f * width, y, text, render::Note::Anchor::middle, width, false, seal_ink});
  };
  if (groups.size() > max_squares) {
    square(store::group_letters(groups), groups.front(), 3.6f * size);
    return right;
  }
  for (auto group = groups.rbegin(); group != groups.rend(); ++group)
    square(store::group_letters({*group}), *group, square_width * size);
  return right;
}

}  // namespace

std::string outcome_at(const store::Point& point, const store::RunResult& run) {
  const std::string text = store::outcome_text(point);
  if (!store::is_undecided(point) || !run.has_broken) return text;
  return text + (*run.has_broken ? ": here" : ": not here");
}

std::string predicted_outcome(const predict::Prediction& prediction, const store::Point& point) {
  const std::string coarse = point.count == 1 ? "" : "coarse: " + store::outcome_text(point);
  if (!prediction.is_run && prediction.reason.empty()) return coarse;
  if (prediction.is_run && prediction.runs > 1)
    return fmt::format("full: {} in {} of {}; {}", prediction.broken > 0 ? "breaks" : "holds",
                       prediction.broken > 0 ? prediction.broken : prediction.runs, prediction.runs,
                       coarse);
  return std::string(prediction.is_run ? "full resolution: " : "expected at full resolution: ") +
         predict::name(prediction.verdict) + (coarse.empty() ? "" : "; " + coarse);
}

namespace {

/// A metric or a quantity that the whiskers show.
struct Whiskers {
  std::string title, unit;
  std::vector<store::Summary> points;
  std::vector<store::Summary> coarse{};  ///< beside those at full resolution; none without seeds
};

/// Fills in the values, groups and whiskers. @return the scale; low > high where nothing has a
/// value
Scale place_whiskers(const Whiskers& shown, Seals& seals) {
  const std::vector<std::vector<int>> groups = store::close_groups(shown.points);
  std::vector<store::Summary> all = shown.points;
  all.insert(all.end(), shown.coarse.begin(), shown.coarse.end());
  const Scale scale = scale_of(all);
  for (std::size_t k = 0; k < shown.coarse.size(); ++k) {
    const store::Summary& s = shown.coarse[k];
    if (s.count > 0)
      seals.of_points[k].coarse = {with_unit(s.mean, shown.unit), scale.place(s.min),
                                   scale.place(s.mean), scale.place(s.max)};
  }
  for (std::size_t k = 0; k < shown.points.size(); ++k) {
    Seal& seal = seals.of_points[k];
    const store::Summary& s = shown.points[k];
    if (s.count == 0) continue;
    seal.value = with_unit(s.mean, shown.unit);
    if (!seals.is_noise) seal.groups = groups[k];
    seal.min = scale.place(s.min);
    seal.mean = scale.place(s.mean);
    seal.max = scale.place(s.max);
  }
  return scale;
}

std::string letters_key(const Seals& seals) {
  return seals.is_noise ? fmt::format("all tiles are {}", store::close_words)
                        : fmt::format("tiles that share a letter are {}", store::close_words);
}

/// "from 0.2 to 0.5 m"
std::string scale_text(const Scale& scale, const std::string& unit) {
  return fmt::format("from {} to {}", rough_text(scale.low), with_unit(scale.high, unit));
}

const char* whisker_words(const std::vector<predict::Prediction>& predictions) {
  const auto is_run = [](const predict::Prediction& p) { return p.is_run; };
  if (std::none_of(predictions.begin(), predictions.end(), is_run))
    return " expected at full resolution, and the interval that holds four of five";
  if (std::any_of(predictions.begin(), predictions.end(),
                  [](const predict::Prediction& p) { return !p.is_run && !p.reason.empty(); }))
    return " at full resolution: of the run, or expected, with the interval that holds four of "
           "five";
  return " of the runs at full resolution";
}

Seals seals_of_seeds(const store::Manifest& manifest, const std::vector<store::Point>& points,
                     const std::vector<store::RunResult>& results) {
  Seals seals;
  const std::optional<std::size_t> telling = store::telling_metric(manifest, points);
  seals.is_noise = !telling;
  for (const store::Point& point : points)
    seals.of_points.push_back(
        {outcome_at(point, results[point.first]), store::is_undecided(point), false, "", {}});
  const store::MetricInfo& info = store::metric_infos()[telling.value_or(0)];
  const Scale scale = place_whiskers(
      {info.title, info.unit, store::summaries_of(points, telling.value_or(0))}, seals);
  if (scale.low > scale.high) return seals;
  seals.key = {letters_key(seals), fmt::format("whisker: {}{} of {} seeds, min to max and mean, {}",
                                               info.title, seals.is_noise ? ", noise here," : "",
                                               manifest.seeds, scale_text(scale, info.unit))};
  return seals;
}

}  // namespace

Seals seals_of(const store::Manifest& manifest, const std::vector<store::RunResult>& results,
               const std::vector<predict::Prediction>& predictions) {
  if (manifest.seeds == 1 && predictions.empty()) return {};
  const std::vector<store::Point> points = store::points_of(manifest, results);
  if (predictions.empty()) return seals_of_seeds(manifest, points, results);
  Seals seals;
  const std::optional<predict::Quantity> telling = store::telling_quantity(predictions);
  const auto known = std::count_if(predictions.begin(), predictions.end(),
                                   [](const auto& p) { return !p.estimates.empty(); });
  seals.is_noise = !telling && known > 1;
  for (std::size_t k = 0; k < points.size(); ++k)
    seals.of_points.push_back({predicted_outcome(predictions[k], points[k]),
                               predict::is_in_doubt(predictions[k]),
                               predictions[k].is_run,
                               "",
                               {}});
  const predict::Quantity quantity = telling.value_or(predict::Quantity::spread);
  const predict::QuantityInfo& info = predict::info_of(quantity);
  Whiskers shown{info.title, info.unit, store::summaries_of(predictions, quantity)};
  if (manifest.seeds > 1) shown.coarse = store::summaries_of(points, store::metric_of(quantity));
  const Scale scale = place_whiskers(shown, seals);
  if (scale.low > scale.high) return seals;
  if (known > 1) seals.key.push_back(letters_key(seals));
  if (manifest.seeds > 1) {
    const bool has_runs = std::any_of(predictions.begin(), predictions.end(),
                                      [](const predict::Prediction& p) { return p.is_run; });
    seals.key.push_back(
        fmt::format("whiskers: {}, min to max and mean, {}; blue: {} coarse seeds, white: {}",
                    info.title, scale_text(scale, info.unit), manifest.seeds,
                    has_runs ? "full resolution" : "expected at full resolution"));
    return seals;
  }
  seals.key.push_back(fmt::format("whisker: {}{}, {}", info.title, whisker_words(predictions),
                                  scale_text(scale, info.unit)));
  return seals;
}

namespace {

/// A rail from left to right with the whisker on it, and the value at its end.
struct WhiskerPlace {
  float left, right, y, room, size;  ///< px; room is that of the value
};

void draw_whisker(const Whisker& shown, const WhiskerPlace& place,
                  const std::array<std::uint8_t, 4>& color, const std::array<std::uint8_t, 3>& ink,
                  render::Frame& words) {
  const float size = place.size, edge = 0.6f * size,
              length = place.right - 2 * edge - place.room - place.left,
              middle = place.y + 0.55f * size;
  const auto at = [&](double share) { return place.left + static_cast<float>(share) * length; };
  const float thin = std::max(1.0f, 0.1f * size), thick = std::max(2.0f, 0.22f * size),
              dot = 0.6f * size;
  words.patches.push_back({place.left, middle - 0.5f * thin, length, thin, rail});
  words.patches.push_back({at(shown.min) - 0.5f * thick, middle - 0.5f * thick,
                           at(shown.max) - at(shown.min) + thick, thick, color});
  words.patches.push_back({at(shown.mean) - 0.5f * dot, middle - 0.5f * dot, dot, dot, color});
  words.notes.push_back({place.right - 0.5f * edge, place.y, shown.value,
                         render::Note::Anchor::right, place.room, false, ink});
}

}  // namespace

void draw_seal(const Seal& seal, bool is_noise, const SealPlace& tile, render::Frame& words) {
  const float size = tile.font_size, line = 1.3f * size, edge = 0.6f * size;
  const bool has_value = !seal.value.empty(), has_outcome = !seal.outcome.empty(),
             has_coarse = !seal.coarse.value.empty();
  if (!has_value && !has_outcome && !has_coarse) return;
  const float height =
      line * static_cast<float>(has_value + has_outcome + has_coarse) + 0.5f * size;
  const float top = tile.y + tile.height - height;
  words.patches.push_back({tile.x, top, tile.width, height, {8, 10, 16, 190}});
  float y = top + 0.25f * size;
  if (has_outcome) {
    words.notes.push_back({tile.x + edge, y, seal.outcome, render::Note::Anchor::left,
                           tile.width - 2 * edge, false,
                           seal.is_undecided ? seal_caution : seal_ink});
    y += line;
  }
  const float label = has_coarse ? 5 * size : 0;
  const float last = y + (has_coarse ? line : 0);
  const float end = tile.x + tile.width - edge;
  float right = has_value ? draw_letters(seal.groups, end, last, size, words) : end;
  // Room for a letter in any case: rails of one scale are equally long.
  if (has_coarse) right = std::min(right, end - square_width * size);
  WhiskerPlace place{tile.x + edge + label, right, y, 0.26f * tile.width, size};
  const auto name = [&](const char* text) {
    words.notes.push_back(
        {tile.x + edge, place.y, text, render::Note::Anchor::left, label, false, seal_ink});
  };
  if (has_coarse) {
    name("coarse");
    draw_whisker(seal.coarse, place, coarse_whisker, seal_ink, words);
    place.y = last;
  }
  if (!has_value) return;
  if (has_coarse) name(seal.is_run ? "full" : "expected");
  draw_whisker({seal.value, seal.min, seal.mean, seal.max}, place,
               is_noise ? grey_whisker : white_whisker, is_noise ? seal_grey : seal_ink, words);
}

}  // namespace neve::app::sweep::sheet
