#pragma once
/// Writes pictures, movies and numbers of two runs against each other.

#include <filesystem>
#include <vector>

#include "app/compare/pair_options.h"
#include "app/compare/series.h"

namespace neve::app::compare {

struct PairResult {
  std::vector<std::filesystem::path> files;  ///< pictures, movies and tables
  std::vector<PairMoment> moments;
  std::vector<std::string> differing;  ///< addresses of parameters
  std::vector<std::string> warnings;
  bool is_whole = true;  ///< not interrupted
};

/// @throws UsageError, IoError, LimitError, Error
PairResult compare_run(const PairOptions& options, Progress& progress);

/// Two pictures that hold no state: beside each other or wiped. @throws the same
PairResult compare_plain_pictures(const PairOptions& options);

}  // namespace neve::app::compare
