#include "app/sweep/sheet/seals.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "app/support/text.h"
#include "app/sweep/sheet/sheet_layout.h"

namespace neve::app::sweep::sheet {

namespace {

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

WhiskerSpan span_on(const Scale& scale, const store::Summary& s) {
  return {scale.place(s.min), scale.place(s.mean), scale.place(s.max)};
}

std::string with_unit(double x, const std::string& unit) {
  return rough_text(x) + (unit.empty() ? "" : " " + unit);
}

constexpr std::size_t max_squares = 3;
constexpr float wide_square = 3.6f;  // in sizes of the font, of more letters, at least

/// Returns the width of letters in sizes of the font.
float letters_width(const std::vector<int>& groups) {
  if (groups.size() <= max_squares) return square_width * static_cast<float>(groups.size());
  constexpr float letter = 0.6f;
  return std::max(wide_square, letter * static_cast<float>(store::group_letters(groups).size()));
}

/// A square for each group, or one for many.
void draw_letters(const std::vector<int>& groups, float right, float y, float size,
                  render::Frame& words) {
  const auto square = [&](const std::string& text, int group, float width) {
    right -= width;
    draw_square(text, group, right, y, width, size, words);
  };
  if (groups.size() > max_squares) {
    square(store::group_letters(groups), groups.front(), letters_width(groups) * size);
    return;
  }
  for (auto group = groups.rbegin(); group != groups.rend(); ++group)
    square(store::group_letters({*group}), *group, square_width * size);
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
  std::vector<store::Summary> points{};
  std::vector<store::Summary> coarse{};  ///< beside those at full resolution; none without seeds
};

/// Fills in the values, groups and whiskers. @return the scale; low > high where nothing has a
/// value
Scale place_whiskers(const Whiskers& shown, Seals& seals) {
  const std::vector<std::vector<int>> groups = store::close_groups(shown.points);
  std::vector<store::Summary> all = shown.points;
  all.insert(all.end(), shown.coarse.begin(), shown.coarse.end());
  const Scale scale = scale_of(all);
  seals.title = shown.title;
  for (std::size_t k = 0; k < shown.coarse.size(); ++k) {
    const store::Summary& s = shown.coarse[k];
    if (s.count > 0) seals.of_points[k].coarse = {with_unit(s.mean, shown.unit), span_on(scale, s)};
  }
  for (std::size_t k = 0; k < shown.points.size(); ++k) {
    Seal& seal = seals.of_points[k];
    const store::Summary& s = shown.points[k];
    if (s.count == 0) continue;
    seal.whisker = {with_unit(s.mean, shown.unit), span_on(scale, s)};
    if (!seals.is_noise && !seals.is_unknown) seal.groups = groups[k];
  }
  return scale;
}

using Mark = KeyLine::Mark;

/// Explains what it means that two tiles share a letter, or none.
/// @param differs  "their spread differs for real"
void explain_letters(const std::string& differs, const char* why_not, Seals& seals) {
  if (seals.is_unknown) {
    seals.key.push_back({Mark::none, store::unknown_words});
    return;
  }
  if (seals.is_noise) {
    seals.key.push_back(
        {Mark::none, fmt::format("all tiles are {}: {}", store::close_words, why_not)});
    return;
  }
  seals.key.push_back({Mark::apart, "no letter in common: " + differs});
  seals.key.push_back({Mark::together, fmt::format("a letter in common: {}", store::close_words)});
}

void explain_rails(const Scale& scale, const std::string& unit, Seals& seals) {
  seals.key.push_back(
      {Mark::none, fmt::format("the line goes from {} to {} on every tile", rough_text(scale.low),
                               with_unit(scale.high, unit))});
}

/// Words of a kind of whisker. @param whose  "spread of the 4 coarse seeds"
std::string seeds_text(const std::string& whose) {
  return whose + ", from min to max (bar), and their mean (square, number)";
}
constexpr const char* interval_words =
    " at full resolution (square, number), and the interval in which four of five full runs end "
    "(bar)";

void explain_doubt(const char* why, Seals& seals) {
  if (std::any_of(seals.of_points.begin(), seals.of_points.end(),
                  [](const Seal& seal) { return seal.is_undecided; }))
    seals.key.push_back({Mark::doubt, why});
}

Seals seals_of_seeds(const store::Manifest& manifest, const std::vector<store::Point>& points,
                     const std::vector<store::RunResult>& results) {
  Seals seals;
  const std::optional<std::size_t> telling = store::telling_metric(manifest, points);
  seals.is_noise = !telling;
  seals.is_unknown =
      telling && store::verdict_of(manifest, points, *telling) == store::Verdict::unknown;
  for (const store::Point& point : points)
    seals.of_points.push_back(
        {outcome_at(point, results[point.first]), store::is_undecided(point), false});
  const store::MetricInfo& info = store::metric_infos()[telling.value_or(0)];
  const Scale scale = place_whiskers(
      {info.title, info.unit, store::summaries_of(points, telling.value_or(0))}, seals);
  if (scale.low > scale.high) return seals;
  explain_letters(
      fmt::format("their {} differs for real, by more than other seeds change it (95 %)",
                  info.title),
      "another seed changes as much", seals);
  seals.key.push_back(
      {seals.is_noise ? Mark::grey_whisker : Mark::whisker,
       seeds_text(fmt::format("{}{} of {} seeds", info.title, seals.is_noise ? ", noise here," : "",
                              manifest.seeds))});
  explain_rails(scale, info.unit, seals);
  explain_doubt("it breaks with some seeds and holds with others: one more may do either", seals);
  return seals;
}

/// The whiskers of predictions and of runs at full resolution.
void explain_full(const std::vector<predict::Prediction>& predictions, int seeds,
                  const std::string& title, Seals& seals) {
  const bool has_runs = std::any_of(predictions.begin(), predictions.end(),
                                    [](const predict::Prediction& p) { return p.is_run; });
  const bool has_expected =
      std::any_of(predictions.begin(), predictions.end(),
                  [](const predict::Prediction& p) { return !p.is_run && !p.reason.empty(); });
  const Mark mark = seals.is_noise ? Mark::grey_whisker : Mark::whisker;
  if (has_expected)
    seals.key.push_back(
        {mark, (seeds > 1 ? "expected: " + title : title + " expected") + interval_words});
  if (!has_runs) return;
  const std::string of_runs =
      seeds > 1 ? seeds_text(fmt::format("{} of the {} seeds at full resolution", title, seeds))
                : title +
                      " of the run at full resolution (square, number), and how far one with "
                      "another seed may lie from it (bar)";
  seals.key.push_back({mark, (seeds > 1 ? "full: " : "") + of_runs});
  seals.key.push_back({Mark::full, "the picture is that of the run at full resolution"});
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
                               predict::is_in_doubt(predictions[k]), predictions[k].is_run});
  const predict::Quantity quantity = telling.value_or(predict::Quantity::spread);
  const predict::QuantityInfo& info = predict::info_of(quantity);
  Whiskers shown{info.title, info.unit, store::summaries_of(predictions, quantity)};
  if (manifest.seeds > 1) shown.coarse = store::summaries_of(points, store::metric_of(quantity));
  const Scale scale = place_whiskers(shown, seals);
  if (scale.low > scale.high) return seals;
  if (known > 1)
    explain_letters(fmt::format("their {} at full resolution differs for real", info.title),
                    "what is known of them at full resolution overlaps", seals);
  explain_full(predictions, manifest.seeds, info.title, seals);
  if (manifest.seeds > 1)
    seals.key.push_back({Mark::coarse, seeds_text(fmt::format("coarse: {} of the {} coarse seeds",
                                                              info.title, manifest.seeds))});
  explain_rails(scale, info.unit, seals);
  explain_doubt(
      "undecided: of its copies or runs some break and some hold, or it is at the edge; --refine "
      "decides",
      seals);
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
  const float edge = 0.6f * place.size;
  draw_whisker_mark(shown.span, place.left, place.right - 2 * edge - place.room - place.left,
                    place.y, place.size, color, words);
  words.notes.push_back({place.right - 0.5f * edge, place.y, shown.value,
                         render::Note::Anchor::right, place.room, false, ink});
}

}  // namespace

