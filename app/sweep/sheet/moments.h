#pragma once
/// Moments that strips show: those at which there is snow in the picture.

#include <filesystem>
#include <set>
#include <vector>

#include "app/sweep/store/results.h"

namespace neve::app::sweep::sheet {

/// The frames that have snow in their picture, by the camera of the run and the place of its snow.
class SnowInPictures {
 public:
  /// @param results  of the runs of the manifest
  SnowInPictures(const std::filesystem::path& folder, const store::Manifest& manifest,
                 const std::vector<store::RunResult>& results);

  /// True also where it is not known.
  bool has_snow(std::size_t run, int frame) const { return !without_[run].contains(frame); }

  /// Returns at most so many frames, evenly spread from the first at which one of the runs has snow
  /// in its picture to the last one.
  std::vector<int> moments(std::size_t most) const;

 private:
  int first_, last_;
  std::vector<std::set<int>> without_;  ///< frames of each run
};

}  // namespace neve::app::sweep::sheet
