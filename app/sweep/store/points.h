#pragma once
/// Points of a sweep: the values of its axes, whatever the seed. Without --seeds each run is a
/// point.

#include <optional>
#include <string>
#include <vector>

#include "app/sweep/store/manifest.h"
#include "app/sweep/store/results.h"
#include "app/sweep/store/statistics.h"

namespace neve::app::sweep::store {

/// The runs of a point.
struct Point {
  std::size_t first = 0, count = 1;    ///< runs of the manifest
  std::size_t ended = 0;               ///< that got to their last frame
  std::size_t judged = 0, broken = 0;  ///< of those: that had snow at first, and where it broke
  std::vector<Summary> metrics;        ///< one per metric_infos()
};

std::vector<Point> points_of(const Manifest& manifest, const std::vector<RunResult>& results);

/// A metric of all points.
std::vector<Summary> summaries_of(const std::vector<Point>& points, std::size_t metric);

/// Judges whether points with seeds differ in this metric by more than their runs do.
Verdict verdict_of(const Manifest& manifest, const std::vector<Point>& points, std::size_t metric);

/// True of a sweep with seeds whose points differ in this metric by no more than their runs do.
/// False where that is not known.
bool is_noise(const Manifest& manifest, const std::vector<Point>& points, std::size_t metric);

/// The first metric of the snow that tells points apart; the first one of all where of none is
/// known whether it does; nothing if those of which it is known are noise.
std::optional<std::size_t> telling_metric(const Manifest& manifest,
                                          const std::vector<Point>& points);

/// "breaks in 1 of 4", "holds in 4 of 4", and how many runs did not end; "" if no run tells.
std::string outcome_text(const Point& point);
/// True if some runs break and some hold: one more seed may do either.
bool is_undecided(const Point& point);

/// "a", "bc", "b to f", "de, g": groups as letters; points that share one are too close to call.
std::string group_letters(const std::vector<int>& groups);

/// Tells what the seeds of a sweep say of it, a sentence a line; none without seeds.
std::vector<std::string> noise_lines(const Manifest& manifest,
                                     const std::vector<RunResult>& results);

/// The reason, everywhere, why nothing is said of noise.
inline constexpr const char* unknown_words =
    "what is noise is not known: no two points have ended, one of them with two seeds";

/// Words for it, everywhere.
inline constexpr const char* close_words = "too close to call";

/// The first run of each point, without its seed among the parameters, as sheets show them. Runs
/// keep their numbers.
Manifest first_draws(const Manifest& manifest);
std::vector<RunResult> first_draws(const Manifest& manifest, const std::vector<RunResult>& results);

}  // namespace neve::app::sweep::store