int rows_of(const Seals& seals, std::size_t letters) {
  int rows = 0;
  for (const Seal& seal : seals.of_points)
    rows = std::max(rows, static_cast<int>(broken_lines(seal.outcome, letters).size()) +
                              !seal.whisker.value.empty() + !seal.coarse.value.empty());
  return rows;
}

void draw_seal(const Seal& seal, const Seals& all, const SealPlace& band, render::Frame& words) {
  const float size = band.font_size, line = 1.3f * size, edge = 0.6f * size;
  const bool has_value = !seal.whisker.value.empty(), has_coarse = !seal.coarse.value.empty();
  words.patches.push_back({band.x, band.y, band.width, band.height, {8, 10, 16, 190}});
  float y = band.y + 0.25f * size;
  for (const std::string& text : broken_lines(seal.outcome, letters_in(band.width, size))) {
    words.notes.push_back({band.x + edge, y, text, render::Note::Anchor::left,
                           band.width - 2 * edge, false,
                           seal.is_undecided ? seal_caution : seal_ink});
    y += line;
  }
  // Rails of one scale are equally long on all tiles: so are the names before and the letters
  // behind.
  const bool has_two = std::any_of(all.of_points.begin(), all.of_points.end(),
                                   [](const Seal& s) { return !s.coarse.value.empty(); });
  const float label =
      has_two ? 5 * size
              : std::min(0.32f * band.width, size * static_cast<float>(letter_width) *
                                                 static_cast<float>(all.title.size() + 2));
  const float last = y + (has_coarse ? line : 0);
  const float end = band.x + band.width - edge;
  float letters = 0;
  for (const Seal& other : all.of_points)
    letters = std::max(letters, size * letters_width(other.groups));
  const float right = end - letters;
  if (has_value) draw_letters(seal.groups, end, last, size, words);
  WhiskerPlace place{band.x + edge + label, right, y, 0.26f * band.width, size};
  const auto name = [&](const std::string& text) {
    words.notes.push_back({band.x + edge, place.y, text, render::Note::Anchor::left,
                           label - 0.3f * size, false, seal_ink});
  };
  if (has_coarse) {
    name("coarse");
    draw_whisker(seal.coarse, place, coarse_whisker, seal_ink, words);
    place.y = last;
  }
  if (!has_value) return;
  name(!has_two ? all.title : seal.is_run ? "full" : "expected");
  draw_whisker(seal.whisker, place, all.is_noise ? grey_whisker : white_whisker,
               all.is_noise ? seal_grey : seal_ink, words);
}

}  // namespace neve::app::sweep::sheet
