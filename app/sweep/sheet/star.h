#pragma once
/// `neve sweep star DIR RUNS`: stars and notes of runs, kept with the sweep.

#include <optional>
#include <string>

#include "app/options/option.h"

namespace neve::app::sweep::sheet {

struct StarOptions {
  std::string folder;               ///< of a sweep
  std::string runs;                 ///< "3,7-9"; "": none
  std::optional<std::string> note;  ///< "": takes notes away
  std::string read;                 ///< a list that the report has made; "": none
  bool is_removed = false;
  bool is_json = false;
};

void describe(options::Command& visit, StarOptions& options);

/// Writes stars.json, and puts the stars into data.csv, report.html and starred.png.
/// @return exit code @throws UsageError, IoError, Error
int run_star(const StarOptions& options);

}  // namespace neve::app::sweep::sheet
