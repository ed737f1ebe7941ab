#pragma once
/// `neve strip`: one view at several times, side by side in one picture.

#include <optional>
#include <string>
#include <vector>

#include "app/run/render_job.h"
#include "app/support/progress.h"

namespace neve::app::run {

struct StripOptions {
  RenderOptions run;  ///< scene, overrides, coarsening, frames, view, out (a PNG), threads, ...
  std::vector<double> at;  ///< s, increasing; empty: `tiles` frames, evenly spread over the frames
  std::optional<int> tiles;    ///< default: those of a strip that is made again, or 6
  std::optional<int> columns;  ///< likewise, or 0: as many as give about the shape of a screen
  std::optional<int> width;    ///< px, of the whole picture; likewise, or 1920
};

struct StripJob {
  RenderJob run;              ///< its scene has one view
  std::vector<double> times;  ///< s
  int columns = 1, width = 1920;
  std::filesystem::path file;
};

/// @throws SceneError, UsageError, IoError, Error
StripJob make_strip_job(const StripOptions& options);

struct StripResult {
  std::size_t tiles = 0;  ///< drawn; the picture has gaps for the others
  std::optional<sim::Divergence> divergence;
};

/// Simulates once, from the nearest moment that is kept of the run or from the start,
/// and draws each time on the way. The picture is written also if the run ends early.
/// @throws IoError, LimitError, Error
StripResult run_strip(const StripJob& job, const RenderOptions& options, Progress& progress);

}  // namespace neve::app::run
