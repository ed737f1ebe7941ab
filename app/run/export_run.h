#pragma once
/// `neve export`: a scene, a run or a picture, written as geometry at some of its times.

#include <optional>
#include <string>
#include <vector>

#include "app/exports/exporter.h"
#include "app/run/render_job.h"
#include "app/support/progress.h"

namespace neve::app::run {

struct ExportOptions {
  RenderOptions run;  ///< scene, overrides, coarsening, frames, threads, out, verbosity, is_json
  std::vector<scene::Export> exports;
  std::vector<double> at;  ///< s, increasing; empty: the frames
};

struct ExportJob {
  RenderJob run;  ///< its scene has the exports
  std::vector<double> times;
  bool are_frames = true;  ///< numbers of files are those of frames
  int first_number = 0;
  std::filesystem::path lock_folder;  ///< no one else may write there meanwhile
};

/// The folder of a run, a scene or a picture, which names the frame to write where none is asked
/// for.
/// @throws SceneError, UsageError, IoError, Error
ExportJob make_export_job(const ExportOptions& options);

struct ExportResult {
  std::size_t moments = 0;  ///< written
  bool is_whole = true;
  std::optional<sim::Divergence> divergence;
  Json exports;  ///< as in export.json
};

/// Simulates once, from the nearest moment that is kept of the run or from the start,
/// and writes every moment on the way; DIR/export.json then lists the files.
/// @throws IoError, LimitError, Error
ExportResult run_export(const ExportJob& job, int threads, Progress& progress);

}  // namespace neve::app::run
