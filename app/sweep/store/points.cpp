#include "app/sweep/store/points.h"

#include <fmt/core.h>

#include <algorithm>
#include <span>

#include "app/support/text.h"

namespace neve::app::sweep::store {

namespace {

/// a, b, ..., z, a2, b2, ...
std::string letter(int group) {
  constexpr int letters = 26;
  const std::string text(1, static_cast<char>('a' + group % letters));
  return group < letters ? text : text + std::to_string(group / letters + 1);
}

std::string letters_of(std::span<const int> groups) {
  std::string text;
  for (const int group : groups) text += letter(group);
  return text;
}

/// True if no metric of any point depends on the seed, though runs ended.
bool draws_nothing(const std::vector<Point>& points) {
  bool has_two = false;
  for (const Point& point : points)
    for (std::size_t metric = 0; metric < point.metrics.size(); ++metric) {
      const Summary& s = point.metrics[metric];
      if (metric_infos()[metric].is_time || s.count < 2) continue;
      if (s.min != s.max) return false;
      has_two = true;
    }
  return has_two;
}

/// "of 6 pairs of points 2 differ, ...". A pair with a point of less than two runs is neither.
std::string pairs_text(const std::vector<Summary>& points) {
  std::size_t count = 0, different = 0;
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      count += std::min(points[a].count, points[b].count) > 1;
      different += differ(points[a], points[b]);
    }
  const std::size_t all = points.size() * (points.size() - 1) / 2;
  return fmt::format("of {} pairs of points {} differ, the others are {}", count, different,
                     close_words) +
         (count < all ? fmt::format("; the runs of {} more do not tell", all - count) : "");
}

}  // namespace

std::vector<Point> points_of(const Manifest& manifest, const std::vector<RunResult>& results) {
  std::vector<Point> points;
  const auto count = static_cast<std::size_t>(manifest.seeds);
  for (std::size_t first = 0; first + count <= results.size(); first += count) {
    Point& point = points.emplace_back();
    point.first = first;
    point.count = count;
    for (std::size_t run = first; run < first + count; ++run) {
      point.ended += is_whole(manifest.runs[run], results[run]);
      point.judged += results[run].has_broken.has_value();
      point.broken += results[run].has_broken.value_or(false);
    }
    for (std::size_t metric = 0; metric < metric_infos().size(); ++metric) {
      std::vector<double> values;
      for (std::size_t run = first; run < first + count; ++run)
        if (const auto value = told_metric(manifest.runs[run], results[run], metric))
          values.push_back(*value);
      point.metrics.push_back(summary_of(values));
    }
  }
  return points;
}

std::vector<Summary> summaries_of(const std::vector<Point>& points, std::size_t metric) {
  std::vector<Summary> summaries;
  for (const Point& point : points) summaries.push_back(point.metrics[metric]);
  return summaries;
}

Verdict verdict_of(const Manifest& manifest, const std::vector<Point>& points, std::size_t metric) {
  return manifest.seeds > 1 ? vary(summaries_of(points, metric)) : Verdict::unknown;
}

bool is_noise(const Manifest& manifest, const std::vector<Point>& points, std::size_t metric) {
  return verdict_of(manifest, points, metric) == Verdict::noise;
}

std::optional<std::size_t> telling_metric(const Manifest& manifest,
                                          const std::vector<Point>& points) {
  std::optional<std::size_t> unknown;
  bool has_noise = false;
  for (std::size_t metric = 0; metric < metric_infos().size(); ++metric) {
    if (metric_infos()[metric].is_cost || metric_infos()[metric].is_of_bodies) continue;
    const Verdict verdict = verdict_of(manifest, points, metric);
    if (verdict == Verdict::real) return metric;
    has_noise |= verdict == Verdict::noise;
    if (verdict == Verdict::unknown && !unknown) unknown = metric;
  }
  return has_noise ? std::nullopt : unknown;
}

std::string outcome_text(const Point& point) {
  std::string text;
  if (point.judged > 0)
    text = point.broken > 0 ? fmt::format("breaks in {} of {}", point.broken, point.judged)
                            : fmt::format("holds in {} of {}", point.judged, point.judged);
  if (point.ended < point.count)
    text += fmt::format("{}{} not ended", text.empty() ? "" : ", ", point.count - point.ended);
  return text;
}

bool is_undecided(const Point& point) {
  return point.broken > 0 && point.broken < point.judged;
}

std::string group_letters(const std::vector<int>& groups) {
  constexpr std::size_t max_letters = 3;
  if (groups.size() <= max_letters) return letters_of(groups);
  std::vector<std::string> texts;
  // A point may share groups d, e and g: a range has only those that follow each other.
  for (std::size_t first = 0, end = 0; first < groups.size(); first = end) {
    end = first + 1;
    while (end < groups.size() && groups[end] == groups[end - 1] + 1) ++end;
    texts.push_back(end - first > max_letters
                        ? letter(groups[first]) + " to " + letter(groups[end - 1])
                        : letters_of(std::span(groups).subspan(first, end - first)));
  }
  return joined(texts, ", ");
}

std::vector<std::string> noise_lines(const Manifest& manifest,
                                     const std::vector<RunResult>& results) {
  if (manifest.seeds == 1) return {};
  const std::vector<Point> points = points_of(manifest, results);
  if (draws_nothing(points))
    return {
        "all seeds of each point gave the same numbers: nothing in this scene depends on the "
        "seed, so that one run of each point tells as much"};
  std::vector<std::string> lines, noise;
  for (std::size_t metric = 0; metric < metric_infos().size(); ++metric)
    if (!metric_infos()[metric].is_time && is_noise(manifest, points, metric))
      noise.emplace_back(metric_infos()[metric].title);
  const auto telling = telling_metric(manifest, points);
  if (telling && verdict_of(manifest, points, *telling) == Verdict::unknown) {
    lines.emplace_back(unknown_words);
  } else if (telling) {
    lines.push_back(fmt::format("{}: {}", metric_infos()[*telling].title,
                                pairs_text(summaries_of(points, *telling))));
  }
  if (!noise.empty()) lines.push_back("noise here: " + joined(noise, ", "));
  const auto undecided = std::count_if(points.begin(), points.end(), is_undecided);
  if (undecided > 0)
    lines.push_back(fmt::format("{} of {} points break with some seeds and hold with others",
                                undecided, points.size()));
  return lines;
}

Manifest first_draws(const Manifest& manifest) {
  if (manifest.seeds == 1) return manifest;
  Manifest shown = manifest;
  shown.apart = manifest.seeds;
  std::erase_if(shown.parameters, [](const Parameter& p) { return p.address == "seed"; });
  std::erase_if(shown.runs, [&](const Run& run) { return run.index % manifest.seeds != 0; });
  for (Run& run : shown.runs)
    std::erase_if(run.settings, [](const scene::Override& s) { return s.address == "seed"; });
  return shown;
}

std::vector<RunResult> first_draws(const Manifest& manifest,
                                   const std::vector<RunResult>& results) {
  std::vector<RunResult> shown;
  for (std::size_t k = 0; k < results.size(); k += static_cast<std::size_t>(manifest.seeds))
    shown.push_back(results[k]);
  return shown;
}

}  // namespace neve::app::sweep::store
