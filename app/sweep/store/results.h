#pragma once
/// Results of the runs of a sweep, read from their folders.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/store/manifest.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::store {

/// A number that tells runs apart.
struct MetricInfo {
  const char *name, *unit, *title;
  bool is_whole;
  bool is_time;               ///< differs from machine to machine
  bool is_cost = false;       ///< says something of a run that did not get to its end as well
  bool is_of_bodies = false;  ///< that move by themselves: listed only where there are some
};
/// Returns the metrics in the order in which they are listed everywhere.
const std::vector<MetricInfo>& metric_infos();

/// The place of the snow of a run at a frame.
struct SnowPlace {
  int frame = 0;
  double time = 0;  ///< s
  std::size_t particles = 0;
  sim::Vec3d centre;              ///< of mass, m
  double spread = 0, height = 0;  ///< m, see record::Metrics
};

struct RunResult {
  RunStatus status;
  std::vector<int> frames;  ///< that have a picture, in order
  /// One per metric_infos(), of the last frame; empty if there is no frame. Those of the snow are
  /// empty where none is left. See told_metric().
  std::vector<std::optional<double>> metrics;
  /// The warnings that the run ended with: its numbers may be misleading.
  std::vector<std::string> warnings{};
  std::string flaws{};  ///< see flaws_of_run
  /// True if a run that got to its end broke since its first picture; see record::has_broken.
  std::optional<bool> has_broken{};
  std::optional<double> whole{};    ///< its largest piece as a share of that of its first picture
  std::vector<SnowPlace> places{};  ///< of the frames that have a picture
  std::string simd{}, sources{};    ///< that its pictures were made with, see Build
  std::uint64_t end_hash = 0;       ///< of the state at the last frame of a run that got there

  std::optional<int> last_frame() const {
    return frames.empty() ? std::nullopt : std::optional(frames.back());
  }
};

/// Numbers of the metrics to list, in order: all but those of bodies in a sweep without any.
std::vector<std::size_t> listed_metrics(const std::vector<RunResult>& results);

/// Files of a run that ended as ok or diverged which are missing or damaged; "" if all are
/// whole, and for other runs, whose pictures are not relied on.
std::string flaws_of_run(const std::filesystem::path& folder, const Run& run,
                         const RunStatus& status);

/// Tells why a run is to be made: nothing where it has ended and its files are whole; "" where it
/// has not ended, or `retry` repeats what it ended as; otherwise its flaws.
std::optional<std::string> why_to_make(const std::filesystem::path& folder, const Run& run,
                                       const RunStatus& status, const Retry& retry);

/// True if the metrics belong to the last frame, at which all runs are compared.
bool is_whole(const Run& run, const RunResult& result);

/// A metric as all tables and pages tell it: none of a run that is not comparable, unless it is a
/// cost.
std::optional<double> told_metric(const Run& run, const RunResult& result, std::size_t metric);

/// @param folder of the sweep
/// @param view   whose pictures count
RunResult read_result(const std::filesystem::path& folder, const Run& run, const std::string& view);
std::vector<RunResult> read_results(const std::filesystem::path& folder, const Manifest& manifest);

/// "run 4: FLAWS" of each copy and run at full resolution that has some; see RunResult::flaws.
std::vector<std::string> variant_flaws(const std::filesystem::path& folder,
                                       const Manifest& manifest);

/// "1 warning", "2 warnings"
std::string warning_count_text(std::size_t count);

/// Runs of one table that different instructions or different programs have made.
std::vector<std::string> mixture_lines(const std::vector<RunResult>& results);

/// ", 1 failed, 2 not finished"; "" where all are ok. @param ok  receives how many are
std::string other_ends(const std::vector<RunResult>& results, int& ok);

/// Parameters that change nothing: runs that differ in one alone end with the same bits.
std::vector<std::string> idle_lines(const Manifest& manifest,
                                    const std::vector<RunResult>& results);

/// "run 3: WARNING; WARNING" for each of the first five runs that have some, then how many more.
std::vector<std::string> warning_lines(const Manifest& manifest,
                                       const std::vector<RunResult>& results);

}  // namespace neve::app::sweep::store
