#pragma once
/// Collects the results of the finished runs of a sweep.

#include <filesystem>

#include "app/output/movie_format.h"
#include "app/support/progress.h"

namespace neve::app::sweep::sheet {

/// DIR/data.csv, DIR/plots.svg, DIR/sheet/0000.png ..., DIR/sheet.png, DIR/strips.png,
/// DIR/sheet.mp4, or the movie of another format, where ffmpeg is installed, and DIR/report.html.
/// Changes nothing of the runs. Says which runs have warnings.
/// @throws IoError, render::ContextError, Error for a folder without a sweep
void collect_sweep(const std::filesystem::path& folder, const output::MovieStyle& movie,
                   const std::string& backend, int threads, Progress& progress);

}  // namespace neve::app::sweep::sheet
