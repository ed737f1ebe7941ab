#pragma once
/// Collects the results of the finished runs of a sweep.

#include <filesystem>

#include "app/output/movie_format.h"
#include "app/support/progress.h"
#include "app/sweep/store/manifest.h"

namespace neve::app::sweep::sheet {

/// DIR/data.csv, DIR/points.csv of a sweep with seeds, DIR/runs.otio, DIR/plots.svg,
/// DIR/sheet/0000.png ..., DIR/sheet.png, DIR/strips.png, DIR/sheet.mp4, or the movie of another
/// format, where ffmpeg is installed, and DIR/report.html. Changes nothing of the runs. Says which
/// runs have warnings.
/// @param has_review  makes DIR/review too, see review.h
/// @throws IoError, render::ContextError, Error for a folder without a sweep
void collect_sweep(const std::filesystem::path& folder, const output::MovieStyle& movie,
                   bool has_review, const std::string& backend, int threads, Progress& progress);

/// Puts the marks of a manifest into the table and the report as they are there, and draws
/// DIR/starred.png, the last frames of the runs with stars. Sheets have them with the next collect.
/// @throws IoError
void show_marks(const std::filesystem::path& folder, const store::Manifest& manifest,
                Progress& progress);

}  // namespace neve::app::sweep::sheet
