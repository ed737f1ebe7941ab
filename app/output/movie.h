#pragma once
/// A movie of finished pictures, made by ffmpeg where there is one.

#include <filesystem>
#include <string>

namespace neve::app::output {

struct MovieRequest {
  std::filesystem::path picture_folder;  ///< holds 0000.png ...
  std::filesystem::path file;            ///< the movie
  int first_frame = 0, last_frame = 0;
  double fps = 24;
  bool has_alpha = false;  ///< of the pictures, which are then laid over a plain colour
  double longest = 0;      ///< s that ffmpeg may take; 0: as long as the largest pictures need
};

enum class MovieOutcome {
  written,
  no_ffmpeg,
  failed,     ///< of ffmpeg
  unwritable  ///< of the disk
};

struct MovieResult {
  MovieOutcome outcome = MovieOutcome::failed;
  std::string reason;  ///< of a failure
};

/// H.264 with even sides, written under a temporary name, decoded again to count its frames (ffmpeg
/// exits 0 on broken input) and only then put in place. A movie of another length is not kept.
/// An earlier movie of that name is removed first. A written one is on the disk. An ffmpeg that
/// takes far too long is stopped.
/// Never throws for failures of ffmpeg and of the disk.
MovieResult write_movie(const MovieRequest& request);

}  // namespace neve::app::output
